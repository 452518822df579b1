"""Fig. 8: a push on a robot that stands on two feet, quantity by quantity."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import (
    CHANGED,
    COP,
    FORCE,
    GRANTED,
    INK,
    MUTED,
    SPIN,
    band,
    canvas,
    cut_spikes,
    finish,
    heading,
)
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest, stands
from momentum_lab.experiments.felt_push import cop_with_the_push, off_the_push
from momentum_lab.experiments.measured import (
    foot_cops,
    ground_force,
    push_end,
    push_start,
    rate_gap,
    saturated,
    times,
)
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

_MM = 1e3
_X, _Y = 0, 4
# Corners of the soles sink in by some micrometres, which moves the edge, m.
_EDGE = 1e-5
_RATE_LABELS = {"measured": "measured, push included"}


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The one push."""
    return {"push": chosen("fig8", robot)}


def claims(runs: Runs) -> list[Claim]:
    """What the chapter says about its push.

    Forces and moments are compared with the weight m g, so that the same bounds suit every robot.
    """
    session = runs["push"]
    clock, outside, gap = times(session), saturated(session), rate_gap(session)
    weight = session.robot.mass * GRAVITY
    quiet = (clock < push_start(session)) | (clock > session.scenario.seconds - 0.5)
    linear = largest(gap[:, :3]) / weight
    granted = foot_cops(session, "foot_wrench_admissible")[:, :, _X]
    difference = np.abs(granted - session.recording.column("foot_cop_measured")[:, :, _X])
    # The controller does not know the push: while it lasts, the measured CoP is off by what joints with inertia pass
    # on of it to the soles (1.5 mm for TALOS, 9 mm for iCub with its heavy rotors). Behind it the CoP comes back
    # from the very edge, a border's width away; a sole that tips and lands leaves a tick or two behind.
    quick = (clock < push_start(session)) | (clock > push_end(session))
    within = np.mean(
        difference[quick & (clock < push_end(session) + 0.5)] <= session.choices.gains.safe_border + _EDGE
    )
    return [
        stands("the robot", session),
        at_most(
            "before the push and at the end the desired CoP is admissible", outside[quiet].sum(), 0, "ticks"
        ),
        at_least("in between it is not", outside.sum() * session.scenario.timestep, 0.05, "s"),
        at_most(
            "it is not from the push on only", _first(clock, outside, session), 0.1, "s after the push began"
        ),
        at_most(
            "meanwhile the admissible CoP of each foot is on its front safe border, within",
            _MM * largest(granted[outside] - front_border(session)),
            0.5,
            "mm",
        ),
        at_most("the rate of linear momentum is kept throughout, within", linear, 1e-3, "m g"),
        at_least(
            "the rate of angular momentum about y gives way, forward", _given_way(gap) / weight, 0.01, "m"
        ),
        at_most("and only then", largest(gap[~outside][:, 3:5]) / weight, 2e-4, "m"),
        at_least("the body takes the spin of the push: k_y", _spin(session), 0.0, "N m s"),
        at_most(
            "pushed, with flat soles, the measured foot CoP is where the push moves it, within",
            _MM * off_the_push(session),
            0.5,
            "mm",
        ),
        at_least(
            "without a push it follows the admissible one within the border's width",
            within,
            0.95,
            "of the ticks",
        ),
    ]


def _first(clock: np.ndarray, outside: np.ndarray, session: Session) -> float:
    """When the desired CoP first leaves, after the start of the push, s."""
    return float(clock[outside][0] - push_start(session)) if outside.any() else float("nan")


def _given_way(gap: np.ndarray) -> float:
    """Admissible minus desired rate about y where they differ most, N m."""
    return -float(gap[np.abs(gap[:, _Y]).argmax(), _Y])


def _spin(session: Session) -> float:
    """The largest angular momentum about y after the push, with its sign, N m s."""
    spin = session.recording.column("momentum")[times(session) > push_end(session), _Y]
    return float(spin[np.abs(spin).argmax()]) if spin.size else float("nan")


def front_border(session: Session) -> float:
    """Front border of the safe region of a sole, from its origin, m."""
    return float(session.robot.soles[0].upper[0]) - float(session.choices.gains.safe_border)


def table(runs: Runs) -> Columns:
    """Everything that is drawn, about the axes of the push."""
    session = runs["push"]
    column = session.recording.column
    measured, granted = column("foot_cop_measured"), foot_cops(session, "foot_wrench_admissible")
    moved = cop_with_the_push(session)
    names = ("desired", "admissible", "measured")
    return {
        "time [s]": times(session),
        "push force x [N]": column("push_wrench")[:, _X],
        "l_x [N s]": column("momentum")[:, _X],
        **{f"dl_x {name} [N]": column(f"momentum_rate_{name}")[:, _X] for name in names},
        "GRF x [N]": ground_force(session)[:, 0],
        "GRF z [N]": ground_force(session)[:, 2],
        "k_y [N m s]": column("momentum")[:, _Y],
        **{f"dk_y {name} [N m]": column(f"momentum_rate_{name}")[:, _Y] for name in names},
        **{f"CoP x of {f} foot, measured [m]": measured[:, i, 0] for i, f in enumerate(_feet(session))},
        **{f"CoP x of {f} foot, admissible [m]": granted[:, i, 0] for i, f in enumerate(_feet(session))},
        **{f"CoP x of {f} foot, with the push [m]": moved[:, i] for i, f in enumerate(_feet(session))},
    }


def _feet(session: Session) -> tuple[str, ...]:
    return session.recording.layout.foot_names


def draw(runs: Runs) -> Any:
    """Eight panels over time, as in the chapter."""
    session = runs["push"]
    data = table(runs)
    title = heading(
        "Fig. 8: a push from behind: linear momentum is kept, angular momentum gives way", session
    )
    picture, axes = canvas(title, 4, 2, (11.0, 12.0), sharex=True)
    panels = axes.T.ravel()
    clock = data["time [s]"]
    single = (
        (0, "(a) push", "push force x [N]", INK, "force [N]"),
        (1, "(b) linear momentum", "l_x [N s]", FORCE, "$l_x$ [N s]"),
        (4, "(e) angular momentum", "k_y [N m s]", SPIN, "$k_y$ [N m s]"),
    )
    for place, name, key, color, unit in single:
        panels[place].plot(clock, data[key], color=color, label=name[4:])
        finish(panels[place], name, "", unit, loc="upper right")
    _rates(panels[2], data, "dl_x", "N", "(c) rate of linear momentum")
    _rates(panels[5], data, "dk_y", "N m", "(f) rate of angular momentum")
    panels[3].plot(clock, data["GRF z [N]"], color=FORCE, label="$f_z$")
    panels[3].plot(clock, data["GRF x [N]"], color=COP, label="$f_x$")
    finish(panels[3], "(d) ground reaction force, both feet", "time [s]", "force [N]", loc="center right")
    cut_spikes(panels[3])
    for place, letter, foot in zip((6, 7), "gh", _feet(session), strict=False):
        _foot(panels[place], session, data, letter, foot)
    panels[7].set_xlabel("time [s]", fontsize=9)
    panels[0].set_xlim(0.0, min(session.scenario.seconds, push_end(session) + 1.2))
    for panel in panels:
        band(panel, session)
    return picture


def _rates(axes: Any, data: Columns, key: str, unit: str, title: str) -> None:
    for name, color, style in (
        ("measured", MUTED, "-"),
        ("desired", CHANGED, "-"),
        ("admissible", GRANTED, "--"),
    ):
        axes.plot(
            data["time [s]"],
            data[f"{key} {name} [{unit}]"],
            style,
            color=color,
            label=_RATE_LABELS.get(name, name),
        )
    symbol = {"dl_x": r"$\dot l_x$", "dk_y": r"$\dot k_y$"}[key]
    finish(axes, title, "", f"{symbol} [{unit}]", loc="upper right")
    cut_spikes(axes)


def _foot(axes: Any, session: Session, data: Columns, letter: str, foot: str) -> None:
    sole, border = session.robot.soles[_feet(session).index(foot)], float(session.choices.gains.safe_border)
    clock = data["time [s]"]
    axes.plot(
        clock, _MM * np.asarray(data[f"CoP x of {foot} foot, measured [m]"]), color=COP, label="measured"
    )
    granted = _MM * np.asarray(data[f"CoP x of {foot} foot, admissible [m]"])
    axes.plot(clock, granted, "--", color=GRANTED, label="admissible")
    moved = _MM * np.asarray(data[f"CoP x of {foot} foot, with the push [m]"])
    axes.plot(clock, moved, ":", color=CHANGED, lw=2.0, label="admissible, moved by the push")
    for edge, inward in ((sole.upper[0], -border), (sole.lower[0], border)):
        axes.axhline(_MM * (edge + inward), ls=":", color=INK, lw=1.0, label="safe border")
        axes.axhline(_MM * edge, color=MUTED, lw=1.0, label="edge of the sole")
    finish(
        axes,
        f"({letter}) CoP of the {foot} foot",
        "",
        "x [mm]",
        loc="lower right",
        bbox_to_anchor=(1.0, 0.1),
        ncols=2,
    )


FIGURE = Figure("fig8", "The stationary push, quantity by quantity", scenarios, draw, table, claims)
