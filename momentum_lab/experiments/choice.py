"""The scenario of a figure for a robot."""

from __future__ import annotations

from momentum_lab.scenario import Scenario, changed, load_scenario, scenario_names


def chosen(name: str, robot: str | None) -> Scenario:
    """The scenario of that name for a robot; None: for the one it names.

    Where robots need different sizes of the same experiment, `NAME-ROBOT` holds that robot's.

    Raises:
        ScenarioError: its file cannot be read.
    """
    own = f"{name}-{robot}"
    if own in scenario_names():
        return load_scenario(own)
    scenario = load_scenario(name)
    return scenario if robot is None else changed(scenario, robot=robot)
