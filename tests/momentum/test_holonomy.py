"""Turning without angular momentum: laws of a geometric phase, on real robots."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.momentum.holonomy import floating_base_rates, floating_path, turn_between
from momentum_lab.robot.state import State
from tests.conftest import assert_close
from tests.control.situations import home, swaying


def loop(robot, size: float, steps: int = 80, phase=lambda u: u) -> np.ndarray:
    """Angles (N, na), rad: legs that scissor and spread once around, wherever the robot has its legs."""
    angles = np.tile(home(robot).state.q[7:], (steps + 1, 1))
    around = 2.0 * np.pi * np.array([phase(u) for u in np.linspace(0.0, 1.0, steps + 1)])
    for pattern, course in (("scissors", np.sin(around)), ("spread", 0.5 * (1.0 - np.cos(around)))):
        for name, reach in robot.spec.motions[pattern].items():
            angles[:, robot.joint_names.index(name)] += size * reach * course
    return angles


def turn(robot, angles: np.ndarray) -> np.ndarray:
    path = floating_path(robot, home(robot).state.q, angles)
    return turn_between(path[0], path[-1])


def test_the_base_rates_leave_no_momentum(robot, rng):
    """By Pinocchio's sum over the links, not by its map."""
    dynamics = swaying(robot, rng)
    rates = rng.standard_normal(robot.na)
    v = np.concatenate([floating_base_rates(dynamics.centroidal_map, rates), rates])
    data = robot.model.createData()
    momentum = pin.computeCentroidalMomentum(robot.model, data, dynamics.state.q, v).vector
    assert_close(momentum, np.zeros(6), 1e-12 * robot.mass)
    assert np.abs(v[:6]).max() > 1e-3


def test_the_com_stays_and_the_joints_go_where_they_are_told(robot):
    angles = loop(robot, 1.0)
    path = floating_path(robot, home(robot).state.q, angles)
    assert_close(path[:, 7:], angles, 1e-12)
    coms = np.array([robot.at(State(q, np.zeros(robot.nv))).com_in_world for q in path])
    assert_close(coms, np.tile(coms[0], (len(coms), 1)), 1e-4)


def test_a_way_back_along_the_same_way_undoes_everything(robot):
    half = loop(robot, 1.0)[:41]
    assert np.linalg.norm(turn(robot, half)) > 0.1
    assert_close(turn(robot, np.concatenate([half, half[-2::-1]])), np.zeros(3), 1e-3)


def test_the_loop_counts_not_how_it_is_timed(robot):
    steady, hurried = (
        turn(robot, loop(robot, 1.0, 160, law)) for law in (lambda u: u, lambda u: u**2 * (3 - 2 * u))
    )
    assert steady[2] > 0.3
    assert_close(hurried, steady, 1e-3)


def test_the_loop_the_other_way_round_turns_back(robot):
    angles = loop(robot, 1.0)
    start = home(robot).state.q
    there = floating_path(robot, start, angles)[-1]
    back = floating_path(robot, there, angles[::-1])[-1]
    assert_close(turn_between(start, back), np.zeros(3), 1e-3)


def test_a_small_loop_turns_by_its_area(robot):
    """Curvature times area: half the size, a quarter of the turn."""
    large, small = turn(robot, loop(robot, 0.1))[2], turn(robot, loop(robot, 0.05))[2]
    assert small == pytest.approx(large / 4.0, rel=0.1)


def test_finer_steps_differ_in_second_order(robot):
    coarse, fine, finest = (turn(robot, loop(robot, 1.0, steps)) for steps in (20, 40, 80))
    assert np.linalg.norm(fine - finest) < np.linalg.norm(coarse - fine) / 3.0
