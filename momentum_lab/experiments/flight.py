"""A drop with a push in the air: the pose changes, the angular momentum does not."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import (
    CMP,
    COP,
    FORCE,
    INK,
    SPIN,
    band,
    canvas,
    finish,
    heading,
    legend_below,
)
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest
from momentum_lab.experiments.measured import momentum_slope, pelvis_turn, push_end, push_start, times
from momentum_lab.experiments.sticks import SIDE, snapshot
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

DROP, FINER = "drop", "half the tick"


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The drop, and the same with half the tick, to tell the integrator's error from a leak."""
    scenario = chosen("flight", robot)
    return {DROP: scenario, FINER: changed(scenario, timestep=0.5 * scenario.timestep)}


def spin(session: Session) -> np.ndarray:
    """Angular momentum about the CoM (n, 3), N m s."""
    return session.recording.column("momentum")[:, 3:]


def given(session: Session) -> np.ndarray:
    """Angular momentum that the push gives (3,), N m s: the sum of its moments about the CoM (Eq. 1)."""
    push, com = session.recording.column("push_wrench"), session.recording.column("com")
    moment = push[:, 3:] - np.cross(com, push[:, :3])
    return moment.sum(axis=0) * session.scenario.timestep


def drift(session: Session) -> float:
    """How far the angular momentum strays from what it is when the push ends, N m s."""
    after = spin(session)[times(session) > push_end(session) + 1e-9]
    return largest(after - after[0]) if len(after) else float("nan")


def claims(runs: Runs) -> list[Claim]:
    """In the air only weight acts, and it has no moment about the CoM.

    What is kept is kept by the integrator, to first order in the tick: half the tick, half the drift.
    """
    session = runs[DROP]
    column, clock, weight = session.recording.column, times(session), session.robot.mass * GRAVITY
    size = float(np.linalg.norm(given(session)))
    falling = clock[:-1] > push_end(session)
    after = clock > push_end(session)
    joints = column("q")[after, 7:]
    return [
        at_most("nothing touches the ground", largest(column("foot_wrench_measured")), 0.0, "N"),
        at_most(
            "before the push there is no angular momentum",
            largest(spin(session)[clock < push_start(session)]) / size,
            0.01,
            "of the push's",
        ),
        at_most(
            "the push gives what its moment says, within",
            largest(_after_push(session) - given(session)) / size,
            0.02,
            "of it",
        ),
        at_most("after it the angular momentum is kept, within", drift(session) / size, 0.01, "of it"),
        at_most(
            "half the tick strays less: this part of it",
            drift(runs[FINER]) / drift(session),
            0.7,
            "of the drift",
        ),
        at_least("meanwhile a joint moves by", largest(joints - joints[:1]), 0.03, "rad"),
        at_least("and the pelvis turns by", largest(pelvis_turn(session)[after]), 0.2, "rad"),
        at_most(
            "the linear momentum falls with the weight, within",
            abs(float(momentum_slope(session)[falling, 2].mean()) / weight + 1.0)
            if falling.any()
            else float("nan"),
            0.005,
            "m g",
        ),
    ]


def _after_push(session: Session) -> np.ndarray:
    """Angular momentum at the first tick after the push (3,), N m s."""
    after = spin(session)[times(session) > push_end(session) - 1e-9]
    return after[0] if len(after) else np.full(3, np.nan)


def table(runs: Runs) -> Columns:
    """Momentum and pose of the drop."""
    session = runs[DROP]
    column = session.recording.column
    turn = pelvis_turn(session)
    return {
        "time [s]": times(session),
        "CoM z [m]": column("com")[:, 2],
        "l_z [N s]": column("momentum")[:, 2],
        **{f"k_{name} [N m s]": spin(session)[:, axis] for axis, name in enumerate("xyz")},
        **{f"pelvis turn {name} [rad]": turn[:, axis] for axis, name in enumerate("xyz")},
        "largest joint angle from start [rad]": np.abs(column("q")[:, 7:] - column("q")[0, 7:]).max(axis=1),
    }


def draw(runs: Runs) -> Any:
    """Three moments of the drop; below, what is kept and what is not."""
    session = runs[DROP]
    picture, axes = canvas(heading("Flight: dropped, and pushed in the air", session), 2, 3, (14.0, 8.5))
    clock, data = times(session), table(runs)
    pushed = min(int(np.searchsorted(clock, push_end(session))), len(clock) - 1)
    for place, tick in enumerate((0, pushed, len(clock) - 1)):
        snapshot(axes[0, place], session, tick, SIDE, f"{clock[tick]:.2f} s")
    legend_below(picture, axes[0, 0])
    for panel in axes[1]:
        band(panel, session)
    for name, color in (("x", COP), ("y", SPIN), ("z", FORCE)):
        axes[1, 0].plot(clock, data[f"k_{name} [N m s]"], color=color, label=f"$k_{name}$")
        axes[1, 1].plot(clock, data[f"pelvis turn {name} [rad]"], color=color, label=f"pelvis about {name}")
    axes[1, 1].plot(
        clock, data["largest joint angle from start [rad]"], "--", color=INK, label="a joint, at most"
    )
    axes[1, 2].plot(clock, data["l_z [N s]"], color=CMP, label="$l_z$")
    expected = -session.robot.mass * GRAVITY * clock
    axes[1, 2].plot(clock, expected, ":", color=INK, label="$-m g t$")
    finish(axes[1, 0], "angular momentum is kept", "time [s]", "k [N m s]")
    finish(axes[1, 1], "the pose is not", "time [s]", "angle [rad]")
    finish(axes[1, 2], "linear momentum falls with the weight", "time [s]", "$l_z$ [N s]")
    return picture


FIGURE = Figure("flight", "Angular momentum in the air", scenarios, draw, table, claims)
