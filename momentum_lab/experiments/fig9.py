"""Fig. 9: at rest on one leg with the CoM outside the foot; the body turns so that the CoM comes back."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import COM, COP, FORCE, INK, MUTED, SPIN, canvas, finish, legend_below
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import (
    Claim,
    Columns,
    Figure,
    Runs,
    at_least,
    at_most,
    falls,
    fate,
    largest,
    stands,
)
from momentum_lab.experiments.measured import com_outside_goal, pelvis_turn, times, upright
from momentum_lab.experiments.sticks import FRONT, snapshot
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

FORWARD, REVERSED = "CoM before body", "body before CoM"
_MM = 1e3
# The CoM's slack has gone once it stays below this part of its largest value.
_GONE = 0.02


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The run, and the same with the weights exchanged."""
    scenario = chosen("fig9", robot)
    return {FORWARD: scenario, REVERSED: changed(scenario, priority=1.0, seconds=min(3.0, scenario.seconds))}


def claims(runs: Runs) -> list[Claim]:
    """What the chapter says about its Fig. 9."""
    session = runs[FORWARD]
    cop, border = lateral_cop(session), outer_border(session)
    away = np.linalg.norm(com_outside_goal(session), axis=1)
    roll, missing, clock = np.abs(body_roll(session)), np.abs(com_slack(session)), times(session)
    pinned = np.abs(cop - border) < 0.5 / _MM
    return [
        at_least(
            "the CoM starts outside the edge of the foot", _MM * _outside(session), _asked(session), "mm"
        ),
        stands("the robot", session),
        at_least("the CoP is pinned to the safe border at first", _run_length(pinned, session), 0.3, "s"),
        at_most("and never beyond it", _MM * float(np.max(cop - border)), 0.5, "mm"),
        at_most("the CoM is back at the end, within", _MM * largest(away[-200:]), 1.0, "mm"),
        at_least("the CoM's slack, at most", largest(missing), 0.02, "m/s^2"),
        at_most("it is gone early", _last_above(clock, missing, _GONE), 2.0, "s"),
        at_least(
            "when it goes the body is still turned, as part of its largest roll",
            _then(clock, missing, roll) / largest(roll),
            0.5,
            "of it",
        ),
        at_least(
            "the roll falls below a tenth of its largest value later than the CoM",
            _last_above(clock, roll, 0.1) - _last_above(clock, away, 0.1),
            0.05,
            "s later",
        ),
        falls("with the priority reversed the robot", runs[REVERSED]),
    ]


def _asked(session: Session) -> float:
    """How far outside the scenario asks it to start, less a tenth of a millimetre for the posture's search, mm."""
    return _MM * (session.scenario.com_outside or 0.0) - 0.1


def stance_foot(session: Session) -> int:
    """The foot it stands on."""
    return session.stance[0]


def outward(session: Session) -> float:
    """Which way is out of the stance foot along y: 1 left, -1 right."""
    return (
        1.0 if session.recording.column("sole_pose")[0, stance_foot(session), 1] >= _middle(session) else -1.0
    )


def _middle(session: Session) -> float:
    return float(session.recording.column("sole_pose")[0, :, 1].mean())


def lateral_cop(session: Session) -> np.ndarray:
    """The measured CoP in the stance sole, outward (n,), m."""
    return outward(session) * session.recording.column("foot_cop_measured")[:, stance_foot(session), 1]


def outer_border(session: Session) -> float:
    """The outer safe border of the stance sole, outward from its origin, m."""
    sole = session.robot.soles[stance_foot(session)]
    edge = sole.upper[1] if outward(session) > 0.0 else -sole.lower[1]
    return float(edge) - float(session.choices.gains.safe_border)


def _outside(session: Session) -> float:
    """How far the CoM starts outside the outer edge, m."""
    y = (
        session.recording.column("com")[0, 1]
        - session.recording.column("sole_pose")[0, stance_foot(session), 1]
    )
    return float(outward(session) * y - outer_border(session) - session.choices.gains.safe_border)


def com_acceleration(session: Session) -> tuple[np.ndarray, np.ndarray]:
    """Desired (Eq. 42) and commanded lateral acceleration of the CoM (n,) each, m/s^2."""
    gains, column = session.choices.gains, session.recording.column
    desired = -gains.com_stiffness * com_outside_goal(session)[:, 1]
    desired = desired - gains.com_damping * column("com_velocity")[:, 1]
    return desired, column("momentum_rate_admissible")[:, 1] / session.robot.mass


def com_slack(session: Session) -> np.ndarray:
    """Lateral slack of the CoM (n,), m/s^2: desired minus commanded (Eq. 61)."""
    desired, commanded = com_acceleration(session)
    return desired - commanded


def body_roll(session: Session) -> np.ndarray:
    """Roll of the pelvis away from upright (n,), rad, as far as it has come from where it ends."""
    turn = pelvis_turn(session)[:, 0]
    return turn - turn[-1]


def _run_length(flags: np.ndarray, session: Session) -> float:
    """How long flags are set without a break from the start, s."""
    count = len(flags) if flags.all() else int(flags.argmin())
    return count * session.scenario.timestep


def _last_above(clock: np.ndarray, values: np.ndarray, part: float) -> float:
    """When a quantity is above a part of its largest value for the last time, s."""
    above = np.flatnonzero(values >= part * values.max())
    return float(clock[above[-1]]) if above.size else float("nan")


def _then(clock: np.ndarray, missing: np.ndarray, roll: np.ndarray) -> float:
    """The largest roll from when the slack goes on, rad."""
    return largest(roll[clock >= _last_above(clock, missing, _GONE)])


def table(runs: Runs) -> Columns:
    """CoP, CoM, accelerations, slack and roll of the run."""
    session = runs[FORWARD]
    desired, commanded = com_acceleration(session)
    return {
        "time [s]": times(session),
        "CoM y from its goal [m]": com_outside_goal(session)[:, 1],
        "CoP outward in the sole [m]": lateral_cop(session),
        "CoM acceleration y, desired [m/s^2]": desired,
        "CoM acceleration y, commanded [m/s^2]": commanded,
        "CoM slack y [m/s^2]": desired - commanded,
        "pelvis roll [rad]": body_roll(session),
    }


def draw(runs: Runs) -> Any:
    """(A) the robot at three moments, (B) CoM and CoP, (C) accelerations and slack, (D) roll."""
    session = runs[FORWARD]
    title = (
        "Fig. 9: at rest on one leg, the CoM outside the foot\n"
        f"{session.robot.spec.title}, {_MM * _outside(session):.0f} mm outside the edge"
    )
    picture, axes = canvas(title, 2, 3, (14.0, 8.5))
    clock = times(session)
    most = int(np.abs(body_roll(session)).argmax())
    for place, tick in enumerate((0, most, len(clock) - 1)):
        snapshot(axes[0, place], session, tick, FRONT, f"(A) {clock[tick]:.2f} s, from the front")
    legend_below(picture, axes[0, 0])
    data = table(runs)
    _positions(axes[1, 0], session, data)
    _accelerations(axes[1, 1], data)
    axes[1, 2].plot(clock, data["pelvis roll [rad]"], color=SPIN, label="this run")
    other = runs[REVERSED]
    shown = upright(other)
    label = f"priority reversed: {fate(other).partition(':')[0]}"
    # Both start alike, so that the same angle is upright for both.
    roll = pelvis_turn(other)[shown, 0] - pelvis_turn(session)[-1, 0]
    axes[1, 2].plot(times(other)[shown], roll, "--", color=MUTED, label=label)
    finish(axes[1, 2], "(D) roll of the pelvis", "time [s]", "roll [rad]")
    largest_roll = 1.6 * largest(body_roll(session))
    axes[1, 2].set_ylim(-largest_roll, largest_roll)
    return picture


def _positions(axes: Any, session: Session, data: Columns) -> None:
    sole = session.robot.soles[stance_foot(session)]
    center = outward(session) * float(sole.lower[1] + sole.upper[1]) / 2.0
    com = center + outward(session) * np.asarray(data["CoM y from its goal [m]"])
    axes.plot(data["time [s]"], _MM * com, color=COM, label="CoM")
    axes.plot(data["time [s]"], _MM * np.asarray(data["CoP outward in the sole [m]"]), color=COP, label="CoP")
    axes.axhline(_MM * outer_border(session), ls=":", color=INK, lw=1.0, label="safe border")
    edge = outer_border(session) + float(session.choices.gains.safe_border)
    axes.axhline(_MM * edge, color=MUTED, lw=1.0, label="edge of the sole")
    finish(axes, "(B) outward in the stance sole", "time [s]", "y [mm]", loc="upper right")


def _accelerations(axes: Any, data: Columns) -> None:
    for name, color, style in (("desired", COP, "-"), ("commanded", FORCE, "--")):
        axes.plot(
            data["time [s]"], data[f"CoM acceleration y, {name} [m/s^2]"], style, color=color, label=name
        )
    axes.plot(data["time [s]"], data["CoM slack y [m/s^2]"], color=SPIN, label="slack")
    finish(axes, "(C) lateral acceleration of the CoM", "time [s]", "[m/s$^2$]", loc="lower right")


FIGURE = Figure("fig9", "At rest on one leg with the CoM outside the foot", scenarios, draw, table, claims)
