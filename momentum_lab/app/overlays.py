"""What to draw for one sample, as plain data: no viewer, no handles, nothing that remembers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pinocchio as pin

from momentum_lab.app.steady import steady
from momentum_lab.app.support_now import polygon_of, sole_placement
from momentum_lab.momentum.ground import GRAVITY, NO_FORCE
from momentum_lab.momentum.support import support_margin
from momentum_lab.physics.push import Push, pushed_frame
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.status import carrying_feet

Point = tuple[float, float, float]

# Marks on the ground lie in layers, so that none hides in another, m.
_LAYER = {"support": 0.002, "safe_border": 0.003, "gap": 0.005, "com_ground": 0.006, "cop_granted": 0.007}
_TOP_LAYER = 0.009
_RAISED = np.array([0.0, 0.0, _TOP_LAYER])
# A CoP and a CMP closer than this, in CoM heights, show no gap.
_NO_GAP = 0.006
# How long a push stays in the picture after its start, s.
_PUSH_SHOWN = 1.0
PUSH_LENGTH = 1.4
"""How long the arrow of a push is that is as strong as the robot's weight, in CoM heights."""

# And how far above the tip of one that pulls its label sits, in CoM heights.
_LABEL_ABOVE = 0.05
# Labels of lines on the ground sit beside them, on the side from which the lab looks first; in CoM heights.
_BESIDE = 0.13
_SIDE = np.array([0.47, -0.88])
_LEFT = np.array([-0.88, -0.47])
# A dash and a pause of the safe border, m.
_DASH = 0.012
# A safe border that moves by less than this many digits of a metre looks the same.
_DIGITS = 4
# Room for figures in labels: of a force, N, and of the rate of angular momentum, N m.
_NEWTONS, _NEWTON_METRES = 3, 3


@dataclass(frozen=True, slots=True)
class Mark:
    """One mark in the world.

    Attributes:
        key: which mark; its looks are in `marks.STYLES`.
        points: one point per symbol; start and end per arrow or line; the corners of an area, m.
        text: a label in addition to its name, with unit; empty: the name only.
        at: where the label sits; None: at the first point.
    """

    key: str
    points: tuple[Point, ...]
    text: str = ""
    at: Point | None = None


@dataclass(frozen=True, slots=True)
class Picture:
    """What the overlays need to know besides the sample.

    Attributes:
        robot: the robot.
        push: the latest push that has begun; None before the first.
        safe_border: width of the border the controller keeps, m.
        arrow_scale: length of force arrows against their natural length, on which the weight reaches the CoM.
    """

    robot: RobotModel
    push: Push | None = None
    safe_border: float = 0.0
    arrow_scale: float = 1.0


def overlays(sample: Sample, picture: Picture) -> list[Mark]:
    """All marks that exist in a sample; what is not there (no contact, no push) is not in the list.

    Args:
        sample: the sample.
        picture: what belongs to the picture besides it.
    """
    ground = float(sample["ground_pose"][:, 2].mean())
    polygon = polygon_of(sample, picture.robot)
    marks = [
        *_com(sample, ground),
        *_support(sample, picture, polygon, ground),
        *_pressure(sample, polygon, ground),
        *_forces(sample, picture, ground),
        *_push(sample, picture, ground),
    ]
    return [mark for mark in marks if all(math.isfinite(x) for point in mark.points for x in point)]


def _com(sample: Sample, ground: float) -> list[Mark]:
    x, y, z = sample["com"].tolist()
    return [Mark("com", ((x, y, z),)), Mark("com_ground", (_on_ground("com_ground", (x, y), ground),))]


def _support(sample: Sample, picture: Picture, polygon: np.ndarray, ground: float) -> list[Mark]:
    """The support polygon, the border the controller keeps, and how near the CoP is to the edge."""
    if len(polygon) < 3:
        return []
    safe = polygon_of(sample, picture.robot, picture.safe_border)
    cop = sample["cop_measured"]
    margin = support_margin(cop, polygon)
    return [
        Mark("support", tuple(_on_ground("support", corner, ground) for corner in polygon.tolist())),
        Mark(
            "safe_border",
            _dashes(tuple(map(tuple, safe.round(_DIGITS).tolist())), round(ground, _DIGITS)),
            text=f"CoP {round(1e3 * margin)} mm from the edge" if math.isfinite(margin) else "",
            at=_on_ground("safe_border", _out_of_the_way(polygon, sample["com"][2]), ground),
        ),
    ]


def _pressure(sample: Sample, polygon: np.ndarray, ground: float) -> list[Mark]:
    """Points where the ground pushes, should push and may push."""
    marks = [
        Mark(key, (_on_ground(key, sample[name].tolist(), ground),))
        for key, name in (
            ("cop_granted", "cop_admissible"),
            ("cop_desired", "cop_desired"),
            ("cop", "cop_measured"),
            ("cmp", "cmp"),
            ("capture", "capture_point"),
        )
    ]
    return marks if len(polygon) else marks[-1:]


def _forces(sample: Sample, picture: Picture, ground: float) -> list[Mark]:
    """Ground reaction forces, and what they do to the angular momentum."""
    feet = carrying_feet(sample, picture.robot.mass)
    if not feet:
        return []
    wrenches, com = sample["foot_wrench_measured"], sample["com"]
    metres_per_newton = _metres_per_newton(sample, picture, ground)
    foot_cops = [
        sole_placement(sample, foot).act(np.append(sample["foot_cop_measured"][foot], 0.0)) for foot in feet
    ]
    net = wrenches[list(feet), :3].sum(axis=0)
    cop = np.append(sample["cop_measured"], ground + _TOP_LAYER)
    cmp = np.append(sample["cmp"], ground + _TOP_LAYER)
    weights = net / (picture.robot.mass * GRAVITY)
    marks = [
        Mark("foot_cop", tuple(_point(p + _RAISED) for p in foot_cops)),
        Mark(
            "foot_grf",
            tuple(
                end
                for foot, start in zip(feet, foot_cops, strict=True)
                for end in (_point(start), _point(start + metres_per_newton * wrenches[foot, :3]))
            ),
        ),
        Mark(
            "grf",
            (_point(cop), _point(cop + metres_per_newton * net)),
            text=f"{steady(float(np.linalg.norm(net)), 0, _NEWTONS)} N",
            at=_point(cop + 0.45 * metres_per_newton * net),
        ),
        Mark("com_cmp", (_point(com), _point(cmp))),
    ]
    gap = float(np.linalg.norm((cmp - cop)[:2]))
    if gap > _NO_GAP * (com[2] - ground) and weights[2] > NO_FORCE:
        text = f"rate of angular momentum {steady(gap * net[2], 0, _NEWTON_METRES)} N m"
        marks.append(Mark("gap", (_point(cop), _point(cmp)), text=text, at=_beside(cop, cmp, com[2])))
    return marks


def _push(sample: Sample, picture: Picture, ground: float) -> list[Mark]:
    """The latest push: while it acts and a moment longer, because a tenth of a second is too short to see."""
    push = picture.push
    if push is None or not 0.0 <= sample.number("time") - push.start < push.duration + _PUSH_SHOWN:
        return []
    com = sample["com"]
    force = push.force or 0.0
    weight = picture.robot.mass * GRAVITY
    arrow = PUSH_LENGTH * (com[2] - ground) * picture.arrow_scale * force / weight * push.direction
    end = _pushed_point(sample, picture.robot, push, ground)
    at = end - arrow
    if push.point is not None:  # a hand pulls at its point, and the words must not hide a short arrow
        end = end + arrow
        at = end + _LABEL_ABOVE * com[2] * np.array([0.0, 0.0, 1.0])
    return [
        Mark(
            "push",
            (_point(end - arrow), _point(end)),
            text=f"{force:.0f} N for {1e3 * push.duration:.0f} ms",
            at=_point(at),
        )
    ]


def _pushed_point(sample: Sample, robot: RobotModel, push: Push, ground: float) -> np.ndarray:
    """Where a push meets the robot (3,), m: at its own point, or before the body."""
    if push.point is not None:
        data = robot.model.createData()
        pin.forwardKinematics(robot.model, data, sample["q"])
        point: np.ndarray = pin.updateFramePlacement(robot.model, data, pushed_frame(robot, push)).act(
            np.array(push.point)
        )
        return point
    com = sample["com"]
    height = com[2] if push.height is None else ground + push.height
    before: np.ndarray = np.array([com[0], com[1], height]) - 0.12 * com[2] * push.direction
    return before


def _metres_per_newton(sample: Sample, picture: Picture, ground: float) -> float:
    """So that the weight of the standing robot reaches from the ground to its CoM."""
    return picture.arrow_scale * (sample["com"][2] - ground) / (picture.robot.mass * GRAVITY)


def _beside(start: np.ndarray, end: np.ndarray, size: float) -> Point:
    """A place for the label of a line on the ground: across from its middle."""
    x, y, _ = (end - start) / np.linalg.norm(end - start)
    across = np.array([-y, x])
    if across @ _SIDE < 0.0:
        across = -across
    middle = 0.5 * (start + end)
    middle[:2] += _BESIDE * size * across
    return _point(middle)


@lru_cache(maxsize=16)
def _dashes(corners: tuple[tuple[float, float], ...], ground: float) -> tuple[Point, ...]:
    """Starts and ends of the dashes along a polygon; that of standing feet is asked for again and again."""
    ends: list[Point] = []
    polygon = np.array(corners)
    for corner, following in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        count = max(1, round(float(np.linalg.norm(following - corner)) / (2.0 * _DASH)))
        for i in range(count):
            for along in ((i + 0.25) / count, (i + 0.75) / count):
                x, y = (corner + along * (following - corner)).tolist()
                ends.append(_on_ground("safe_border", (x, y), ground))
    return tuple(ends)


def _out_of_the_way(polygon: np.ndarray, size: float) -> list[float]:
    """A place beside the polygon where no other label is."""
    corner = polygon[int(np.argmax(polygon @ _LEFT))]
    place: list[float] = (corner + 0.5 * _BESIDE * size * _SIDE).tolist()
    return place


def _on_ground(key: str, point: tuple[float, float] | list[float], ground: float) -> Point:
    return float(point[0]), float(point[1]), ground + _LAYER.get(key, _TOP_LAYER)


def _point(p: np.ndarray) -> Point:
    x, y, z = p.tolist()
    return x, y, z
