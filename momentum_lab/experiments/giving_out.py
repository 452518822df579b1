"""What gave out in a run that ended badly: feet, joints, motors, solver, and when."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from momentum_lab.momentum.support import support_margin, support_polygon
from momentum_lab.session import Session
from momentum_lab.summary import corners_in_world

# A foot that presses less than this on the ground has left it, N.
_LIFTED = 1.0
# A joint this close to the end of its range has used it up, rad.
_NEAR_END = 0.02
# A motor that gives this part of what it can gives all it has.
_ALL = 0.999


def what_gave_out(session: Session) -> tuple[str, ...]:
    """What came to its end from the first push to the fall: the first of each kind, in the order in which they did.

    Args:
        session: at least one tick old, its recording reaching back to the start.
    """
    robot = session.robot
    legs = sorted({int(joint) for sole in robot.soles for joint in sole.joints})
    others = [joint for joint in range(robot.na) if joint not in legs]
    ended, exhausted = _ended(session), _exhausted(session)
    feet = [f"{name} foot" for name in robot.foot_names]
    firsts = [
        _first(session, _escaping(session)[:, None], ["capture point"], "beyond the feet"),
        _first(session, _lifted(session), feet, "off the ground"),
        *(_first(session, ended, robot.joint_names, "at its limit", part) for part in (legs, others)),
        *(_first(session, exhausted, robot.joint_names, "at its motor's limit", p) for p in (legs, others)),
        _first(
            session,
            session.recording.column("solver_failed")[:, None] > 0.0,
            ["controller"],
            "without an answer",
        ),
    ]
    return tuple(f"{text} at {time:.2f} s" for time, text in sorted(first for first in firsts if first))


def _first(
    session: Session,
    happens: np.ndarray,
    names: Sequence[str],
    what: str,
    part: Sequence[int] | None = None,
) -> tuple[float, str] | None:
    """When and where something happens first between push and fall; None if it never does.

    Args:
        session: what has been run.
        happens: whether it does, tick by tick and place by place (n, P).
        names: of the places.
        what: what it is that happens.
        part: the places that are looked at; all of them unless given.
    """
    time = session.recording.column("time")
    pushed = time >= min((push.start for push in session.pushes), default=0.0)
    standing = pushed & (time <= (np.inf if session.fall is None else session.fall.time))
    places = np.arange(len(names)) if part is None else np.array(part)
    rows, columns = np.nonzero(happens[standing][:, places])
    return (float(time[standing][rows[0]]), f"{names[places[columns[0]]]} {what}") if rows.size else None


def _escaping(session: Session) -> np.ndarray:
    """Whether the capture point is beyond the soles as they stood at the start (n,)."""
    poses = session.recording.column("sole_pose")[0]
    polygon = support_polygon(corners_in_world(session, poses)[list(session.stance)].reshape(-1, 3))
    points = session.recording.column("capture_point")
    return np.array([support_margin(point, polygon) < 0.0 for point in points])


def _lifted(session: Session) -> np.ndarray:
    """For each foot whether it stands no more (n, F)."""
    forces = session.recording.column("foot_wrench_measured")[:, :, 2]
    return (forces < _LIFTED) & np.isin(np.arange(forces.shape[1]), session.stance)


def _ended(session: Session) -> np.ndarray:
    """For each joint whether it is at an end of its range, where it was not at the start (n, na)."""
    robot, angles = session.robot, session.recording.column("q")[:, 7:]
    near = (angles < robot.position_lower + _NEAR_END) | (angles > robot.position_upper - _NEAR_END)
    return near & ~near[0]


def _exhausted(session: Session) -> np.ndarray:
    """For each joint whether its motor is at its limit (n, na)."""
    return np.abs(session.recording.column("torque")) >= _ALL * session.robot.effort_limit
