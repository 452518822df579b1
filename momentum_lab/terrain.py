"""The ground of a scenario: its plates under a robot's feet, where the robot starts and as it faces."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin

from momentum_lab.errors import ScenarioError
from momentum_lab.physics.ground import Ground, Patch
from momentum_lab.physics.plate import Plate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import home_places
from momentum_lab.scenario import Scenario

_FLOOR = Plate()


def start_of(scenario: Scenario) -> pin.SE3:
    """Where a scenario starts and how it faces; x is forward."""
    turn = pin.utils.rotate("z", math.radians(scenario.heading_deg))
    return pin.SE3(turn, np.array([*scenario.position, 0.0]))


def terrain(scenario: Scenario, robot: RobotModel) -> Ground:
    """The ground a scenario asks for; feet without a plate stand on the floor.

    The floor under everything else is as low as the lowest plate, so that no plate stands out of a leg.

    Raises:
        ScenarioError: a plate names a foot that the robot does not have, or that stands on another plate.
        InputError: a motion goes too far.
    """
    friction = robot.spec.friction if scenario.friction is None else scenario.friction
    start, plates, places = start_of(scenario), plates_of(scenario, robot), home_places(robot)
    under_feet = tuple(
        Patch(friction if plate.friction is None else plate.friction, placed.translation, placed.rotation)
        for plate, placed in ((plate, start * _placed(plate, robot, places)) for plate in plates)
    )
    feet = range(len(plates))
    floor = Patch(friction, np.array([0.0, 0.0, min(0.0, *map(_lowest, plates))]))
    return Ground(
        under_feet,
        floor,
        start.rotation,
        tuple((foot, motion) for foot in feet for motion in plates[foot].motions),
        tuple((foot, change) for foot in feet for change in plates[foot].changes),
    )


def standing_places(scenario: Scenario, robot: RobotModel) -> list[pin.SE3]:
    """Where each sole is if it stands on its plate, seen from the start of the scenario."""
    places = home_places(robot)
    return [
        pin.SE3(placed.rotation, placed.act(place - _middle(plate, robot, places)))
        for place, plate, placed in (
            (place, plate, _placed(plate, robot, places))
            for place, plate in zip(places, plates_of(scenario, robot), strict=True)
        )
    ]


def plates_of(scenario: Scenario, robot: RobotModel) -> list[Plate]:
    """The plate under each foot, in the robot's order of feet.

    Raises:
        ScenarioError: a plate names a foot that the robot does not have, or that stands on another plate.
    """
    plates: dict[str, Plate] = {}
    for plate in scenario.ground:
        for name in plate.feet or robot.foot_names:
            if name not in robot.foot_names:
                raise ScenarioError("ground.feet", name, f"feet among {', '.join(robot.foot_names)}")
            if name in plates:
                raise ScenarioError("ground.feet", f"{name} twice", "one plate under each foot")
            plates[name] = plate
    return [plates.get(name, _FLOOR) for name in robot.foot_names]


def _placed(plate: Plate, robot: RobotModel, places: np.ndarray) -> pin.SE3:
    """Middle and axes R_y(pitch) R_x(roll) of a plate, seen from the start."""
    pitch = pin.utils.rotate("y", math.radians(plate.pitch_deg))
    roll = pin.utils.rotate("x", math.radians(plate.roll_deg))
    return pin.SE3(pitch @ roll, _middle(plate, robot, places) + np.array([0.0, 0.0, plate.height]))


def _middle(plate: Plate, robot: RobotModel, places: np.ndarray) -> np.ndarray:
    """Mean of the places of a plate's feet on a level floor (3,), m."""
    feet = plate.feet or robot.foot_names
    return np.asarray(places[[name in feet for name in robot.foot_names]].mean(axis=0))


def _lowest(plate: Plate) -> float:
    """How low the middle of a plate ever is, m."""
    return plate.height - sum(abs(motion.amplitude) for motion in plate.motions if motion.axis == "z")
