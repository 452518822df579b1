"""Accept the present runs as the ones to remember: python -m tests.golden.update."""

from __future__ import annotations

import json

import numpy as np

from momentum_lab.robot.model import RobotModel
from tests.golden.cases import CASES, QUANTITIES, golden_path, measured, remembered


def main() -> None:
    robots = {name: RobotModel.named(name) for _, name in CASES}
    for scenario, name in CASES:
        now = measured(scenario, robots[name])
        path = golden_path(scenario, name)
        change = "new"
        if path.is_file():
            before = remembered(scenario, name)
            change = ", ".join(
                f"{key} {np.abs(np.subtract(now[key], before[key])).max():.2g}" for key in QUANTITIES
            )
        lines = [f'  "{key}": {json.dumps(values)}' for key, values in now.items()]
        path.write_text("{\n" + ",\n".join(lines) + "\n}\n")
        print(f"{path.name}: {change}")


if __name__ == "__main__":
    main()
