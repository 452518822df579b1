"""The robot as a Pinocchio model with soles, limits and names, and `at(state)`, which computes it all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np
import pinocchio as pin

from momentum_lab.compiled import compiled
from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import FootSpec, RobotSpec, load_spec
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.robot.urdf import load_model, urdf_path

_WORLD_ALIGNED = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
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
        self.data = self.model.createData()
        self.pelvis = self.frame(spec.pelvis)
        self.trunk = self.frame(spec.trunk)
        self.upper_body = self.matching_joints(spec.upper_body)
        self.position_lower = self.model.lowerPositionLimit[7:].copy()
        self.position_upper = self.model.upperPositionLimit[7:].copy()
        self.effort_limit = self.model.effortLimit[_BASE_DOF:].copy()
        self.mass = float(pin.computeTotalMass(self.model))
        self._weight = self.mass * self.model.gravity.linear
        self._no_acceleration = np.zeros(self.nv)
        self._sole_frames = [sole.frame for sole in self.soles]
        _check(self)

    @classmethod
    def named(cls, name: str) -> RobotModel:
        """The robot of that name in the catalog, or of the TOML file at that path."""
        return cls(load_spec(name))

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
        20, 29). The last pass is forward kinematics at zero joint acceleration, for the drift of frames
        (Eqs. 31, 45).
        """
        model, data, q, v = self.model, self.data, state.q, state.v
        mass_matrix = pin.crba(model, data, q, pin.Convention.WORLD).copy()
        centroidal_map = data.Ag.copy()
        com = data.com[0].copy()
        nonlinear_effects = pin.nonLinearEffects(model, data, q, v).copy()
        pin.forwardKinematics(model, data, q, v, self._no_acceleration)
        pin.updateFramePlacements(model, data)
        base, frames = data.oMi[1], self._sole_frames
        soles = [data.oMf[frame] for frame in frames]
        momentum, bias, locked_inertia = centroidal_terms(
            centroidal_map, nonlinear_effects, v, base.rotation, base.translation, com, self._weight
        )
        return Dynamics(
            state=state,
            com_in_world=com,
            com_velocity=momentum[:3] / self.mass,
            centroidal_map=centroidal_map,
            centroidal_bias=bias,
            momentum=momentum,
            locked_inertia=locked_inertia,
            mass_matrix=mass_matrix,
            nonlinear_effects=nonlinear_effects,
            sole_position=np.array([sole.translation for sole in soles]),
            sole_rotation=np.array([sole.rotation for sole in soles]),
            sole_jacobian=np.array([pin.getFrameJacobian(model, data, f, _WORLD_ALIGNED) for f in frames]),
            sole_bias=np.array([self._bias(f) for f in frames]),
            pelvis_rotation=data.oMf[self.pelvis].rotation.copy(),
            pelvis_jacobian=pin.getFrameJacobian(model, data, self.pelvis, _WORLD_ALIGNED),
            pelvis_bias=self._bias(self.pelvis),
        )

    def _bias(self, frame: int) -> np.ndarray:
        """Classical acceleration of a frame at zero joint acceleration (6,)."""
        return pin.getFrameClassicalAcceleration(self.model, self.data, frame, _WORLD_ALIGNED).vector

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


@compiled(
    "Tuple((f8[::1], f8[::1], f8[:, ::1]))(f8[:, ::1], f8[::1], f8[::1], f8[:, :], f8[:], f8[::1], f8[::1])"
)
def centroidal_terms(
    centroidal_map: np.ndarray,
    nonlinear_effects: np.ndarray,
    velocity: np.ndarray,
    rotation: np.ndarray,
    position: np.ndarray,
    com: np.ndarray,
    weight: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What A_G and the base rows of the equations of motion say about the momentum (Eqs. 15, 20, 29).

    h_G = A_G v. The base rows of C v + tau_g, turned into world axes and taken about the CoM, are dA_G/dt v
    and the weight held up. The base turned alone, with no joint moving, shows the inertia about the CoM.

    Args:
        centroidal_map: A_G (6, nv).
        nonlinear_effects: C v + tau_g (nv,).
        velocity: v (nv,).
        rotation: axes of the base in the world (3, 3).
        position: its origin (3,), m.
        com: r_G (3,), m.
        weight: m g (3,), N.

    Returns:
        h_G (6,), dA_G/dt v (6,), I_G (3, 3).
    """
    bias, inertia = np.zeros(6), np.zeros((3, 3))
    for i in range(3):
        for k in range(3):
            bias[i] += rotation[i, k] * nonlinear_effects[k]
            bias[3 + i] += rotation[i, k] * nonlinear_effects[3 + k]
            for j in range(3):
                inertia[i, j] += centroidal_map[3 + i, 3 + k] * rotation[j, k]
    fx, fy, fz = bias[:3]
    x, y, z = position - com
    bias[3] += y * fz - z * fy
    bias[4] += z * fx - x * fz
    bias[5] += x * fy - y * fx
    bias[:3] += weight
    return centroidal_map @ velocity, bias, inertia


def _add_frame(model: pin.Model, name: str, foot: FootSpec, parent: int) -> None:
    if model.existFrame(foot.frame):
        raise RobotError(
            f"feet.{name}.frame", foot.frame, "a new name, or no parent: the URDF has this frame"
        )
    link = model.frames[parent]
    placement = link.placement * pin.SE3(np.eye(3), np.array(foot.offset))
    model.addFrame(pin.Frame(foot.frame, link.parentJoint, parent, placement, pin.FrameType.OP_FRAME))


def _armature(spec: RobotSpec, robot: RobotModel) -> np.ndarray:
    """Rotor inertia per velocity (nv,): the URDF's, where the robot's file does not give its own."""
    armature = robot.model.armature.copy()
    for pattern, inertia in spec.armature.items():
        armature[_BASE_DOF + robot.matching_joints([pattern])] = inertia
    return armature


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
