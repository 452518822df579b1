"""Fig. 7: the same push answered twice: priority 0 keeps linear momentum, priority 1 keeps angular momentum."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import CMP, COP, band, canvas, finish, heading, legend_below
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import (
    Claim,
    Columns,
    Figure,
    Runs,
    at_least,
    at_most,
    falls,
    largest,
    stands,
)
from momentum_lab.experiments.measured import com_moved, push_start, rate_gap, saturated, times, upright
from momentum_lab.experiments.sticks import SIDE, snapshot
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.scenario import Scenario, sides
from momentum_lab.session import Session

LINEAR, ANGULAR = "priority 0", "priority 1"
_COLORS = {LINEAR: COP, ANGULAR: CMP}
_MM = 1e3
# Where both robots are drawn: the moment that tells them apart, before the second one has fallen, s after the push.
_LATER = 0.6


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The same run with either priority: the two robots of the scenario."""
    return dict(zip((LINEAR, ANGULAR), sides(chosen("fig7", robot)), strict=True))


def claims(runs: Runs) -> list[Claim]:
    """Each robot keeps what it is to keep, pays with the other, and only one can afford it.

    While the robot with priority 1 is still about where it stood (its CoM has moved less than a sole is long),
    its controller's answer is that of Fig. 7, right; later it is falling.
    """
    linear, angular = runs[LINEAR], runs[ANGULAR]
    weight = linear.robot.mass * GRAVITY
    kept, paid = rate_gap(linear), rate_gap(angular)[_still_there(angular)]
    first = min(saturated(linear).argmax(), len(angular.recording))
    q = [run.recording.column("q")[:first] for run in (linear, angular)]
    return [
        at_least(
            "the push needs a CoP beyond the toes", _overshoot(linear), 5.0, "mm outside the safe border"
        ),
        at_most("until then both move alike: coordinates differ by", largest(q[0] - q[1]), 1e-3, "m or rad"),
        at_most(
            f"{LINEAR}: rate of linear momentum kept, within", largest(kept[:, :3]) / weight, 1e-3, "m g"
        ),
        at_least(f"{LINEAR}: rate of angular momentum gives way", largest(kept[:, 4]) / weight, 0.03, "m"),
        at_most(
            f"{ANGULAR}: rate of angular momentum kept, within", largest(paid[:, 3:5]) / weight, 1e-3, "m"
        ),
        at_least(f"{ANGULAR}: rate of linear momentum gives way", largest(paid[:, 0]) / weight, 0.03, "m g"),
        at_least("the CoM goes further with priority 1", _way(angular) / _way(linear), 1.5, "times as far"),
        stands(LINEAR, linear),
        falls(ANGULAR, angular),
    ]


def _still_there(session: Session) -> np.ndarray:
    sole = session.robot.soles[0]
    near = np.abs(com_moved(session)[:, 0]) < 0.5 * (sole.upper[0] - sole.lower[0])
    return near & upright(session) & (np.cumsum(~near) == 0)


def _overshoot(session: Session) -> float:
    """How far the desired CoP is outside what the ground can give, at most, mm."""
    column = session.recording.column
    return _MM * largest((column("cop_desired") - column("cop_admissible"))[:, 0])


def _way(session: Session) -> float:
    return largest(com_moved(session)[upright(session), 0])


def table(runs: Runs) -> Columns:
    """CoM, momentum and rates of both runs, along and about the axes of the push."""
    columns: dict[str, Any] = {"time [s]": times(runs[LINEAR])}
    ticks = len(columns["time [s]"])
    for label, session in runs.items():
        column = session.recording.column
        for name, values in (
            ("CoM x [m]", column("com")[:, 0]),
            ("l_x [N s]", column("momentum")[:, 0]),
            ("k_y [N m s]", column("momentum")[:, 4]),
            ("dl_x missing [N]", rate_gap(session)[:, 0]),
            ("dk_y missing [N m]", rate_gap(session)[:, 4]),
            ("fallen", column("fallen")),
        ):
            columns[f"{name}, {label}"] = np.resize(np.append(values, np.full(ticks, np.nan)), ticks)
    return columns


def draw(runs: Runs) -> Any:
    """Both robots at the same moment, and over time what each one has kept."""
    session = runs[LINEAR]
    title = heading("Fig. 7: the same push, and what has to give way", session)
    picture, axes = canvas(title, 2, 3, (14.0, 8.5), width_ratios=[1.0, 1.0, 1.3])
    for place, (label, run) in enumerate(runs.items()):
        kept = ("linear", "angular")[place]
        _robot(axes[0, place], run, push_start(session) + 0.1, f"{label}: keep {kept} momentum")
        _robot(axes[1, place], run, push_start(session) + _LATER, label)
    legend_below(picture, axes[0, 0])
    _over_time(axes[0, 2], runs, "CoM forward of its start", "x [mm]", lambda run: _MM * com_moved(run)[:, 0])
    _over_time(
        axes[1, 2],
        runs,
        "angular momentum about the CoM",
        "$k_y$ [N m s]",
        lambda run: run.recording.column("momentum")[:, 4],
    )
    highest = largest(session.recording.column("momentum")[:, 4])
    _cut(axes[0, 2], -20.0, 250.0)
    _cut(axes[1, 2], -0.5 * highest, 1.3 * highest)
    return picture


def _robot(axes: Any, session: Session, moment: float, title: str) -> None:
    tick = min(round(moment / session.scenario.timestep), len(session.recording) - 1)
    snapshot(axes, session, tick, SIDE, f"{title}, {times(session)[tick]:.2f} s")


def _over_time(axes: Any, runs: Runs, title: str, unit: str, values: Any) -> None:
    for label, session in runs.items():
        shown = upright(session)
        axes.plot(times(session)[shown], values(session)[shown], color=_COLORS[label], label=label)
        if session.fall is not None:
            axes.axvline(session.fall.time, color=_COLORS[label], ls=":", label=f"{label} has fallen")
    band(axes, runs[LINEAR])
    axes.set_xlim(0.0, runs[LINEAR].scenario.seconds)
    finish(axes, title, "time [s]", unit, loc="upper right")


def _cut(axes: Any, low: float, high: float) -> None:
    """Show a range, and say how far the curves go on outside it."""
    axes.set_ylim(low, high)
    for line in axes.get_lines():
        time, values = (np.asarray(data, dtype=float) for data in line.get_data())
        outside = np.flatnonzero((values < low) | (values > high))
        if len(values) < 3 or not len(outside):
            continue
        first, furthest = outside[0], values[np.abs(values).argmax()]
        axes.annotate(
            f"goes on to {furthest:.3g}",
            (time[first], high if values[first] > high else low),
            (-8, -10 if values[first] > high else 10),
            textcoords="offset points",
            ha="right",
            va="center",
            fontsize="small",
            color=line.get_color(),
        )


FIGURE = Figure("fig7", "The same push, and which momentum gives way", scenarios, draw, table, claims)
