"""A limp robot falls, lies on the ground and stays there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.physics.ground import Ground
from momentum_lab.physics.simulator import Simulator
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.state import State

DT = 1e-3
FALLING = 1.0
LYING = 5.0


@dataclass(frozen=True)
class Fall:
    """What happened, tick by tick: energies (J), penetrations and joint excess (m, rad), normal forces (N)."""

    energy: np.ndarray
    penetration: np.ndarray
    excess: np.ndarray
    normal_force: np.ndarray
    weight: float
    end: State


def fall(robot, damping: float, seconds: float) -> Fall:
    """From the standing posture, a little forward, with joint torques -damping * limit * rate only."""
    state = State(standing_posture(robot), np.zeros(robot.nv))
    state.v[0] = 0.3
    world, data = Simulator(robot, Ground.level(2, robot.spec.friction), DT), robot.model.createData()
    energy, penetration, excess, normal = [], [], [], []
    for tick in range(round(seconds / DT)):
        dynamics = robot.at(state)
        kinetic = 0.5 * state.v @ dynamics.mass_matrix @ state.v
        energy.append(kinetic + robot.mass * 9.81 * dynamics.com_in_world[2])
        penetration.append(-lowest_point(robot, data, state.q))
        angle = state.q[7:]
        excess.append(np.abs(angle - np.clip(angle, robot.position_lower, robot.position_upper)).max())
        step = world.step(dynamics, -damping * robot.effort_limit * state.v[6:], (), tick * DT)
        normal.append(step.foot_wrench[:, 2].sum() + step.other_wrench[2])
        state = step.state
    return Fall(*map(np.array, (energy, penetration, excess, normal)), robot.mass * 9.81, state)


def lowest_point(robot, data, q: np.ndarray) -> float:
    """Height of the lowest of all points that may hit the ground, m."""
    pin.framesForwardKinematics(robot.model, data, q)
    points = [(robot.frame(link), p) for link, ps in robot.spec.fall_points.items() for p in ps]
    points += [(sole.frame, corner) for sole in robot.soles for corner in sole.corners]
    return min(data.oMf[frame].act(np.array(point))[2] for frame, point in points)


@pytest.fixture(scope="module")
def damped(robot) -> Fall:
    """Joints with friction, as the lab leaves a robot that has fallen."""
    return fall(robot, damping=1.0 / 6.0, seconds=FALLING + LYING)


@pytest.fixture(scope="module")
def loose(robot) -> Fall:
    """Joints without any friction."""
    return fall(robot, damping=0.0, seconds=FALLING)


def test_it_ends_on_the_ground_with_finite_numbers(robot, damped):
    assert damped.end.is_finite()
    assert (
        robot.at(damped.end).com_in_world[2]
        < 0.4 * robot.at(State(standing_posture(robot), np.zeros(robot.nv))).com_in_world[2]
    )


def test_nothing_sinks_into_the_ground(damped, loose):
    assert max(damped.penetration.max(), loose.penetration.max()) < 5e-3


def test_energy_does_not_grow(damped, loose):
    """Falling gives it to joints and ground; a frictionless chain of joints may not end above where it began."""
    assert np.diff(damped.energy).max() < 1e-6 * damped.energy[0]
    assert loose.energy.max() < 1.001 * loose.energy[0]


def test_the_ground_never_pulls_and_carries_the_weight_in_the_end(damped):
    assert damped.normal_force.min() > -1e-3
    assert np.mean(damped.normal_force[-1000:]) == pytest.approx(damped.weight, rel=0.02)


def test_joint_limits_hold(damped, loose):
    """A few degrees at the hardest blow, when the whole robot falls on a bent knee; less than two at rest."""
    assert damped.excess.max() < 0.05
    assert loose.excess.max() < 0.1
    assert damped.excess[-1000:].max() < 0.03
