"""Table 1: all methods of this lab on the same push."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.control.planner import OWN, PLANNERS
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.experiments.canvas import CMP, COM, COP, FORCE, SPIN, band, canvas, finish, heading
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import (
    Claim,
    Columns,
    Figure,
    Runs,
    at_least,
    at_most,
    fate,
    largest,
    stands,
)
from momentum_lab.experiments.measured import com_moved, foot_cops, push_end, rate_gap, saturated, times
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.plain import plain
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

_MM = 1e3
_COLORS = (COP, CMP, FORCE, COM, SPIN)
# Methods that choose foot forces before they move; the others find out what the ground gave.
_FORCE_FIRST = ("computed-torque", "placo-wbc", "slack-qp", "whole-body-qp")
# Rows a and c stand above computed torque, which then grants what they ask.
_PLANNED = tuple(name for name in PLANNERS if name != OWN)


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The same push for every controller, each with its own gains, and for the other rows' planners."""
    scenario = chosen("table1", robot)
    methods = {name: changed(scenario, controller=name, gains={}) for name in CONTROLLERS}
    return methods | {name: changed(methods["computed-torque"], planner=name) for name in _PLANNED}


def title(name: str) -> str:
    """What a method is called: a controller, or a planner above computed torque."""
    return CONTROLLERS[name].title if name in CONTROLLERS else f"{PLANNERS[name].title}, planned"


def planned_beyond(session: Session) -> float:
    """How far the planned CoP of a foot goes beyond the front edge of its sole, m; NaN where none is planned."""
    planned = foot_cops(session, "foot_wrench_admissible")[:, :, 0]
    if not np.isfinite(planned).any():
        return float("nan")
    return float(np.nanmax(planned) - session.robot.soles[0].upper[0])


def measured_beyond(session: Session) -> float:
    """The same for the CoP that the ground gave, on 99 % of the ticks, m."""
    measured = session.recording.column("foot_cop_measured")[:, :, 0]
    return float(np.nanpercentile(measured, 99) - session.robot.soles[0].upper[0])


def force_beyond(session: Session) -> float:
    """How far the CMP of the desired force goes beyond the front edge of the soles, m (Eqs. 22, 39)."""
    columns = session.recording.column
    force = columns("momentum_rate_desired")[:, :3] + [0.0, 0.0, session.robot.mass * GRAVITY]
    asked = (columns("fallen") == 0.0) & (force[:, 2] > 0.0)
    force, com, sole = force[asked], columns("com")[asked], columns("sole_pose")[asked, 0]
    cmp = com[:, 0] - force[:, 0] / force[:, 2] * (com[:, 2] - sole[:, 2])
    return float((cmp - sole[:, 0]).max() - session.robot.soles[0].upper[0])


def settled(session: Session) -> float:
    """Speed of the CoM at the end, m/s."""
    return float(np.linalg.norm(session.recording.column("com_velocity")[-1]))


def claims(runs: Runs) -> list[Claim]:
    """Every method stands; those that choose forces plan a CoP inside the soles, one does not ask."""
    found = [stands(name, session) for name, session in runs.items()]
    for name, session in runs.items():
        found.append(at_most(f"{name}: the CoM comes to rest", settled(session), 0.03, "m/s"))
        found.append(at_most(f"{name}: ticks without an answer", session.solver_failures, 0, "ticks"))
    for name in _FORCE_FIRST:
        beyond = _MM * planned_beyond(runs[name])
        found.append(at_most(f"{name}: planned CoP beyond the toes", beyond, 0.1, "mm"))
        session = runs[name]
        lost = largest(rate_gap(session)[:, :3]) / (session.robot.mass * GRAVITY)
        found.append(at_most(f"{name}: linear momentum rate given up", lost, 0.05, "m g"))
    bounded = int(saturated(runs["resolved-momentum"]).sum())
    found.append(at_most("resolved-momentum: ticks on which it bounds its CoP", bounded, 0, "ticks"))
    force_first = min(_spin(runs[name]) for name in ("computed-torque", "whole-body-qp"))
    ratio = _spin(runs["resolved-momentum"]) / force_first
    found.append(at_least("it turns the body more than the method that turns it least", ratio, 1.0, "times"))
    beyond, wanted = (_MM * force_beyond(runs[name]) for name in ("cop-to-com", "computed-torque"))
    found.append(at_most("cop-to-com: CMP of the desired force beyond the toes", beyond, 0.1, "mm"))
    found.append(at_least("computed-torque: the same, which turns the body", wanted, 1.0, "mm"))
    for name in _PLANNED:
        beyond = _MM * planned_beyond(runs[name])
        found.append(at_most(f"{name}: planned CoP beyond the toes", beyond, 0.1, "mm"))
    outside = int(saturated(runs["cop-and-force"]).sum())
    found.append(at_most("cop-and-force: ticks on which its CoP is not granted", outside, 0, "ticks"))
    return found


def _spin(session: Session) -> float:
    return largest(session.recording.column("momentum")[:, 4])


def table(runs: Runs) -> Columns:
    """One row for every method."""
    sessions = list(runs.values())
    return {
        "method": [title(name) for name in runs],
        "result": [fate(session).partition(":")[0] for session in sessions],
        "CoM moved at most [mm]": [_MM * largest(com_moved(session)) for session in sessions],
        "|k_y| at most [N m s]": [_spin(session) for session in sessions],
        "planned CoP beyond toes [mm]": [_MM * planned_beyond(session) for session in sessions],
        "measured CoP beyond toes, 99 % [mm]": [_MM * measured_beyond(session) for session in sessions],
        "desired CoP outside [s]": [
            float(saturated(session).sum() * session.scenario.timestep) for session in sessions
        ],
        "dl given up [N]": [largest(rate_gap(session)[:, :3]) for session in sessions],
        "dk given up [N m]": [largest(rate_gap(session)[:, 3:]) for session in sessions],
        "CoM speed at the end [mm/s]": [_MM * settled(session) for session in sessions],
    }


def draw(runs: Runs) -> Any:
    """The table, and above it CoM and angular momentum of all methods."""
    first = next(iter(runs.values()))
    picture, axes = canvas(heading("Table 1: all methods on the same push", first), 2, 2, (14.0, 7.5))
    quantities = (
        (axes[0, 0], "CoM forward of its start", "x [mm]", lambda run: _MM * com_moved(run)[:, 0]),
        (
            axes[0, 1],
            "angular momentum about the CoM",
            "$k_y$ [N m s]",
            lambda run: run.recording.column("momentum")[:, 4],
        ),
    )
    for panel, subtitle, unit, values in quantities:
        for i, (name, session) in enumerate(runs.items()):
            color, dash = _COLORS[i % len(_COLORS)], "-" if i < len(_COLORS) else "--"
            panel.plot(times(session), values(session), dash, color=color, label=title(name))
        band(panel, first)
        panel.set_xlim(0.0, push_end(first) + 1.7)
        finish(panel, subtitle, "time [s]", unit, loc="upper right")
    grid = axes[1, 0].get_gridspec()
    for panel in axes[1]:
        panel.remove()
    _written(picture.add_subplot(grid[1, :]), table(runs))
    return picture


def _written(axes: Any, columns: Columns) -> None:
    axes.axis("off")
    cells = [[_cell(value) for value in row] for row in zip(*columns.values(), strict=True)]
    heads = [name.replace(" [", "\n[").replace(" beyond", "\nbeyond") for name in columns]
    written = axes.table(cells, colLabels=heads, loc="center", cellLoc="center")
    written.auto_set_font_size(False)
    written.set_fontsize(9)
    written.scale(1.0, 1.5)
    written.auto_set_column_width(list(range(len(heads))))
    for (row, _), cell in written.get_celld().items():
        cell.set_edgecolor("#cccccc")
        if row == 0:
            cell.set_height(2.2 * cell.get_height())


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return value
    return "-" if not np.isfinite(value) else plain(value, ".2f")


FIGURE = Figure("table1", "All methods on the same push", scenarios, draw, table, claims)
