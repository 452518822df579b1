"""A drop in which a loop of the legs turns the body, with no angular momentum; and one with a push."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.control.motion import MOTIONS, reach_of
from momentum_lab.experiments import flight_push
from momentum_lab.experiments.canvas import CMP, COP, FORCE, INK, MUTED, SPIN, band, canvas, finish, heading
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest
from momentum_lab.experiments.flight_push import PUSHED, PUSHED_FINER, spin
from momentum_lab.experiments.measured import pelvis_turn, times
from momentum_lab.experiments.sticks import FRONT, from_above, snapshot
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.momentum.holonomy import floating_path, turn_between
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

LEFT, RIGHT, FINER = "loop", "loop the other way", "loop, half the tick"
_Z = 2
_HALF_VIEW = 1.1


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The loop, the same the other way round and with half the tick, and the pushed drop."""
    scenario = chosen("flight", robot)
    return {
        LEFT: scenario,
        RIGHT: changed(scenario, motion="cat-right"),
        FINER: changed(scenario, timestep=0.5 * scenario.timestep),
        **flight_push.scenarios(robot),
    }


def asked(session: Session) -> np.ndarray:
    """The loop that the joints are told to go (n, na), rad, whether they go it or not."""
    courses = MOTIONS[session.choices.motion].courses.values()
    ways = np.array([[course(time)[0] for course in courses] for time in times(session)])
    start = session.recording.column("q")[0, 7:]
    return np.asarray(start + ways @ reach_of(session.robot, session.choices.motion))


def foretold(session: Session) -> np.ndarray:
    """Turn of the base about the vertical (n,), rad, by kinematics alone: the asked loop with A_G v = 0."""
    start = session.recording.column("q")[0]
    path = floating_path(session.robot, start, asked(session))
    return np.array([turn_between(start, q)[_Z] for q in path])


def turned(session: Session) -> float:
    """How far the body has turned about the vertical in the end, rad."""
    return float(pelvis_turn(session)[-1, _Z])


def shares(session: Session) -> tuple[np.ndarray, np.ndarray]:
    """Angular momentum about z (n,), N m s: of the body turning as one, and of the joints' motion."""
    column, found = session.recording.column, []
    for q, v in zip(column("q"), column("v"), strict=True):
        parts = session.robot.at(State(q, v)).centroidal_map[5] * v
        found.append((parts[:6].sum(), parts[6:].sum()))
    body, joints = np.array(found).T
    return body, joints


def fallen(session: Session) -> np.ndarray:
    """Where a stone would be that was dropped with the CoM (n, 3), m."""
    stone = np.tile(session.recording.column("com")[0], (len(times(session)), 1))
    stone[:, _Z] -= 0.5 * GRAVITY * times(session) ** 2
    return stone


def claims(runs: Runs) -> list[Claim]:
    """The shape comes back, the body does not, and k is zero all the time: a geometric phase.

    The turn is what A_G v = 0 gives along the loop. What differs comes from the integrator, to first order in the
    tick; two runs tell what is left when the tick goes to zero.
    """
    left, right, finer = runs[LEFT], runs[RIGHT], runs[FINER]
    joints = left.recording.column("q")[:, 7:]
    touching = max(largest(run.recording.column("foot_wrench_measured")) for run in (left, right, finer))
    limbs, expected = largest(shares(left)[1]), float(foretold(left)[-1])
    limit = 2.0 * turned(finer) - turned(left)
    fall = float(fallen(left)[0, _Z] - fallen(left)[-1, _Z])
    return [
        at_most("nothing touches the ground", touching, 0.0, "N"),
        at_least("the joints go on a loop, out to", largest(joints - joints[0]), 0.35, "rad"),
        at_most("and are back in the end, within", largest(joints[-1] - joints[0]), 0.005, "rad"),
        at_least("their motion has angular momentum", limbs, 2.0, "N m s"),
        at_most("the whole robot has none, to this part of it", largest(spin(left)) / limbs, 0.02, "of it"),
        at_most(
            "half the tick has less: this part",
            largest(spin(finer)) / largest(spin(left)),
            0.7,
            "of the rest",
        ),
        at_least("the body has turned to the left by", turned(left), 0.35, "rad"),
        at_most(
            "as kinematics alone foretells, within", abs(turned(left) / expected - 1.0), 0.05, "of its turn"
        ),
        at_most("and as the tick goes to zero, within", abs(limit / expected - 1.0), 0.002, "of its turn"),
        at_most(
            "the loop the other way turns it back, within",
            abs(turned(left) + turned(right)) / abs(turned(left)),
            0.01,
            "of its turn",
        ),
        at_most(
            "the CoM falls like a stone, within",
            largest(left.recording.column("com") - fallen(left)) / fall,
            0.005,
            "of its fall",
        ),
        *flight_push.claims(runs[PUSHED], runs[PUSHED_FINER]),
    ]


def table(runs: Runs) -> Columns:
    """The loop, what turns, and the momentum, of the two loops and of the pushed drop."""
    left, pushed = runs[LEFT], runs[PUSHED]
    body, joints = shares(left)
    ways = done(left)
    return {
        "time [s]": times(left),
        **{
            f"{name} [1]": way for name, way in zip(MOTIONS[left.choices.motion].courses, ways.T, strict=True)
        },
        "CoM z [m]": left.recording.column("com")[:, _Z],
        **{f"k_{name} [N m s]": spin(left)[:, axis] for axis, name in enumerate("xyz")},
        "k_z of the body as one [N m s]": body,
        "k_z of the joints [N m s]": joints,
        "turn about z [rad]": pelvis_turn(left)[:, _Z],
        "turn about z, foretold [rad]": foretold(left),
        "turn about z, the other way [rad]": pelvis_turn(runs[RIGHT])[:, _Z],
        **{name: _as_long(column, len(body)) for name, column in _pushed_table(pushed).items()},
    }


def _pushed_table(session: Session) -> dict[str, np.ndarray]:
    return {
        "pushed: time [s]": times(session),
        **{f"pushed: k_{name} [N m s]": spin(session)[:, axis] for axis, name in enumerate("xyz")},
        "pushed: pelvis turn y [rad]": pelvis_turn(session)[:, 1],
    }


def _as_long(column: np.ndarray, rows: int) -> list[Any]:
    """A column of a shorter run with empty cells below it."""
    return [*column, *[""] * (rows - len(column))]


def done(session: Session) -> np.ndarray:
    """How far the joints are on each course of their motion (n, courses), 1."""
    reach = reach_of(session.robot, session.choices.motion)
    angles = session.recording.column("q")[:, 7:]
    return np.asarray((angles - angles[0]) @ np.linalg.pinv(reach))


def draw(runs: Runs) -> Any:
    """The loop and what it does to the body; below, what is zero meanwhile, and what a push gives."""
    left, right = runs[LEFT], runs[RIGHT]
    picture, axes = canvas(heading("Flight: turning without angular momentum", left), 2, 4, (17.0, 8.5))
    _loop(axes[0, 0], left)
    _widest(axes[0, 1], left)
    for panel, session in zip(axes[0, 2:], (left, right), strict=True):
        degrees = np.degrees(turned(session))
        title = f"from above: turned {'left' if degrees > 0.0 else 'right'} by {abs(degrees):.0f} degrees"
        from_above(panel, session, {"before": (0, MUTED), "after": (len(times(session)) - 1, FORCE)}, title)
    _zero(axes[1, 0], left)
    _turns(axes[1, 1], left, right)
    _fall(axes[1, 2], left)
    _pushed(axes[1, 3], runs[PUSHED])
    return picture


def _loop(axes: Any, session: Session) -> None:
    first, second = MOTIONS[session.choices.motion].courses
    ways = done(session)
    told = (asked(session) - asked(session)[0]) @ np.linalg.pinv(
        reach_of(session.robot, session.choices.motion)
    )
    axes.plot(told[:, 0], told[:, 1], "--", color=INK, lw=1.0, label="asked")
    axes.plot(ways[:, 0], ways[:, 1], color=COP, label="gone")
    axes.plot(*ways[0], "o", color=INK, ms=7, label="start and end")
    for tick in (np.searchsorted(np.cumsum(np.abs(np.diff(ways, axis=0)).sum(axis=1)), (1.0, 3.0))).tolist():
        if tick + 8 >= len(ways):
            continue  # a run that broke off before
        axes.annotate(
            "",
            ways[tick + 8],
            ways[tick],
            arrowprops={"arrowstyle": "-|>", "color": COP, "mutation_scale": 18},
        )
    finish(axes, "the legs go out on one way and back on another", f"{first} [1]", f"{second} [1]")


def _widest(axes: Any, session: Session) -> None:
    tick = int(done(session)[:, 1].argmax())
    snapshot(axes, session, tick, FRONT, f"from the front, {times(session)[tick]:.2f} s")
    middle = session.recording.column("com")[tick]
    axes.set_xlim(middle[1] + _HALF_VIEW, middle[1] - _HALF_VIEW)
    axes.set_ylim(middle[_Z] - _HALF_VIEW, middle[_Z] + _HALF_VIEW)


def _zero(axes: Any, session: Session) -> None:
    body, joints = shares(session)
    axes.plot(times(session), joints, color=COP, label="of the joints' motion")
    axes.plot(times(session), body, color=CMP, label="of the body turning as one")
    axes.plot(times(session), spin(session)[:, _Z], color=SPIN, lw=2.5, label="together: $k_z$")
    finish(axes, "angular momentum is zero", "time [s]", "about z [N m s]")


def _turns(axes: Any, left: Session, right: Session) -> None:
    for session, color in ((left, FORCE), (right, CMP)):
        axes.plot(times(session), pelvis_turn(session)[:, _Z], color=color, label=session.choices.motion)
        axes.plot(times(session), foretold(session), ":", color=INK, label="by kinematics alone")
    finish(axes, "the body turns nevertheless", "time [s]", "pelvis about z [rad]")


def _fall(axes: Any, session: Session) -> None:
    axes.plot(times(session), session.recording.column("com")[:, _Z], color=FORCE, label="CoM")
    axes.plot(times(session), fallen(session)[:, _Z], ":", color=INK, label="a stone")
    finish(axes, "the CoM falls like a stone", "time [s]", "z [m]")


def _pushed(axes: Any, session: Session) -> None:
    band(axes, session)
    for axis, (name, color) in enumerate((("x", COP), ("y", SPIN), ("z", FORCE))):
        axes.plot(times(session), spin(session)[:, axis], color=color, label=f"$k_{name}$")
    pitch = np.degrees(pelvis_turn(session)[:, 1])
    axes.plot(times(session), pitch, "--", color=INK, label="pelvis about y [degrees]")
    finish(axes, "pushed in the air: what the push gives is kept", "time [s]", "k [N m s], angle [degrees]")


FIGURE = Figure("flight", "Turning in the air without angular momentum", scenarios, draw, table, claims)
