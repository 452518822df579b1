"""PlaCo's kinematics solver against the null space route of Eq. 26."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.control.placo_rates import MomentumGoal, PlacoRates
from momentum_lab.errors import SolverError
from momentum_lab.momentum.directions import ALL, directions
from momentum_lab.momentum.resolved import resolved_rates
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import BOTH, home, swaying

DT = 1e-3


def poses(dynamics, stance) -> np.ndarray:
    """Sole frames in the world (S, 4, 4)."""
    frames = np.tile(np.eye(4), (len(stance), 1, 1))
    frames[:, :3, :3] = dynamics.sole_rotation[list(stance)]
    frames[:, :3, 3] = dynamics.sole_position[list(stance)]
    return frames


def some_goal(robot, rng, controlled=ALL) -> MomentumGoal:
    return MomentumGoal(
        momentum=np.concatenate([rng.normal(scale=3.0, size=3), rng.normal(scale=0.5, size=3)]),
        controlled=controlled,
        reference=np.concatenate([rng.normal(scale=0.05, size=6), rng.normal(scale=0.2, size=robot.na)]),
    )


@pytest.mark.parametrize("stance", [BOTH, (0,)])
@pytest.mark.parametrize("text", ["all", "linear+kz", "lx+ky", "angular", "linear"])
def test_placo_agrees_with_the_null_space_route(robot, rng, stance, text):
    """Feet to 1e-9; momentum and rates as far as a reference of weight 1e-5 next to the momentum lets them.

    That is weight / s^2 of the way from the reference, s the smallest singular value of S A_G N: with the
    least 1.5 of the G1 near its home some 1e-5 of a few rad/s, and as much again for the finite step dt.
    """
    controlled = directions(text)
    rows = np.array(controlled)
    solver = PlacoRates(robot, stance, DT)
    for _ in range(5):
        dynamics = robot.at(State(swaying(robot, rng, stance).state.q, np.zeros(robot.nv)))
        goal = some_goal(robot, rng, controlled)
        rates = solver.solve(dynamics.state.q, poses(dynamics, stance), goal)
        feet = dynamics.sole_jacobian[list(stance)].reshape(-1, robot.nv)
        expected = resolved_rates(
            feet, np.zeros(len(feet)), dynamics.centroidal_map, goal.momentum, goal.reference, controlled
        )
        assert_close(feet @ rates, np.zeros(len(feet)), 1e-9)
        assert_close((dynamics.centroidal_map @ rates - goal.momentum)[rows], 0.0, 3e-4)
        assert_close(rates, expected, 1e-3)


def test_feet_go_to_their_footholds_in_one_step(robot, rng):
    dynamics = home(robot)
    footholds = poses(dynamics, BOTH)
    footholds[:, :3, 3] += rng.normal(scale=1e-4, size=(2, 3))
    rates = PlacoRates(robot, BOTH, DT).solve(dynamics.state.q, footholds, some_goal(robot, rng))
    moved = robot.at(State(robot.integrate(dynamics.state.q, rates * DT), np.zeros(robot.nv)))
    assert_close(moved.sole_position, footholds[:, :3, 3], 1e-6)


def test_joints_stay_within_their_limits(robot, rng):
    """A reference beyond a limit covers dt / T = 1 / 50 of what is left of the way to it."""
    dynamics = home(robot)
    goal = some_goal(robot, rng, directions("lx"))
    joint = int(robot.upper_body[-1])
    q = dynamics.state.q.copy()
    q[7 + joint] = robot.position_upper[joint] - 1e-4
    goal.reference[6 + joint] = 2.0
    rates = PlacoRates(robot, BOTH, DT).solve(q, poses(dynamics, BOTH), goal)
    left = robot.position_upper[joint] - q[7 + joint] - DT * rates[6 + joint]
    assert left == pytest.approx(0.98 * 1e-4, abs=1e-9)


def test_feet_out_of_reach_are_an_error_in_words(talos, rng):
    dynamics = home(talos)
    footholds = poses(dynamics, BOTH)
    footholds[0, 0, 3] += 0.5
    with pytest.raises(SolverError, match="PlaCo finds no joint rates"):
        PlacoRates(talos, BOTH, DT).solve(dynamics.state.q, footholds, some_goal(talos, rng))


def test_the_answer_is_a_function_of_the_question(robot, rng):
    """After other questions, and from another instance: the same bits."""
    first, second = PlacoRates(robot, BOTH, DT), PlacoRates(robot, BOTH, DT)
    dynamics, goal = swaying(robot, rng), some_goal(robot, rng)
    question = (dynamics.state.q, poses(dynamics, BOTH), goal)
    answer = first.solve(*question)
    other = swaying(robot, rng)
    first.solve(other.state.q, poses(other, BOTH), some_goal(robot, rng, directions("lx+kz")))
    assert first.solve(*question).tobytes() == answer.tobytes()
    assert second.solve(*question).tobytes() == answer.tobytes()


def test_a_joint_arrives_at_its_limit_without_a_blow(robot):
    """Rates that would run into a limit within a fraction of a second shrink with the distance to it."""
    dynamics, joint = home(robot), int(robot.upper_body[0])
    q, rates, footholds = dynamics.state.q.copy(), PlacoRates(robot, BOTH, DT), poses(dynamics, BOTH)
    q[7 + joint] = robot.position_upper[joint] - 0.8
    wish, speeds = np.zeros(robot.nv), []
    wish[6 + joint] = 3.0
    for _ in range(600):
        v = rates.solve(q, footholds, MomentumGoal(np.zeros(6), directions("none"), wish))
        speeds.append(v[6 + joint])
        assert v[6 + joint] <= (robot.position_upper[joint] - q[7 + joint]) / 0.05 + 1e-6
        q = robot.integrate(q, v * DT)
    assert max(speeds) > 1.0
    assert np.abs(np.diff(speeds)).max() < 0.1
    assert 0.0 <= robot.position_upper[joint] - q[7 + joint] < 0.02
