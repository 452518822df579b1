"""Arms that swing: with no angular momentum allowed, and with that of the motion itself (section 5.3.2)."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import CMP, COP, FORCE, canvas, finish, heading
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest, stands
from momentum_lab.experiments.measured import com_moved, motion_done, pelvis_turn, times
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session

ZERO, REFERENCE = "zero", "reference"
_MM = 1e3
_COLORS = {ZERO: COP, REFERENCE: CMP}


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """The same swing with both angular goals."""
    scenario = chosen("arm-swing", robot)
    return {ZERO: scenario, REFERENCE: changed(scenario, angular_goal=REFERENCE)}


def turned(session: Session) -> np.ndarray:
    """How far the pelvis is turned (n,), rad."""
    return np.asarray(np.linalg.norm(pelvis_turn(session), axis=1))


def spin(session: Session) -> np.ndarray:
    """|k| (n,), N m s."""
    return np.asarray(np.linalg.norm(session.recording.column("momentum")[:, 3:], axis=1))


def unmet(session: Session) -> np.ndarray:
    """What k has more than is asked for (n, 3), N m s."""
    asked = np.array([session.steering.angular_momentum_asked(time) for time in times(session)])
    return np.asarray(session.recording.column("momentum")[:, 3:] - asked)


def claims(runs: Runs) -> list[Claim]:
    """Both swing; with a zero goal the body turns against the arms, with the motion's own it need not so much."""
    zero, reference = runs[ZERO], runs[REFERENCE]
    found = [stands(f"with the goal {name} the robot", session) for name, session in runs.items()]
    for name, session in runs.items():
        done = float(motion_done(session).max(axis=0).min())
        found.append(at_least(f"{name}: every arm goes", done, 0.8, "of its way"))
        found.append(at_most(f"{name}: the CoM moves", _MM * largest(com_moved(session)), 2.0, "mm"))
    kept = largest(spin(zero)) / largest(spin(reference))
    found.append(at_most("zero: angular momentum, to this part of the other", kept, 0.35, "of it"))
    calm = largest(turned(reference)) / largest(turned(zero))
    found.append(at_most("reference: the pelvis turns, to this part of the other", calm, 0.5, "of it"))
    missed = largest(unmet(reference)) / largest(spin(reference))
    found.append(at_most("reference: angular momentum is not as asked by", missed, 0.3, "of it"))
    return found


def table(runs: Runs) -> Columns:
    """Arms, pelvis and angular momentum of both runs."""
    columns: dict[str, Any] = {"time [s]": times(runs[ZERO])}
    for name, session in runs.items():
        columns[f"{name}: way of the first arm [1]"] = motion_done(session)[:, 0]
        columns[f"{name}: pelvis turned [rad]"] = turned(session)
        columns[f"{name}: |k| [N m s]"] = spin(session)
    return columns


def draw(runs: Runs) -> Any:
    """Arms, angular momentum and pelvis over time."""
    picture, axes = canvas(heading("Arms that swing, and two angular goals", runs[ZERO]), 3, 1, (9.0, 9.0))
    for name, session in runs.items():
        color, clock = _COLORS[name], times(session)
        axes[0, 0].plot(clock, motion_done(session)[:, 0], color=color, label=f"goal: {name}")
        axes[1, 0].plot(clock, spin(session), color=color, label=f"goal: {name}")
        axes[2, 0].plot(clock, turned(session), color=color, label=f"goal: {name}")
    session = runs[REFERENCE]
    asked = [np.linalg.norm(session.steering.angular_momentum_asked(time)) for time in times(session)]
    axes[1, 0].plot(times(session), asked, ":", color=FORCE, label="asked for by reference")
    finish(axes[0, 0], "the first arm", "time [s]", "way [1]")
    finish(axes[1, 0], "angular momentum about the CoM", "time [s]", "|k| [N m s]")
    finish(axes[2, 0], "the pelvis turns against the arms", "time [s]", "turned [rad]")
    return picture


FIGURE = Figure(
    "arm-swing", "Should angular momentum be zero? Arms that swing", scenarios, draw, table, claims
)
