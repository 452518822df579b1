"""A kick with all six momenta held, and with l and k_z alone: what the upper body has to do (section 5.3.1)."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import COP, FORCE, INK, canvas, finish, heading, legend_below
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest, stands
from momentum_lab.experiments.measured import com_moved, motion_done, pelvis_turn, times
from momentum_lab.experiments.sticks import SIDE, snapshot
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

HELD, FREE = "all six", "l and k_z"
CONTROLLERS = ("computed-torque", "resolved-momentum")
_MM = 1e3
_PITCH = 1


def run_of(controller: str, asked: str) -> str:
    """The label of a run."""
    return f"{controller}, {asked}"


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The same kick, twice with the chapter's own way and twice with Kajita's."""
    scenario = chosen("kick", robot)
    return {
        run_of(controller, asked): changed(scenario, controller=controller, controlled=text)
        for controller in CONTROLLERS
        for asked, text in ((HELD, "all"), (FREE, "linear+kz"))
    }


def claims(runs: Runs) -> list[Claim]:
    """The kick is done in all runs; only where k_x and k_y are held too does the body bend for it."""
    found = [stands(name, session) for name, session in runs.items()]
    for name, session in runs.items():
        found.append(at_least(f"{name}: the leg kicks", float(motion_done(session).max()), 0.8, "of its way"))
        found.append(at_most(f"{name}: the CoM moves", _MM * largest(com_moved(session)), 20.0, "mm"))
    for controller in CONTROLLERS:
        held, free = (runs[run_of(controller, asked)] for asked in (HELD, FREE))
        spin = _spin(held) / _spin(free)
        found.append(at_most(f"{controller}: k_y held, to this part of the free one", spin, 0.5, "of it"))
        bend = largest(pelvis_turn(held)[:, _PITCH]) / largest(pelvis_turn(free)[:, _PITCH])
        found.append(at_least(f"{controller}: held, the body bends more", bend, 1.5, "times"))
    return found


def _spin(session: Session) -> float:
    return largest(session.recording.column("momentum")[:, 4])


def table(runs: Runs) -> Columns:
    """Kick, bend and angular momentum of all runs."""
    columns: dict[str, Any] = {"time [s]": times(next(iter(runs.values())))}
    for name, session in runs.items():
        columns[f"{name}: kick [1]"] = motion_done(session)[:, 0]
        columns[f"{name}: pelvis pitch [rad]"] = pelvis_turn(session)[:, _PITCH]
        columns[f"{name}: k_y [N m s]"] = session.recording.column("momentum")[:, 4]
    return columns


def draw(runs: Runs) -> Any:
    """The moment of the kick, held and free; below, what the body does and what it has."""
    first = next(iter(runs.values()))
    picture, axes = canvas(heading("A kick: which momenta are held", first), 2, 2, (12.0, 10.0))
    for place, asked in enumerate((HELD, FREE)):
        session = runs[run_of(CONTROLLERS[0], asked)]
        tick = int(np.argmax(motion_done(session)[:, 0]))
        snapshot(axes[0, place], session, tick, SIDE, f"{asked} held, {times(session)[tick]:.2f} s")
    legend_below(picture, axes[0, 0])
    for name, session in runs.items():
        color = COP if name.endswith(HELD) else FORCE
        dash = "-" if name.startswith(CONTROLLERS[0]) else "--"
        pitch, spin = pelvis_turn(session)[:, _PITCH], session.recording.column("momentum")[:, 4]
        axes[1, 0].plot(times(session), pitch, dash, color=color, label=name)
        axes[1, 1].plot(times(session), spin, dash, color=color, label=name)
    for panel in axes[1]:
        panel.axhline(0.0, color=INK, lw=0.5)
    finish(axes[1, 0], "the body bends where all are held", "time [s]", "pitch of the pelvis [rad]")
    finish(axes[1, 1], "and has angular momentum where not", "time [s]", "$k_y$ [N m s]")
    return picture


FIGURE = Figure("kick", "A kick, and which momenta are held", scenarios, draw, table, claims)
