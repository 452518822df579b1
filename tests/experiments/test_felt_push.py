"""What a push does at the feet: from the equations of motion, and on the robot whose joints pass most of it on."""

from __future__ import annotations

import dataclasses

import numpy as np

from momentum_lab.experiments import fig8
from momentum_lab.experiments.felt_push import cop_with_the_push, passed_on
from momentum_lab.experiments.measured import foot_cops, push_end, push_start, times
from momentum_lab.experiments.play import play
from momentum_lab.scenario import changed
from tests.conftest import assert_close
from tests.control.situations import swaying
from tests.experiments.played import always, played


def test_the_feet_stay_where_they_are_and_the_rest_gives_way(robot, rng):
    dynamics = swaying(robot, rng)
    generalized = 50.0 * rng.standard_normal(robot.nv)
    felt = passed_on(dynamics, generalized)
    jacobian = dynamics.sole_jacobian.reshape(-1, robot.nv)
    acceleration = np.linalg.solve(dynamics.mass_matrix, generalized + jacobian.T @ felt.ravel())
    assert_close(jacobian @ acceleration, np.zeros(12), 1e-8)
    assert np.abs(acceleration).max() > 0.1


def test_joints_without_give_would_pass_everything_on(robot, rng):
    """A force that no joint can give way to ends in the soles: net force and moment are those of the push."""
    dynamics = swaying(robot, rng)
    rigid = dynamics.mass_matrix + np.diag(np.repeat([0.0, 1e9], [6, robot.na]))
    push = np.array([30.0, -20.0, 10.0, 3.0, 2.0, 1.0])
    felt = passed_on(dataclasses.replace(dynamics, mass_matrix=rigid), dynamics.pelvis_jacobian.T @ push)
    assert_close(felt[:, :3].sum(axis=0), -push[:3], 1e-3)


def test_a_push_that_no_foot_feels_would_be_noticed():
    """iCub's heavy rotors pass on what moves the CoP by 9 mm: without it the claim is wrong by that much."""
    session = played("fig8", "icub").runs["push"]
    moved = cop_with_the_push(session)
    clock = times(session)
    off = np.abs(moved - foot_cops(session, "foot_wrench_admissible")[:, :, 0])
    assert np.nanmax(off) > 8e-3
    during = (clock > push_start(session) - 1e-9) & (clock < push_end(session) - 1e-9)
    assert np.isnan(moved[~during]).all()
    assert np.isfinite(moved[during]).all(axis=1).sum() > 50


def test_without_a_push_there_is_nothing_to_compare():
    run = changed(fig8.scenarios("g1")["push"], pushes=(), seconds=0.05)
    assert np.isnan(cop_with_the_push(play({"push": run}, always).runs["push"])).all()
