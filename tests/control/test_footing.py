"""Where the feet stand, without a border, and which of them are near the ground."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from momentum_lab.control.footing import Footing
from momentum_lab.momentum.foot_ground import FootGround
from tests.conftest import assert_close
from tests.control.situations import BOTH, home, swaying

BORDER = 0.005


def test_the_safe_polygon_is_the_hull_of_the_safe_soles(robot, rng):
    for stance in (BOTH, (0,)):
        dynamics = swaying(robot, rng, stance)
        points = []
        for foot in stance:
            sole = robot.soles[foot]
            for x in (sole.lower[0] + BORDER, sole.upper[0] - BORDER):
                for y in (sole.lower[1] + BORDER, sole.upper[1] - BORDER):
                    corner = dynamics.sole_position[foot] + dynamics.sole_rotation[foot] @ [x, y, 0.0]
                    points.append(corner[:2])
        hull = ConvexHull(points)
        polygon = Footing(robot).stance_feet(dynamics, stance, BORDER).safe_polygon
        expected = np.array(points)[hull.vertices]
        assert len(polygon) == len(expected)
        start = np.argmin(np.linalg.norm(expected - polygon[0], axis=1))
        assert_close(polygon, np.roll(expected, -start, axis=0), 1e-12)


@pytest.mark.parametrize(("gap", "carrying"), [(-0.001, BOTH), (0.004, BOTH), (0.006, ())])
def test_feet_carry_until_their_soles_are_five_millimetres_above_the_ground(robot, gap, carrying):
    dynamics = home(robot)
    ground = FootGround.level(2, float(dynamics.sole_position[:, 2].min()) - gap)
    assert Footing(robot).on_the_ground(dynamics, BOTH, ground) == carrying


def test_only_the_foot_that_is_meant_to_carry_does(robot):
    dynamics = home(robot)
    ground = FootGround.level(2, float(dynamics.sole_position[:, 2].min()))
    for stance in ((0,), (1,)):
        assert Footing(robot).on_the_ground(dynamics, stance, ground) == stance
