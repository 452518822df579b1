"""Fig. 5: a lateral push on one leg; the CMP leaves the foot, the CoP cannot, body and swing leg rotate."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import (
    CMP,
    COM,
    COP,
    INK,
    MUTED,
    SPIN,
    band,
    canvas,
    finish,
    heading,
    legend_below,
)
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest, stands
from momentum_lab.experiments.measured import com_outside_goal, pelvis_turn, times
from momentum_lab.experiments.sticks import FRONT, snapshot
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

_MM = 1e3


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """One push outward, to the left on the left leg."""
    return {"push": chosen("fig5", robot)}


def edge(session: Session) -> float:
    """The outer edge of the stance sole (y), m."""
    foot = session.stance[0]
    return float(session.recording.column("sole_pose")[0, foot, 1] + session.robot.soles[foot].upper[1])


def swing_foot(session: Session) -> np.ndarray:
    """Way of the lifted sole from where it was, across and up (n, 2), m."""
    lifted = next(foot for foot in range(len(session.robot.soles)) if foot not in session.stance)
    place = session.recording.column("sole_pose")[:, lifted, 1:3]
    return place - place[0]


def claims(runs: Runs) -> list[Claim]:
    """A push to the left asks for a force to the right: the CMP goes left, and k_x < 0 turns the body left."""
    session = runs["push"]
    column, outer = session.recording.column, edge(session)
    swing = swing_foot(session)
    return [
        stands("the robot", session),
        at_least("the CMP leaves the foot by", _MM * float(column("cmp")[:, 1].max() - outer), 5.0, "mm"),
        at_most(
            "the CoP stays inside the edge of the foot, beyond it by",
            _MM * float(column("cop_measured")[:, 1].max() - outer),
            0.0,
            "mm",
        ),
        at_most(
            "the angular momentum turns with the push: k_x",
            float(column("momentum")[:, 3].min()),
            -0.2,
            "N m s",
        ),
        at_most("the body rotates with it: roll of the pelvis", float(_roll(session).min()), -0.02, "rad"),
        at_least(
            "the swing leg rotates with it: its foot goes outward and up by",
            _MM * largest(np.linalg.norm(swing, axis=1)),
            10.0,
            "mm",
        ),
        at_least("upward by", _MM * float(swing[:, 1].max()), 5.0, "mm"),
        at_most(
            "the CoM is back at the end, within",
            _MM * largest(np.linalg.norm(com_outside_goal(session)[-100:], axis=1)),
            2.0,
            "mm",
        ),
    ]


def _roll(session: Session) -> np.ndarray:
    return pelvis_turn(session)[:, 0]


def table(runs: Runs) -> Columns:
    """Points on the ground from the edge of the foot, momentum, and what turns."""
    session = runs["push"]
    column, outer, swing = session.recording.column, edge(session), swing_foot(session)
    return {
        "time [s]": times(session),
        "CoM y from the outer edge [m]": column("com")[:, 1] - outer,
        "CoP y from the outer edge [m]": column("cop_measured")[:, 1] - outer,
        "CMP y from the outer edge [m]": column("cmp")[:, 1] - outer,
        "k_x [N m s]": column("momentum")[:, 3],
        "pelvis roll [rad]": _roll(session),
        "swing foot y [m]": swing[:, 0],
        "swing foot z [m]": swing[:, 1],
    }


def draw(runs: Runs) -> Any:
    """The robot before, when the CMP is farthest out, and when the body has turned most; curves below."""
    session = runs["push"]
    title = heading("Fig. 5: a push to the left on the left leg", session)
    picture, axes = canvas(title, 2, 3, (14.0, 8.5))
    clock, data = times(session), table(runs)
    farthest = int(np.argmax(data["CMP y from the outer edge [m]"]))
    turned = int(np.argmin(data["pelvis roll [rad]"]))
    for place, tick in enumerate((0, farthest, turned)):
        snapshot(axes[0, place], session, tick, FRONT, f"{clock[tick]:.2f} s, from the front")
    legend_below(picture, axes[0, 0])
    for panel in axes[1]:
        band(panel, session)
    for name, color in (("CoM", COM), ("CoP", COP), ("CMP", CMP)):
        values = _MM * np.asarray(data[f"{name} y from the outer edge [m]"])
        axes[1, 0].plot(clock, values, color=color, label=name)
    axes[1, 0].axhline(0.0, color=MUTED, lw=1.0, label="outer edge of the foot")
    finish(axes[1, 0], "left of the outer edge", "time [s]", "y [mm]")
    axes[1, 1].plot(clock, data["k_x [N m s]"], color=SPIN, label="$k_x$")
    finish(axes[1, 1], "angular momentum about the CoM", "time [s]", "$k_x$ [N m s]")
    axes[1, 2].plot(
        clock, np.degrees(data["pelvis roll [rad]"]), color=SPIN, label="roll of the pelvis [deg]"
    )
    axes[1, 2].plot(clock, 1e2 * np.asarray(data["swing foot z [m]"]), color=INK, label="swing foot up [cm]")
    away = 1e2 * np.asarray(data["swing foot y [m]"])
    axes[1, 2].plot(clock, away, "--", color=INK, label="swing foot to the left [cm]")
    finish(axes[1, 2], "what rotates", "time [s]", "[deg], [cm]")
    return picture


FIGURE = Figure("fig5", "A lateral push on one leg", scenarios, draw, table, claims)
