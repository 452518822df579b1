"""Which runs are remembered, and what of them: ten moments of CoM, angular momentum and CoP."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario, changed, load_scenario
from tests.runs import played

FOLDER = Path(__file__).parent
MOMENTS = 10


@dataclass(frozen=True)
class Quantity:
    """One remembered quantity: its column, the part of it, and how far two machines may differ."""

    column: str
    part: slice
    tolerance: float


# Other BLAS kernels and a start 100 m away change these numbers by 1e-9 at most; tuning a gain by one percent
# changes them by more than these tolerances.
QUANTITIES = {
    "com": Quantity("com", slice(0, 3), 2e-6),
    "angular_momentum": Quantity("momentum", slice(3, 6), 1e-4),
    "cop": Quantity("cop_measured", slice(0, 2), 2e-5),
}
SECONDS = {"stand": 1.0, "push-forward": 2.0, "one-leg": 2.0}
CASES = [(scenario, robot) for scenario in SECONDS for robot in ("talos", "g1")]


def golden_path(scenario: str, robot: str) -> Path:
    """Where a run is remembered."""
    return FOLDER / f"{scenario}-{robot}.json"


def measured(scenario: str, robot: RobotModel) -> dict[str, Any]:
    """The quantities of a run as they are now."""
    recording = played(robot, _scenario(scenario, robot)).recording
    rows = np.linspace(0, len(recording) - 1, MOMENTS + 1).astype(int)[1:]
    found: dict[str, Any] = {"time": np.round(recording.column("time")[rows], 6).tolist()}
    for name, quantity in QUANTITIES.items():
        values = recording.column(quantity.column)[rows][:, quantity.part]
        found[name] = np.round(values, 9).tolist()
    return found


def remembered(scenario: str, robot: str) -> dict[str, Any]:
    """The quantities of a run as they were when they were last accepted."""
    return json.loads(golden_path(scenario, robot).read_text())


def _scenario(name: str, robot: RobotModel) -> Scenario:
    return changed(load_scenario(name), robot=robot.spec.name, seconds=SECONDS[name])
