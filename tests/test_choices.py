"""What is chosen, as a value: each event changes one thing and refuses what cannot be."""

from __future__ import annotations

import dataclasses

import pytest

from momentum_lab.choices import Choices
from momentum_lab.control.planner import OWN
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    Reset,
    SelectController,
    SelectPlanner,
    SetAngularGoal,
    SetDirections,
    SetFriction,
    SetGain,
    SetGains,
    SetGroundSense,
    SetMismatch,
    SetMotion,
    SetPriority,
)
from momentum_lab.momentum.directions import directions
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario

FIRST = Choices.of(Scenario("first"))
CHANGES = {
    "gains": SetGain("linear_damping", 5.0),
    "priority": SetPriority(0.3),
    "controlled": SetDirections("linear+kz"),
    "planner": SelectPlanner("cop-to-com"),
    "motion": SetMotion("kick"),
    "angular_goal": SetAngularGoal("reference"),
    "ground_sense": SetGroundSense("felt"),
    "mismatch": SetMismatch("mass_error", 0.1),
}


def changed_fields(before: Choices, after: Choices) -> set[str]:
    names = (field.name for field in dataclasses.fields(Choices))
    return {name for name in names if getattr(before, name) != getattr(after, name)}


@pytest.mark.parametrize("name", CHANGES)
def test_an_event_changes_its_own_choice_and_no_other(name, talos):
    assert changed_fields(FIRST, FIRST.after(CHANGES[name], talos)) == {name}


def test_every_choice_but_the_controller_has_its_event():
    assert {field.name for field in dataclasses.fields(Choices)} == {"controller", *CHANGES}


def test_what_is_asked_for_is_what_is_chosen(talos):
    after = FIRST.after_all(CHANGES.values(), talos)
    assert (after.priority, after.planner, after.motion) == (0.3, "cop-to-com", "kick")
    assert after.controlled == directions("linear+kz")
    assert (after.gains.linear_damping, after.mismatch.mass_error) == (5.0, 0.1)


def test_another_controller_brings_its_own_gains_and_keeps_a_planner_it_knows(talos):
    planned = FIRST.after_all([SetGain("linear_damping", 5.0), SelectPlanner("cop-to-com")], talos)
    for name, entry in CONTROLLERS.items():
        other = planned.after(SelectController(name), talos)
        assert (other.controller, other.gains) == (name, entry.gains)
        assert other.planner == ("cop-to-com" if "cop-to-com" in entry.planners else OWN)
        assert changed_fields(planned, other) <= {"controller", "gains", "planner"}


def test_later_events_are_checked_against_what_earlier_ones_chose(talos):
    later = SetGain("lqr_share", 1.0)
    with pytest.raises(InputError):
        FIRST.after(later, talos)
    assert FIRST.after_all([SelectController("whole-body-qp"), later], talos).gains.lqr_share == 1.0


@pytest.mark.parametrize("event", [ApplyPush(Push(force=10.0)), SetFriction(0.2), Reset()])
def test_pushes_and_the_ground_are_no_choices(event, talos):
    assert FIRST.after(event, talos) is FIRST


@pytest.mark.parametrize(
    "event",
    [
        SetGain("nothing", 1.0),
        SetGains({"linear_damping": -1.0}),
        SetPriority(float("nan")),
        SetPriority(1.1),
        SetDirections("up"),
        SelectPlanner("nobody"),
        SelectController("nobody"),
        SetMotion("moonwalk"),
        SetMismatch("mass_error", 9.0),
    ],
)
def test_what_cannot_be_is_refused(event, talos):
    with pytest.raises(InputError, match="allowed"):
        FIRST.after(event, talos)
