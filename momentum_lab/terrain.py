"""The ground of a scenario: its plates under a robot's feet, where the robot starts and as it faces."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin

from momentum_lab.errors import ScenarioError
from momentum_lab.physics.ground import FootMotion, Ground, Patch
from momentum_lab.physics.plate import Plate
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import home_places
from momentum_lab.scenario import Scenario


def start_of(scenario: Scenario) -> pin.SE3:
    """Where a scenario starts and how it faces; x is forward."""
    turn = pin.utils.rotate("z", math.radians(scenario.heading_deg))
    return pin.SE3(turn, np.array([*scenario.position, 0.0]))


def terrain(scenario: Scenario, robot: RobotModel, stance: tuple[int, ...] = ()) -> Ground:
    """The ground a scenario asks for; feet without a plate stand on the floor.

    Args:
        scenario: the scenario.
        robot: whose feet they are.
        stance: the feet that carry, as indices; empty: all.

    Raises:
        ScenarioError: a plate names a foot that the robot does not have, or that stands on another plate.
        InputError: motions go too far together.
    """
    friction = robot.spec.friction if scenario.friction is None else scenario.friction
    start, plates, places = start_of(scenario), plates_of(scenario, robot), standing_places(scenario, robot)
    under_feet, motions, changes = [], [], []
    for foot, (plate, place) in enumerate(zip(plates, places, strict=True)):
        placed, pivot = start * place, start.act(_middle(plate, robot).translation)
        here = friction if plate.friction is None else plate.friction
        under_feet.append(Patch(here, placed.translation, placed.rotation))
        motions += [FootMotion(foot, motion, pivot) for motion in plate.motions]
        changes += [(foot, change) for change in plate.changes]
    floor = Patch(friction, np.array([0.0, 0.0, min(0.0, *(plate.height for plate in plates))]))
    return Ground(tuple(under_feet), floor, start.rotation, tuple(motions), tuple(changes), stance)


def standing_places(scenario: Scenario, robot: RobotModel) -> list[pin.SE3]:
    """Where each sole is if it stands on its plate, seen from the start of the scenario."""
    placed = []
    for place, plate in zip(home_places(robot), plates_of(scenario, robot), strict=True):
        middle = _middle(plate, robot)
        level = middle.translation - np.array([0.0, 0.0, plate.height])
        placed.append(pin.SE3(middle.rotation, middle.act(place - level)))
    return placed


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
    return [plates.get(name, Plate(feet=(name,))) for name in robot.foot_names]


def _middle(plate: Plate, robot: RobotModel) -> pin.SE3:
    """Middle and axes R_y(pitch) R_x(roll) of a plate, seen from the start."""
    feet = plate.feet or robot.foot_names
    places = home_places(robot)[[name in feet for name in robot.foot_names]]
    pitch = pin.utils.rotate("y", math.radians(plate.pitch_deg))
    roll = pin.utils.rotate("x", math.radians(plate.roll_deg))
    return pin.SE3(pitch @ roll, places.mean(axis=0) + np.array([0.0, 0.0, plate.height]))
