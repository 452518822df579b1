"""How a scenario begins: on which feet, in which state."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.errors import ScenarioError
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from momentum_lab.terrain import standing_places, start_of


def stance_of(robot: RobotModel, names: tuple[str, ...]) -> tuple[int, ...]:
    """Indices of the feet with these names; of all feet without any.

    Raises:
        ScenarioError: the robot has no such foot.
    """
    for name in names:
        if name not in robot.foot_names:
            raise ScenarioError("stance", name, f"feet among {', '.join(robot.foot_names)}")
    return tuple(i for i, name in enumerate(robot.foot_names) if not names or name in names)


def standing_state(robot: RobotModel, scenario: Scenario, com_outside: float | None = None) -> State:
    """At rest in the standing posture, where the scenario starts and on its ground.

    Args:
        robot: the robot.
        scenario: the scenario.
        com_outside: how far outside the edge of its only stance foot the CoM is, m; None: above its middle.
    """
    places = standing_places(scenario, robot) if scenario.ground else None
    q = standing_posture(robot, scenario.stance or robot.foot_names, com_outside, places).copy()
    start = start_of(scenario)
    q[:3] = start.act(q[:3])
    rotation = start.rotation @ pin.Quaternion(q[3:7]).toRotationMatrix()
    q[3:7] = pin.Quaternion(rotation).normalized().coeffs()
    return State(q, np.zeros(robot.nv))


def starting_state(robot: RobotModel, scenario: Scenario) -> State:
    """The state at the first tick: standing, leaning out or lifted, as the scenario says."""
    state = standing_state(robot, scenario, scenario.com_outside)
    state.q[2] += scenario.drop_height
    return state
