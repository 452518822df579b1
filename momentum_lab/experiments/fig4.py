"""Fig. 4: where CoP and CMP are without and with a rate of angular momentum."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import CMP, COP, INK, band, canvas, finish, heading, legend_below
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest, stands
from momentum_lab.experiments.measured import ground_force, momentum_slope, push_end, push_start, times
from momentum_lab.experiments.sticks import SIDE, snapshot
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

_MM = 1e3


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """One push: before it there is no angular momentum, after it there is."""
    return {"push": chosen("fig4", robot)}


def gap(session: Session) -> np.ndarray:
    """CMP minus CoP along x (n,), m, from the measured forces."""
    column = session.recording.column
    return column("cmp")[:, 0] - column("cop_measured")[:, 0]


def lever(session: Session) -> np.ndarray:
    """dk_y / f_z (n - 1,), m (Eq. 23), with dk_y from differences of the momentum of the moving links."""
    return momentum_slope(session)[:, 4] / ground_force(session)[:-1, 2]


def moments(session: Session) -> tuple[int, int]:
    """A tick of standing still before the push, and the one after it at which CoP and CMP are farthest apart."""
    later = times(session) > push_end(session)
    return 0, int(np.argmax(np.where(later, np.abs(gap(session)), 0.0)))


def claims(runs: Runs) -> list[Claim]:
    """Both points coincide exactly when the ground does not turn the body, and else differ by dk / f_z."""
    session = runs["push"]
    clock, apart = times(session), gap(session)
    before, after = clock < push_start(session), clock[:-1] > push_end(session)
    difference = np.abs(apart[:-1] - lever(session))[after]
    _, farthest = moments(session)
    front = session.recording.column("sole_pose")[farthest, :, 0].mean() + session.robot.soles[0].upper[0]
    return [
        stands("the robot", session),
        at_most(
            "without angular momentum CoP and CMP coincide, within", _MM * largest(apart[before]), 0.1, "mm"
        ),
        at_least("with it they are apart, at most", _MM * largest(apart[:-1][after]), 10.0, "mm"),
        at_most(
            "their distance is dk_y / f_z of the moving links, within (95 % of the ticks)",
            _MM * float(np.percentile(difference, 95)) if difference.size else float("nan"),
            0.5,
            "mm",
        ),
        at_most(
            "the CoP stays in the support, mm beyond the toes",
            _MM * float(session.recording.column("cop_measured")[farthest, 0] - front),
            0.5,
            "mm",
        ),
        at_least(
            "the CMP goes beyond it, mm beyond the toes",
            _MM * float(session.recording.column("cmp")[farthest, 0] - front),
            5.0,
            "mm",
        ),
    ]


def table(runs: Runs) -> Columns:
    """Both points and the lever of Eq. 23."""
    session = runs["push"]
    column = session.recording.column
    return {
        "time [s]": times(session)[:-1],
        "CoP x [m]": column("cop_measured")[:-1, 0],
        "CMP x [m]": column("cmp")[:-1, 0],
        "CMP - CoP [m]": gap(session)[:-1],
        "dk_y / f_z [m]": lever(session),
    }


def draw(runs: Runs) -> Any:
    """Left and middle as in the chapter; right the distance over time, twice."""
    session = runs["push"]
    picture, axes = canvas(heading("Fig. 4: CoP and CMP", session), 1, 3, (14.0, 5.6))
    clock = times(session)
    words = ("no angular momentum", "angular momentum changes")
    for place, tick in enumerate(moments(session)):
        snapshot(axes[0, place], session, tick, SIDE, f"{words[place]}, {clock[tick]:.2f} s")
    legend_below(picture, axes[0, 0])
    data = table(runs)
    right = axes[0, 2]
    right.plot(data["time [s]"], _MM * np.asarray(data["CoP x [m]"]), color=COP, label="CoP")
    right.plot(data["time [s]"], _MM * np.asarray(data["CMP x [m]"]), color=CMP, label="CMP")
    predicted = np.asarray(data["CoP x [m]"]) + np.asarray(data["dk_y / f_z [m]"])
    quiet = np.asarray(data["time [s]"]) > push_end(session)
    shown = np.where(quiet, predicted, np.nan)
    right.plot(data["time [s]"], _MM * shown, ":", color=INK, label=r"CoP + $\dot k_y / f_z$ (Eq. 23)")
    band(right, session)
    right.set_xlim(0.0, 1.2)
    low, high = np.percentile(_MM * session.recording.column("cmp")[:, 0], [0.2, 99.8])
    right.set_ylim(low - 20.0, high + 20.0)
    finish(right, "where they are", "time [s]", "x [mm]", loc="upper right")
    return picture


FIGURE = Figure("fig4", "CoP and CMP without and with angular momentum", scenarios, draw, table, claims)
