"""The robot as a Pinocchio model with soles, limits and names, and `at(state)`, which computes it all."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
import pinocchio as pin

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import FootSpec, RobotSpec, load_spec
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.robot.terms import Frames, memory_of, state_terms
from momentum_lab.robot.urdf import load_model, urdf_path

_BASE_DOF = 6


@dataclass(frozen=True, slots=True)
class Sole:
    """The rectangle of a foot that touches the ground.

    Attributes:
        name: the foot's name.
        frame: index of the sole frame in the Pinocchio model.
        lower: rear right corner in the sole frame (2,), m.
        upper: front left corner in the sole frame (2,), m.
        corners: the four corners in the sole frame, counter-clockwise from rear right (4, 3), m.
        joints: indices of the joints between pelvis and foot, among the actuated joints.
    """

    name: str
    frame: int
    lower: np.ndarray
    upper: np.ndarray
    corners: np.ndarray
    joints: np.ndarray


class RobotModel:
    """A humanoid: what it is made of, and everything that follows from one of its states.

    Args:
        spec: what the robot's TOML file says.

    Raises:
        RobotError: the URDF cannot be read, a named frame, link or joint is missing, a foot does not hang
            on the joints it names, or a joint has no usable limits.
    """

    def __init__(self, spec: RobotSpec) -> None:
        self.spec = spec
        self.urdf = urdf_path(spec)
        self.model = load_model(self.urdf)
        self.joint_names: tuple[str, ...] = tuple(self.model.names[2:])
        self.soles = tuple(self._sole(name, foot) for name, foot in spec.feet.items())
        self.model.armature = _armature(spec, self)
        _replace_limits(spec, self)
        self.data = self.model.createData()
        self.pelvis = self.frame(spec.pelvis)
        self.trunk = self.frame(spec.trunk)
        self.upper_body = self.matching_joints(spec.upper_body)
        self.position_lower = self.model.lowerPositionLimit[7:].copy()
        self.position_upper = self.model.upperPositionLimit[7:].copy()
        self.effort_limit = self.model.effortLimit[_BASE_DOF:].copy()
        self.joint_friction = np.zeros(self.na)
        self.inertia_scale = 1.0
        self.mass = float(pin.computeTotalMass(self.model))
        self._gravity = self.model.gravity.linear.copy()
        self._frames = Frames.of(self.model, [*(sole.frame for sole in self.soles), self.pelvis])
        self._memory = memory_of(self.data)
        _check(self)

    @classmethod
    def named(cls, name: str) -> RobotModel:
        """The robot of that name in the catalog, or of the TOML file at that path."""
        return cls(load_spec(name))

    def altered(self, inertia: float, effort: float, friction: float) -> RobotModel:
        """A robot like this one, of other weight and with other motors.

        Args:
            inertia: mass and inertia of each of its links, as a multiple of this one's; rotors stay.
            effort: its torque limits, as a multiple of this one's.
            friction: Coulomb friction of its joints, as a part of this one's torque limits.
        """
        robot = copy.copy(self)
        robot.model = self.model.copy()
        for link in robot.model.inertias:
            link.mass, link.inertia = inertia * link.mass, inertia * link.inertia
        robot.inertia_scale = inertia * self.inertia_scale
        robot.data = robot.model.createData()
        robot._memory = memory_of(robot.data)
        robot.mass = float(pin.computeTotalMass(robot.model))
        robot.effort_limit = effort * self.effort_limit
        robot.joint_friction = friction * self.effort_limit
        return robot

    @property
    def nq(self) -> int:
        """Numbers in a configuration."""
        return int(self.model.nq)

    @property
    def nv(self) -> int:
        """Numbers in a velocity."""
        return int(self.model.nv)

    @property
    def na(self) -> int:
        """Actuated joints."""
        return int(self.model.nv) - _BASE_DOF

    @property
    def foot_names(self) -> tuple[str, ...]:
        """Names of the feet in the order of every per-foot array."""
        return tuple(self.spec.feet)

    def frame(self, name: str) -> int:
        """Index of a frame.

        Raises:
            RobotError: there is no such frame; the message lists the links.
        """
        if not self.model.existFrame(name):
            known = ", ".join(frame.name for frame in self.model.frames if frame.type == pin.FrameType.BODY)
            raise RobotError(f"frame of {self.spec.name}", name, f"one of {known}")
        return int(self.model.getFrameId(name))

    def matching_joints(self, patterns: Sequence[str]) -> np.ndarray:
        """Indices (among the actuated joints) of the joints that match a shell-style pattern.

        Raises:
            RobotError: a pattern matches nothing; the message lists the joints.
        """
        for pattern in patterns:
            if not any(fnmatchcase(name, pattern) for name in self.joint_names):
                known = ", ".join(self.joint_names)
                raise RobotError(f"joints of {self.spec.name}", pattern, f"patterns of {known}")
        found = [i for i, name in enumerate(self.joint_names) if any(fnmatchcase(name, p) for p in patterns)]
        return np.array(found, dtype=int)

    def integrate(self, q: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """The configuration reached from q (nq,) by a tangent displacement v dt (nv,)."""
        return pin.integrate(self.model, q, displacement)

    def at(self, state: State) -> Dynamics:
        """Everything that control and physics need to know about a state.

        One pass of `crba` in world coordinates gives H, A_G, the CoM and all Jacobians. The drift of Eq. 20
        needs no second one: the six base rows of the equations of motion, taken about the CoM in world axes,
        are A_G a + dA_G v - m g, so dA_G v is what `nonLinearEffects` says there, without gravity (Eqs. 1, 2,
        20, 29). On its way it has found how joints are accelerated while no joint is, for the drift of frames
        (Eqs. 31, 45).
        """
        pin.crba(self.model, self.data, state.q, pin.Convention.WORLD)
        pin.nonLinearEffects(self.model, self.data, state.q, state.v)
        frames = self._frames
        terms = state_terms(
            *self._memory,
            state.v,
            frames.joint,
            frames.moved_by,
            frames.position,
            frames.rotation,
            self.mass,
            self._gravity,
        )
        return Dynamics(state, *terms)

    def _sole(self, name: str, foot: FootSpec) -> Sole:
        if foot.parent is not None:
            _add_frame(self.model, name, foot, self.frame(foot.parent))
        (rear, front), (right, left) = foot.x, foot.y
        corners = np.array([[rear, right, 0.0], [front, right, 0.0], [front, left, 0.0], [rear, left, 0.0]])
        return Sole(
            name=name,
            frame=self.frame(foot.frame),
            lower=np.array([rear, right]),
            upper=np.array([front, left]),
            corners=corners,
            joints=self.matching_joints(foot.joints),
        )


def _add_frame(model: pin.Model, name: str, foot: FootSpec, parent: int) -> None:
    if model.existFrame(foot.frame):
        raise RobotError(
            f"feet.{name}.frame", foot.frame, "a new name, or no parent: the URDF has this frame"
        )
    link = model.frames[parent]
    placement = link.placement * pin.SE3(pin.rpy.rpyToMatrix(np.array(foot.rpy)), np.array(foot.offset))
    model.addFrame(pin.Frame(foot.frame, link.parentJoint, parent, placement, pin.FrameType.OP_FRAME))


def _armature(spec: RobotSpec, robot: RobotModel) -> np.ndarray:
    """Rotor inertia per velocity (nv,): the URDF's, where the robot's file does not give its own."""
    armature = robot.model.armature.copy()
    for pattern, inertia in spec.armature.items():
        armature[_BASE_DOF + robot.matching_joints([pattern])] = inertia
    return armature


def _replace_limits(spec: RobotSpec, robot: RobotModel) -> None:
    """Put the limits of the robot's file in place of the URDF's."""
    model = robot.model
    for pattern, limit in spec.limits.items():
        joints = robot.matching_joints([pattern])
        for array, first, value in (
            (model.lowerPositionLimit, 7, limit.lower),
            (model.upperPositionLimit, 7, limit.upper),
            (model.effortLimit, _BASE_DOF, limit.effort),
        ):
            if value is not None:
                array[first + joints] = value


def _check(robot: RobotModel) -> None:
    """Refuse names that do not exist, legs that do not carry their foot, and joints without limits."""
    spec, model = robot.spec, robot.model
    for link in (*spec.push_bodies.values(), *spec.fall_points):
        robot.frame(link)
    robot.matching_joints(list(spec.home.joints))
    for sole in robot.soles:
        support = set(model.supports[model.frames[sole.frame].parentJoint])
        loose = [robot.joint_names[i] for i in sole.joints if i + 2 not in support]
        if loose:
            raise RobotError(
                f"feet.{sole.name}.joints of {spec.name}", ", ".join(loose), "joints between pelvis and foot"
            )
    usable = (
        np.isfinite(robot.effort_limit)
        & (robot.effort_limit > 0.0)
        & np.isfinite(robot.position_lower)
        & np.isfinite(robot.position_upper)
        & (robot.position_lower < robot.position_upper)
    )
    if not usable.all():
        bad = ", ".join(robot.joint_names[i] for i in np.flatnonzero(~usable))
        raise RobotError(f"joint limits of {spec.name}", bad, "an effort above 0 and lower < upper position")
