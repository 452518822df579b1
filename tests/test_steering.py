"""What steers a robot, without a world: torques of one tick, takeovers, and the way back."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from momentum_lab.changing import changing, put_back
from momentum_lab.choices import Choices
from momentum_lab.events import SelectController, SetMotion
from momentum_lab.scenario import Scenario
from momentum_lab.steering import Steering
from tests.conftest import assert_close
from tests.control.situations import BOTH, LEVEL, home, swaying

DT = 0.001


@pytest.fixture
def choices(robot) -> Choices:
    return Choices.of(Scenario("test", robot=robot.spec.name))


@pytest.fixture
def steering(robot, choices) -> Steering:
    steering = Steering(robot, home(robot), BOTH, DT, choices)
    steering.stand_up(home(robot), LEVEL)
    return steering


def test_another_controller_begins_with_the_torques_that_were_applied_and_comes_to_its_own(
    steering, robot, rng, choices
):
    dynamics, applied = swaying(robot, rng), rng.normal(size=robot.na)
    other = choices.after(SelectController("slack-qp"), robot)
    steering.remember(None, applied, np.zeros((2, 6)))
    steering.select(other, dynamics)
    first = steering.output(dynamics, LEVEL, other, DT).torque
    assert_close(first, applied, 1e-9)
    fresh = Steering(robot, home(robot), BOTH, DT, other)
    fresh.stand_up(dynamics, LEVEL)
    own = fresh.output(dynamics, LEVEL, other, DT).torque
    second = steering.output(dynamics, LEVEL, other, DT).torque
    assert_close(second - own, np.exp(-DT / 0.05) * (applied - own), 1e-9)


def test_a_motion_counts_from_its_own_start(steering, robot, choices):
    """Begun later, it asks for the same so much later; ended, it asks for nothing."""
    kick = choices.after(SetMotion("kick"), robot)
    kick = dataclasses.replace(kick, angular_goal="reference")
    steering.move(kick, 0.0)
    early = steering.angular_momentum_asked(0.4)
    assert np.linalg.norm(early) > 0.0
    steering.move(kick, 0.25)
    assert_close(steering.angular_momentum_asked(0.65), early, 1e-12)
    steering.aim(dataclasses.replace(kick, angular_goal="zero"))
    assert not steering.angular_momentum_asked(0.65).any()
    assert steering.motion_reach.any()
    steering.move(choices, 1.0)
    assert not steering.motion_reach.any()


def test_put_back_it_answers_the_same_bits_again(steering, robot, rng, choices):
    """In the middle of a takeover, while the soles feel the ground: all of that is in what changes."""
    felt = dataclasses.replace(choices, ground_sense="felt")
    dynamics, pressed = swaying(robot, rng), np.tile([0.0, 0.0, 300.0, 0.0, 0.0, 0.0], (2, 1))

    def ticks() -> list[bytes]:
        answers = []
        for tick in range(5):
            output = steering.output(dynamics, LEVEL, felt, tick * DT)
            steering.remember(output.memory, output.torque, pressed)
            answers.append(output.torque.tobytes())
        return answers

    ticks()
    steering.take_over()
    steering.output(swaying(robot, rng), LEVEL, felt, 5 * DT)
    before = changing(steering)
    first = ticks()
    put_back(steering, before)
    assert ticks() == first
    assert len(set(first)) == 5


def test_a_fallen_robot_is_damped_and_keeps_its_controllers_memory(steering, robot, rng):
    dynamics, memory = swaying(robot, rng), object()
    steering.remember(memory, np.zeros(robot.na), np.zeros((2, 6)))
    output = steering.limp(dynamics)
    assert output.torque @ dynamics.state.v[6:] < 0.0
    assert output.memory is memory
