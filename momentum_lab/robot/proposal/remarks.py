"""What a URDF lacks or what looks wrong in it, in words."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from typing import Literal

import msgspec
import numpy as np
import pinocchio as pin

from momentum_lab.robot.proposal.body import FEET, Body
from momentum_lab.robot.proposal.sole_fit import Sole
from momentum_lab.robot.proposal.solids import Solids
from momentum_lab.robot.proposal.srdf import Semantics

Grade = Literal["missing", "doubtful", "estimated"]

_FAR_FASTER = 50.0
_LIGHT, _HEAVY = 2.0, 300.0
# A link's radius of gyration above this part of the leg's length is no link's.
_WIDE = 1.0
_DIFFERENT = 0.02
# A foot that reaches this much farther back than forward looks backwards.
_LONGER = 1.4


class Remark(msgspec.Struct, frozen=True):
    """One thing to look at.

    Attributes:
        grade: missing keeps the robot from standing or being drawn, doubtful looks wrong, estimated is a guess.
        text: what it is, and where.
    """

    grade: Grade
    text: str


def masses_of(root: ET.Element) -> dict[str, float]:
    """Link -> its own mass in the URDF, kg."""
    return {
        link.get("name", ""): _number(link.find("inertial/mass"), "value") for link in root.findall("link")
    }


def remarks_on_urdf(root: ET.Element) -> list[Remark]:
    """What can be said before the URDF is understood: joints that are meant otherwise, and limits they lack."""
    moving = [joint for joint in root.findall("joint") if joint.get("type") in ("revolute", "prismatic")]
    found = []
    mimics = [joint.get("name", "") for joint in moving if joint.find("mimic") is not None]
    if mimics:
        found.append(Remark("doubtful", f"mimic joints are taken for motors of their own: {_some(mimics)}"))
    limited = {joint: joint.find("limit") for joint in moving}
    slow = [joint.get("name", "") for joint, limit in limited.items() if _number(limit, "velocity") <= 0.0]
    if slow:
        found.append(Remark("doubtful", f"no velocity limit, which is not used: {_some(slow)}"))
    fast = [j.get("name", "") for j, limit in limited.items() if _number(limit, "velocity") > _FAR_FASTER]
    if fast:
        found.append(Remark("doubtful", f"velocity limits above 50 rad/s are placeholders: {_some(fast)}"))
    weak = [joint.get("name", "") for joint, limit in limited.items() if not _number(limit, "effort") > 0.0]
    if weak:
        found.append(Remark("missing", f"no effort limit above 0, a guess instead: {_some(weak)}"))
    return found


def remarks_on_inertia(root: ET.Element, body: Body) -> list[Remark]:
    """Masses and inertias that are missing, impossible, or the same everywhere."""
    model = body.model
    found = []
    empty = [model.names[j] for j in range(2, model.njoints) if not _carried_mass(model, j) > 0.0]
    if empty:
        found.append(Remark("missing", f"no mass behind these joints: {_some(empty)}"))
    mass = float(pin.computeTotalMass(model))
    if not _LIGHT < mass < _HEAVY:
        found.append(Remark("doubtful", f"the whole robot weighs {mass:.3g} kg"))
    impossible, wide = [], []
    texts: dict[str, list[str]] = {}
    for link in root.findall("link"):
        inertia = link.find("inertial/inertia")
        weight = _number(link.find("inertial/mass"), "value")
        if inertia is None or not weight > 0.0:
            continue
        moments = np.linalg.eigvalsh(_matrix(inertia))
        if moments[0] <= 0.0 or moments[0] + moments[1] < moments[2] * 0.99:
            impossible.append(link.get("name", ""))
        if math.sqrt(max(moments[2], 0.0) / weight) > _WIDE * body.leg_length:
            wide.append(link.get("name", ""))
        texts.setdefault(str(np.round(moments, 9)), []).append(link.get("name", ""))
    if impossible:
        found.append(Remark("doubtful", f"moments of inertia that no solid has: {_some(impossible)}"))
    if wide:
        text = f"moments of inertia too large for the mass and size of a link: {_some(wide)}"
        found.append(Remark("doubtful", text))
    same = max(texts.values(), key=len, default=[])
    if len(same) > max(4, sum(map(len, texts.values())) // 2):
        found.append(Remark("doubtful", f"{len(same)} links have the same moments of inertia: placeholders"))
    return found


def remarks_on_body(body: Body) -> list[Remark]:
    """Parts of a humanoid that are not there, and legs that do not match each other."""
    found = []
    model = body.model
    above = [model.names[j] for j in model.supports[body.pelvis] if j > 1]
    if above:
        text = f"the pelvis hangs on {_some(above)}: a root that is another link, or a floating base too many"
        found.append(Remark("doubtful", text))
    for side, leg in zip(FEET, body.legs, strict=True):
        if not leg.pitch:
            found.append(
                Remark("missing", f"the {side} leg has no hip, knee and ankle that turn sideways axes")
            )
        if len(leg.joints) < 6:
            found.append(
                Remark("doubtful", f"the {side} leg has {len(leg.joints)} joints; six place a foot freely")
            )
    for side, arm in zip(FEET, body.arms, strict=True):
        if not arm:
            found.append(Remark("doubtful", f"no {side} arm found"))
    return found + _unlike_limits(body)


def remarks_on_posture(body: Body, semantics: Semantics) -> list[Remark]:
    """Angles of the SRDF's posture that the URDF's limits do not allow."""
    model = body.model
    outside = []
    for name, angle in semantics.angles.items():
        if model.existJointName(name):
            low, high = _range(model, model.getJointId(name), 1.0)
            if not low - _DIFFERENT < angle < high + _DIFFERENT:
                outside.append(f"{name} = {angle:.2f}, not {low:.2f} to {high:.2f}")
    if not outside:
        return []
    text = f"{semantics.state} of {semantics.file} lies outside the URDF's limits: {_some(outside)}"
    return [Remark("doubtful", text)]


def remarks_on_soles(body: Body, soles: tuple[Sole, Sole]) -> list[Remark]:
    """Sole frames that lie or look another way than the lab needs, guesses, and feet that differ."""
    found = []
    for side, sole in zip(FEET, soles, strict=True):
        if sole.tilt > 0.02:
            text = f"the {side} frame is {math.degrees(sole.tilt):.0f} degrees from z up, x forward"
            found.append(Remark("doubtful", f"{text}: {sole.spec.frame} is added"))
        elif sole.spec.parent is not None:
            text = f"the {side} frame is {1e3 * sole.drop:.0f} mm above the sole"
            found.append(Remark("doubtful", f"{text}: {sole.spec.frame} is added"))
        if sole.estimated:
            found.append(Remark("estimated", f"the {side} foot has no shape: its rectangle is a guess"))
        if -sole.spec.x[0] > _LONGER * sole.spec.x[1]:
            found.append(
                Remark(
                    "doubtful",
                    f"the {side} sole is longer behind its frame than in front: left and right swapped?",
                )
            )
    left, right = (np.array([sole.spec.x, sole.spec.y]) for sole in soles)
    difference = np.abs(left - np.array([right[0], -right[1][::-1]])).max()
    if difference > 0.005:
        text = f"the soles are no mirror images: edges differ by {1e3 * difference:.0f} mm"
        found.append(Remark("doubtful", text))
    return found


def remarks_on_solids(solids: Solids, bare: list[str]) -> list[Remark]:
    """Meshes that are missing, shapes that are no robot's, and links without a shape."""
    found = []
    if count := len(solids.unreadable):
        meshes = "1 mesh" if count == 1 else f"{count} meshes"
        found.append(Remark("missing", f"{meshes} cannot be read: {_some(solids.unreadable)}"))
    for link, size in solids.oversized.items():
        found.append(Remark("doubtful", f"a shape of {link} is {size:.1f} m across and is left out"))
    if bare:
        text = f"no shapes: joints instead of a surface are the fall points of {_some(bare)}"
        found.append(Remark("estimated", text))
    return found


def _unlike_limits(body: Body) -> list[Remark]:
    """Hip, knee and ankle whose ranges are not those of the other leg."""
    left, right = body.legs
    found = []
    for j, k, sign_j, sign_k in zip(left.pitch, right.pitch, left.sign, right.sign, strict=False):
        ours, theirs = _range(body.model, j, sign_j), _range(body.model, k, sign_k)
        if max(abs(a - b) for a, b in zip(ours, theirs, strict=True)) > _DIFFERENT:
            text = "{} turns {:.2f} to {:.2f} rad, {} {:.2f} to {:.2f}".format(
                body.model.names[j], *ours, body.model.names[k], *theirs
            )
            found.append(Remark("doubtful", f"legs with different limits about the same axis: {text}"))
    return found


def _range(model: pin.Model, joint: int, sign: float) -> tuple[float, float]:
    index = model.joints[joint].idx_q
    ends = sorted((sign * model.lowerPositionLimit[index], sign * model.upperPositionLimit[index]))
    return ends[0], ends[1]


def _carried_mass(model: pin.Model, joint: int) -> float:
    return sum(model.inertias[j].mass for j in model.subtrees[joint])


def _matrix(inertia: ET.Element) -> np.ndarray:
    xx, xy, xz, yy, yz, zz = (_number(inertia, name) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _number(element: ET.Element | None, attribute: str) -> float:
    """A number of an element; 0 where it is not there or none."""
    try:
        value = float("nan" if element is None else element.get(attribute, "nan"))
    except ValueError:
        value = math.nan
    return value if math.isfinite(value) else 0.0


def _some(names: list[str]) -> str:
    """The first few names, and how many more there are."""
    few = 4
    more = f" and {len(names) - few} more" if len(names) > few else ""
    return ", ".join(names[:few]) + more
