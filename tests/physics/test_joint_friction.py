"""Friction in the joints: it brakes, it never drives, it is as large as declared, and a tick does not shake it."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.physics.ground import Ground
from momentum_lab.physics.joint_friction import joint_friction
from momentum_lab.physics.mismatch import Mismatch, real_robot
from momentum_lab.physics.simulator import Simulator, Step
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import Dynamics, State
from tests.conftest import assert_close

DT = 1e-3


def flight(robot, part: float, ticks: int) -> list[tuple[Dynamics, Step]]:
    """High above the ground with all joints moving and no torque; states and steps."""
    rubbing = real_robot(robot, Mismatch(joint_friction=part))
    world = Simulator(rubbing, Ground.level(len(robot.soles), 0.7), DT)
    q = standing_posture(robot).copy()
    q[2] += 50.0
    middle = 0.5 * (robot.position_lower + robot.position_upper)
    q[7:] += 0.2 * (middle - q[7:])  # away from the ends of the ranges
    state = State(q, np.append(np.zeros(6), np.random.default_rng(3).uniform(-0.5, 0.5, robot.na)))
    steps = []
    for tick in range(ticks):
        dynamics = rubbing.at(state)
        steps.append((dynamics, world.step(dynamics, np.zeros(robot.na), (), tick * DT)))
        state = steps[-1][1].state
    return steps


@pytest.mark.parametrize("part", [0.005, 0.1])
def test_it_is_minus_d_v_of_the_end_of_the_step(robot, part):
    """tau = -c v+ / max(|v|, 0.01): of the size c where a joint keeps its speed, against its motion always."""
    limit = part * robot.effort_limit
    for dynamics, step in flight(robot, part, 60):
        before, after = dynamics.state.v[6:], step.state.v[6:]
        expected = -limit * after / np.maximum(np.abs(before), 0.01)
        assert_close(step.stop_torque, expected, 1e-9 * robot.effort_limit.max())
        assert (step.stop_torque * after <= 0.0).all()


def test_strong_friction_stops_all_joints_and_shakes_none(robot):
    """In free flight nothing else acts: kinetic energy only falls, to a motion as one rigid body."""
    steps = flight(robot, 0.1, 400)
    energy = [_inner_energy(dynamics) for dynamics, _ in steps]
    assert max(np.diff(energy)) < 1e-6 * energy[0]
    assert np.abs(steps[-1][1].state.v[6:]).max() < 1e-3


def test_a_slow_joint_creeps_under_less_than_its_friction(talos):
    """Half of c moves a joint at half of v0 in the long run: v+ = v + dt (tau - D v+) / H settles at tau / D."""
    dynamics = talos.at(State(standing_posture(talos), np.zeros(talos.nv)))
    friction = 0.02 * talos.effort_limit
    implicit = joint_friction(friction, dynamics, DT)
    assert not implicit.torque.any()
    damping = implicit.added_inertia / DT
    assert_close(0.5 * friction / damping, np.full(talos.na, 0.005), 1e-12)


def _inner_energy(dynamics: Dynamics) -> float:
    """Kinetic energy without that of the CoM's own motion, J."""
    v = dynamics.state.v
    return float(0.5 * (v @ dynamics.mass_matrix @ v - dynamics.momentum[:3] @ dynamics.com_velocity))
