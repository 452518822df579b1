"""What the status says, word for word."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.active_bounds import Active
from momentum_lab.fall import Fall
from momentum_lab.status import Status, status_of
from tests.app.conftest import changed_sample, sample_at
from tests.conftest import yaw_rotation
from tests.runs import PUSH_END, PUSH_START, forward_push, played


@pytest.fixture(scope="session")
def session(talos):
    return played(talos, forward_push(talos))


@pytest.fixture
def standing(session):
    return sample_at(session, PUSH_START - 0.05)


@pytest.fixture
def at_border(session):
    return sample_at(session, PUSH_END + 0.02)


def desired_beyond(sample, layout, towards) -> object:
    """The sample with a desired CoP 3 cm beyond the granted one, and 88 N m of angular rate lost for it."""
    rate = sample["momentum_rate_admissible"].copy()
    rate[4] += 88.0
    cop = sample["cop_admissible"] + 0.03 * np.asarray(towards)
    return changed_sample(sample, layout, momentum_rate_desired=rate, cop_desired=cop)


def test_standing(standing, talos):
    assert status_of(standing, talos) == Status("standing", "standing", "green")


def test_the_angular_goal_gives_way_on_the_toes(at_border, talos):
    lost = (at_border["momentum_rate_desired"] - at_border["momentum_rate_admissible"])[3:]
    status = status_of(at_border, talos)
    assert status.words == f"CoP on the toes: angular goal gives way by {np.linalg.norm(lost):.0f} N m"
    assert (status.kind, status.color) == ("border", "orange")
    assert np.linalg.norm(lost) > 20.0


def test_the_linear_goal_gives_way_with_the_other_priority(talos):
    session = played(talos, forward_push(talos, seconds=0.4, priority=1.0))
    assert status_of(sample_at(session, PUSH_END + 0.02), talos).words.startswith(
        "CoP on the toes: linear goal gives way by "
    )


def test_both_goals_give_way_in_between(talos):
    session = played(talos, forward_push(talos, seconds=0.4, priority=0.5))
    words = status_of(sample_at(session, PUSH_END + 0.02), talos).words
    assert " N and angular goal gives way by " in words


@pytest.mark.parametrize(
    ("towards", "where"),
    [
        ((1, 0), "CoP on the toes"),
        ((-1, 0), "CoP on the heels"),
        ((0, 1), "CoP on the left border"),
        ((0, -1), "CoP on the right border"),
    ],
)
def test_which_border(standing, session, talos, towards, where):
    sample = desired_beyond(standing, session.recording.layout, towards)
    assert status_of(sample, talos).words == f"{where}: angular goal gives way by 88 N m"


def test_the_border_is_seen_from_the_robot(standing, session, talos):
    # Turn the feet by 137 degrees: what was forward in the world is now behind the robot.
    turn = yaw_rotation(np.radians(137.0))
    sole = standing["sole_pose"].copy()
    sole[:, 3:] = [0.0, 0.0, np.sin(np.radians(137.0) / 2), np.cos(np.radians(137.0) / 2)]
    sample = desired_beyond(standing, session.recording.layout, (turn @ [1.0, 0.0, 0.0])[:2])
    turned = changed_sample(sample, session.recording.layout, sole_pose=sole)
    assert status_of(turned, talos).words.startswith("CoP on the toes")


def test_a_goal_lost_inside_the_support_is_blamed_on_the_forces(standing, session, talos):
    sample = desired_beyond(standing, session.recording.layout, (0.0, 0.0))
    assert status_of(sample, talos).words == "foot forces at their limit: angular goal gives way by 88 N m"


def test_the_bound_that_stops_the_forces_is_named_where_it_is_known(standing, session, talos):
    sample = desired_beyond(standing, session.recording.layout, (0.0, 0.0))
    held = (Active("right foot", "no load"), Active("left foot", "friction limit"))
    words = status_of(sample, talos, held=held).words
    assert words == "friction limit (left foot): angular goal gives way by 88 N m"


SLIPPERY = Active("right foot", "friction limit")


@pytest.mark.parametrize(
    ("held", "where"),
    [
        ((Active("left foot", "CoP on the toes"), Active("left foot", "friction limit")), "CoP on the toes"),
        (
            (Active("left foot", "CoP on the heel"), Active("right foot", "friction limit")),
            "friction limit (right foot)",
        ),
        ((Active("leg_left_4_joint", "torque limit"),), "torque limit (leg_left_4_joint)"),
        ((), "CoP on the toes"),
    ],
)
def test_a_border_is_blamed_only_if_the_cop_is_there(standing, session, talos, held, where):
    sample = desired_beyond(standing, session.recording.layout, (1.0, 0.0))
    assert status_of(sample, talos, held=held).words.startswith(f"{where}: ")


def test_small_losses_are_not_worth_a_word(standing, session, talos):
    rate = standing["momentum_rate_admissible"] + [3.0, 0.0, 0.0, 0.0, 2.0, 0.0]
    sample = changed_sample(standing, session.recording.layout, momentum_rate_desired=rate)
    assert status_of(sample, talos).words == "standing"


def test_one_foot(standing, session, talos):
    wrench = standing["foot_wrench_measured"].copy()
    wrench[1] = 0.0
    sample = changed_sample(standing, session.recording.layout, foot_wrench_measured=wrench)
    assert status_of(sample, talos).words == "standing on the left foot"


def test_in_the_air_no_bound_is_blamed(at_border, session, talos):
    """What the controller asks for and the ground cannot give is no loss at a border when there is no ground."""
    assert status_of(at_border, talos).kind == "border"
    sample = changed_sample(
        at_border, session.recording.layout, foot_wrench_measured=0.0, momentum_rate_admissible=0.0
    )
    words = "in the air: no ground to push on, angular momentum is kept"
    assert status_of(sample, talos) == Status("lifted", words, "orange")


def test_fallen_outranks_the_border(at_border, talos):
    fall = Fall(1.324, "the CoM sank to 0.53 m")
    assert status_of(at_border, talos, fall) == Status(
        "fallen", "fallen at 1.32 s: the CoM sank to 0.53 m", "vermillion"
    )


def test_solver_trouble_is_told_when_it_concerns_the_sample(standing, session, talos):
    failure = "friction of the right foot"
    assert status_of(standing, talos, failure=failure).words == "standing"
    failed = changed_sample(standing, session.recording.layout, solver_failed=1.0)
    assert status_of(failed, talos, failure=failure) == Status(
        "solver", "solver: friction of the right foot", "vermillion"
    )


def test_a_stopped_simulation_outranks_everything(at_border, talos):
    status = status_of(at_border, talos, Fall(1.0, "x"), "y", "the state is not finite after 2.000 s")
    assert status.words == "stopped: the state is not finite after 2.000 s"
