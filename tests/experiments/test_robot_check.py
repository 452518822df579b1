from __future__ import annotations

import pytest

from momentum_lab.experiments.robot_check import DIRECTIONS, trials
from momentum_lab.robot.catalog import load_spec
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.proposal import propose
from momentum_lab.robot.urdf import robot_data_folder
from tests.robot.proposal.test_proposal import FRAMES


def to_the_end(_fraction: float) -> bool:
    return True


@pytest.mark.parametrize("name", ["romeo", "icub", "human"])
def test_a_robot_as_it_is_proposed_stands_after_a_push_in_each_direction(name: str) -> None:
    """0.7 of what a pendulum survives: nothing but standing well is asked for."""
    spec = propose(robot_data_folder() / load_spec(name).urdf, FRAMES[name]).spec
    check_that_all_stand(RobotModel(spec))


def test_the_simple_humanoid_stands_with_the_limits_of_its_file() -> None:
    """What its URDF alone does not let it do; the pushes act on the pelvis, as its file says."""
    check_that_all_stand(RobotModel.named("simple_humanoid"))


def check_that_all_stand(robot: RobotModel) -> None:
    done = trials(robot, to_the_end)
    assert [trial.direction for trial in done] == ["none", *DIRECTIONS]
    for trial in done:
        assert trial.settled, trial
        # The pendulum of the check and that of the run's summary are written down twice.
        assert trial.impulse_ratio == pytest.approx(0.7 if trial.force else 0.0, abs=0.002)


def test_a_robot_that_falls_on_its_own_is_not_pushed_and_its_weak_motor_is_named() -> None:
    """The waist of the simple humanoid holds its torso only when it leans back; a motor of 30 N m is to blame."""
    name = "simple_humanoid"
    spec = propose(robot_data_folder() / load_spec(name).urdf, FRAMES[name]).spec
    (alone,) = trials(RobotModel(spec), to_the_end)
    assert not alone.stands
    assert alone.saturated[0] == "WAIST_P"
    assert "motors at their limit: WAIST_P, " in alone.why
