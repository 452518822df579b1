"""What events do to the ground and to the pushes."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from momentum_lab.effects import feet_named, ground_after, pushed_after
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, ApplyPushes, MoveGround, SetFriction, SetPriority, StopGround
from momentum_lab.physics.held_push import Pushed
from momentum_lab.physics.plate import PlateMotion
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.terrain import terrain

NOW = 1.5
SWAY = PlateMotion(axis="x", amplitude=0.05, period=2.0)


@pytest.fixture
def ground(talos):
    return terrain(Scenario("s"), talos)


def test_a_push_begins_now_whatever_its_own_start(talos):
    (push,) = pushed_after(Pushed(()), ApplyPush(Push(force=10.0, start=7.0)), talos, NOW).all
    assert (push.start, push.force) == (NOW, 10.0)


def test_pushes_of_a_sequence_keep_their_distances_and_follow_the_earlier_ones(talos):
    earlier = Pushed((Push(force=1.0, start=0.2),))
    after = pushed_after(
        earlier, ApplyPushes((Push(force=2.0, start=0.0), Push(force=3.0, start=0.5))), talos, NOW
    )
    assert [(push.force, push.start) for push in after.all] == [(1.0, 0.2), (2.0, NOW), (3.0, NOW + 0.5)]


def test_a_velocity_change_becomes_a_force_for_this_robot(talos):
    (push,) = pushed_after(Pushed(()), ApplyPush(Push(velocity_change=0.2, duration=0.1)), talos, NOW).all
    assert push.force == pytest.approx(0.2 * talos.mass / 0.1)


def test_only_the_named_foot_becomes_slippery_and_only_from_now_on(talos, ground):
    name = talos.foot_names[1]
    after = ground_after(ground, SetFriction(0.1, name), talos, NOW)
    assert after.friction(NOW)[1] == 0.1
    assert after.friction(NOW)[0] == ground.friction(NOW)[0] != 0.1
    assert np.array_equal(after.friction(NOW - 1e-3), ground.friction(NOW - 1e-3))


def test_a_plate_moves_from_now_on_and_comes_to_rest_when_told(talos, ground):
    moving = ground_after(ground, MoveGround(SWAY), talos, NOW)
    assert not moving.at(NOW - 0.1).velocity.any()
    assert moving.at(NOW + 2.0).velocity.any()
    stopped = ground_after(moving, StopGround(), talos, NOW + 2.0)
    assert not stopped.at(NOW + 2.0 + SWAY.period + 0.01).velocity.any()


def test_events_about_something_else_change_nothing(talos, ground):
    assert ground_after(ground, SetPriority(0.5), talos, NOW) is ground
    assert pushed_after(Pushed(()), SetPriority(0.5), talos, NOW) == Pushed(())


def test_feet_by_name(talos):
    assert feet_named("", talos) == (0, 1)
    assert [feet_named(name, talos) for name in talos.foot_names] == [(0,), (1,)]
    with pytest.raises(InputError, match=f"foot: got tail; allowed: one of {', '.join(talos.foot_names)}"):
        feet_named("tail", talos)


@pytest.mark.parametrize(
    "event",
    [SetFriction(-1.0), SetFriction(0.5, "tail"), MoveGround(SWAY, "tail")],
    ids=lambda event: repr(event)[:30],
)
def test_a_ground_that_cannot_be_is_refused(event, talos, ground):
    with pytest.raises(InputError, match="allowed"):
        ground_after(ground, event, talos, NOW)


def test_a_push_on_no_body_of_the_robot_is_refused(talos):
    with pytest.raises(InputError, match="body: got tail"):
        pushed_after(Pushed(()), ApplyPush(msgspec.structs.replace(Push(force=1.0), body="tail")), talos, NOW)
