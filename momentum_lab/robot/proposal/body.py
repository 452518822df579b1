"""Which link is the pelvis, the trunk, a knee, a hand: read off the kinematic tree and two sole frames."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from momentum_lab.errors import RobotError

FEET = ("left", "right")
_FREE_FLYER = 1
# A joint turns about the robot's lateral axis if the cosine between the axes is at least this.
_ALONG = 0.9


@dataclass(frozen=True, slots=True)
class Leg:
    """The joints from the pelvis to a foot.

    Attributes:
        joints: indices in the Pinocchio model, from the hip down.
        pitch: hip, knee and ankle among those that turn about the lateral axis; empty if there are not three.
        sign: +1 where a positive angle turns about the left-pointing axis, -1 where about its opposite (3,).
    """

    joints: tuple[int, ...]
    pitch: tuple[int, ...]
    sign: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Body:
    """A humanoid's parts.

    Attributes:
        model: the Pinocchio model.
        data: its placements with all joints at zero.
        soles: indices of the two given frames, left and right.
        axes: columns forward, left and up in the axes of the root (3, 3).
        legs: left and right.
        pelvis: joint that carries both legs.
        trunk: joint that carries the arms.
        arms: joints from the trunk to each hand, left and right; empty where there is no arm.
        head: joints from the trunk to the head.
        masses: link -> its own mass in the URDF, kg.
    """

    model: pin.Model
    data: pin.Data
    soles: tuple[int, int]
    axes: np.ndarray
    legs: tuple[Leg, Leg]
    pelvis: int
    trunk: int
    arms: tuple[tuple[int, ...], tuple[int, ...]]
    head: tuple[int, ...]
    masses: dict[str, float]

    @property
    def pelvis_link(self) -> str:
        """The link that the hips are mounted on."""
        hip = self.model.frames[self.model.getFrameId(self.model.names[self.legs[0].joints[0]])]
        return str(self.model.frames[hip.parentFrame].name)

    @property
    def head_link(self) -> str | None:
        """The link at the end of the neck, or one of the trunk that is called a head."""
        if self.head:
            return self.link(self.head[-1])
        named = [name for name in self.links(self.trunk) if "head" in name.lower()]
        return min(named, key=len, default=None)

    @property
    def feet(self) -> tuple[int, int]:
        """The joints that carry the soles."""
        return self.legs[0].joints[-1], self.legs[1].joints[-1]

    @property
    def upper(self) -> tuple[int, ...]:
        """All joints that are in no leg."""
        legs = {joint for leg in self.legs for joint in leg.joints}
        return tuple(joint for joint in range(2, self.model.njoints) if joint not in legs)

    @property
    def leg_length(self) -> float:
        """From hip to ankle with all joints at zero, m."""
        top, bottom = (np.mean([self.place(leg.joints[end]) for leg in self.legs], axis=0) for end in (0, -1))
        return float((top - bottom) @ self.axes[:, 2])

    def place(self, joint: int) -> np.ndarray:
        """Where a joint is with all joints at zero, root axes (3,), m."""
        return self.data.oMi[joint].translation

    def links(self, joint: int) -> list[str]:
        """Names of the links that move with a joint."""
        return [
            str(frame.name)
            for frame in self.model.frames
            if frame.parentJoint == joint and frame.type == pin.FrameType.BODY
        ]

    def link(self, joint: int) -> str:
        """Name of the heaviest link that moves with a joint; for the pelvis the one with the hips."""
        if joint == self.pelvis:
            return self.pelvis_link
        return max(self.links(joint), key=lambda name: self.masses.get(name, 0.0))


def find_body(model: pin.Model, masses: dict[str, float], soles: Sequence[str]) -> Body:
    """The parts of a humanoid.

    The pelvis is the last joint that both soles hang on. Up is the root's axis that points from the feet to
    the hips, left the one from the right foot to the left. The trunk is the first joint above the pelvis at
    which the tree divides.

    Args:
        model: the Pinocchio model with a free-flyer.
        masses: link -> its own mass in the URDF, kg.
        soles: names of the left and the right sole frame, or of the links of the feet.

    Raises:
        RobotError: a frame is unknown, both belong to one leg, or the legs have no height or no distance.
    """
    frames = _frames(model, soles)
    data = model.createData()
    pin.computeJointJacobians(model, data, pin.neutral(model))
    pin.updateFramePlacements(model, data)
    chains = _leg_chains(model, frames, soles)
    axes = _axes(data, chains, soles)
    legs = _leg(model, data, axes, chains[0]), _leg(model, data, axes, chains[1])
    pelvis = int(model.parents[chains[0][0]])
    taken = {chain[0] for chain in chains}
    trunk = _trunk(model, pelvis, taken)
    arms, head = _limbs(model, data, axes, trunk, taken)
    return Body(model, data, frames, axes, legs, pelvis, trunk, arms, head, masses)


def _frames(model: pin.Model, soles: Sequence[str]) -> tuple[int, int]:
    unknown = ", ".join(name for name in soles if not model.existFrame(name))
    if unknown or len(soles) != 2:
        given = unknown or ", ".join(soles) or "nothing"
        ends = ", ".join(_tips(model))
        raise RobotError(
            "soles", given, f"LEFT,RIGHT: two frames of the URDF; at the ends of its tree: {ends}"
        )
    left, right = (int(model.getFrameId(name)) for name in soles)
    return left, right


def _tips(model: pin.Model) -> list[str]:
    """Links that no joint comes after: hands, feet and head are among them."""
    return [
        frame.name
        for frame in model.frames
        if frame.type == pin.FrameType.BODY and not model.subtrees[frame.parentJoint][1:]
    ]


def _leg_chains(
    model: pin.Model, frames: tuple[int, int], soles: Sequence[str]
) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Joints between the pelvis and each foot."""
    left, right = (list(model.supports[model.frames[frame].parentJoint]) for frame in frames)
    shared = set(left) & set(right)
    chains = tuple(j for j in left if j not in shared), tuple(j for j in right if j not in shared)
    if not chains[0] or not chains[1]:
        raise RobotError(
            "soles", ",".join(soles), "frames of two feet, each at the end of a leg of its own: LEFT,RIGHT"
        )
    return chains


def _axes(data: pin.Data, chains: Sequence[Sequence[int]], soles: Sequence[str]) -> np.ndarray:
    """Columns forward, left, up, each along an axis of the root (3, 3)."""
    hips, feet = ([data.oMi[chain[end]].translation for chain in chains] for end in (0, -1))
    up = _nearest_axis(np.mean(hips, axis=0) - np.mean(feet, axis=0))
    across = feet[0] - feet[1]
    left = _nearest_axis(across - up * (up @ across))
    if not up.any() or not left.any():
        raise RobotError(
            "soles", ",".join(soles), "frames of two feet side by side below the hips, joints at zero"
        )
    return np.column_stack([np.cross(left, up), left, up])


def _nearest_axis(direction: np.ndarray) -> np.ndarray:
    """The coordinate axis, with its sign, that is nearest to a direction (3,); zero for less than 1 cm."""
    axis = np.zeros(3)
    largest = int(np.argmax(np.abs(direction)))
    if abs(direction[largest]) > 0.01:
        axis[largest] = np.sign(direction[largest])
    return axis


def _leg(model: pin.Model, data: pin.Data, axes: np.ndarray, joints: tuple[int, ...]) -> Leg:
    """The leg with its hip, knee and ankle: first and last pitch joint, and the one farthest from both."""
    turns = {j: float(data.J[3:, model.joints[j].idx_v] @ axes[:, 1]) for j in joints}
    pitch = [j for j in joints if abs(turns[j]) > _ALONG]
    if len(pitch) < 3:
        return Leg(joints, (), ())
    ends = [data.oMi[j].translation for j in (pitch[0], pitch[-1])]
    knee = max(pitch[1:-1], key=lambda j: min(np.linalg.norm(data.oMi[j].translation - end) for end in ends))
    chosen = (pitch[0], knee, pitch[-1])
    return Leg(joints, chosen, tuple(float(np.sign(turns[j])) for j in chosen))


def _trunk(model: pin.Model, pelvis: int, legs: set[int]) -> int:
    """The first joint from the pelvis upwards that carries more than one other, or none."""
    joint = pelvis
    while len(above := [child for child in _children(model, joint) if child not in legs]) == 1:
        if not _children(model, above[0]):
            break  # a single joint at the end is a head, not a trunk
        joint = above[0]
    return joint


def _limbs(
    model: pin.Model, data: pin.Data, axes: np.ndarray, trunk: int, legs: set[int]
) -> tuple[tuple[tuple[int, ...], tuple[int, ...]], tuple[int, ...]]:
    """Arms are the chains that reach farthest to either side, the head the highest of the others."""
    chains = [_chain(model, child) for child in _children(model, trunk) if child not in legs]
    sides = {chain: float((data.oMi[chain[-1]].translation @ axes)[1]) for chain in chains}
    apart = 0.05
    left = max(chains, key=lambda c: sides[c], default=())
    right = min(chains, key=lambda c: sides[c], default=())
    left, right = (
        left if sides.get(left, 0.0) > apart else (),
        right if sides.get(right, 0.0) < -apart else (),
    )
    others = [chain for chain in chains if chain not in (left, right) and abs(sides[chain]) < apart]
    head = max(others, key=lambda c: (data.oMi[c[-1]].translation @ axes)[2], default=())
    return (left, right), head


def _chain(model: pin.Model, joint: int) -> tuple[int, ...]:
    """A joint and those behind it, to where the chain ends or divides (into fingers)."""
    chain = [joint]
    while len(children := _children(model, chain[-1])) == 1:
        chain.append(children[0])
    return tuple(chain)


def _children(model: pin.Model, joint: int) -> list[int]:
    return [int(child) for child in model.children[joint]]
