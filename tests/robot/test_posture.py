from __future__ import annotations

import os
import re
import subprocess
import sys

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.errors import RobotError
from momentum_lab.robot import posture
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import LIFT, MARGIN, standing_posture
from momentum_lab.robot.state import Dynamics, State
from tests.conftest import assert_close
from tests.robot.conftest import WriteBiped

STANCES = (("left", "right"), ("left",), ("right",))
GRAVITY = 9.81


@pytest.fixture(params=STANCES, ids="+".join)
def stance(request: pytest.FixtureRequest) -> tuple[str, ...]:
    return request.param


def standing(robot: RobotModel, stance: tuple[str, ...]) -> Dynamics:
    return robot.at(State(standing_posture(robot, stance), np.zeros(robot.nv)))


def sole_centres(robot: RobotModel, dynamics: Dynamics) -> np.ndarray:
    """Middles of the sole rectangles in the world (F, 3)."""
    return np.array(
        [
            position + rotation @ [*(sole.lower + sole.upper) / 2, 0.0]
            for sole, position, rotation in zip(
                robot.soles, dynamics.sole_position, dynamics.sole_rotation, strict=True
            )
        ]
    )


def test_stance_soles_are_flat_on_the_ground_in_their_places(
    any_robot: RobotModel, stance: tuple[str, ...]
) -> None:
    dynamics = standing(any_robot, stance)
    half = any_robot.spec.home.foot_distance / 2
    for i, sole in enumerate(any_robot.soles):
        if sole.name not in stance:
            continue
        side = 1.0 if sole.name == "left" else -1.0
        assert_close(dynamics.sole_position[i], [0.0, side * half, 0.0], 1e-4)
        assert np.linalg.norm(pin.log3(dynamics.sole_rotation[i])) < 1e-3
        corners = sole.corners @ dynamics.sole_rotation[i].T + dynamics.sole_position[i]
        assert_close(corners[:, 2], np.zeros(4), 1e-4)


def test_a_lifted_sole_hangs_beside_the_stance_foot(any_robot: RobotModel, stance: tuple[str, ...]) -> None:
    dynamics = standing(any_robot, stance)
    for i, sole in enumerate(any_robot.soles):
        if sole.name not in stance:
            corners = sole.corners @ dynamics.sole_rotation[i].T + dynamics.sole_position[i]
            assert (corners[:, 2] > 0.8 * LIFT).all()
            assert (corners[:, 2] < 1.2 * LIFT).all()


def test_the_centre_of_mass_is_above_the_middle_of_the_support(
    any_robot: RobotModel, stance: tuple[str, ...]
) -> None:
    dynamics = standing(any_robot, stance)
    stood_on = [name in stance for name in any_robot.foot_names]
    middle = sole_centres(any_robot, dynamics)[stood_on].mean(axis=0)
    assert_close(dynamics.com_in_world[:2], middle[:2], 1e-3)


def test_joints_keep_away_from_their_limits(any_robot: RobotModel, stance: tuple[str, ...]) -> None:
    angles = standing_posture(any_robot, stance)[7:]
    room = np.minimum(angles - any_robot.position_lower, any_robot.position_upper - angles)
    legs = np.concatenate([sole.joints for sole in any_robot.soles])
    assert room[legs].min() > MARGIN - 1e-6
    assert room.min() > 0.04


def test_the_upper_body_is_at_its_home_angles(any_robot: RobotModel, stance: tuple[str, ...]) -> None:
    expected = np.zeros(any_robot.na)
    for pattern, angle in any_robot.spec.home.joints.items():
        expected[any_robot.matching_joints([pattern])] = angle
    upper = any_robot.upper_body
    assert_close(standing_posture(any_robot, stance)[7:][upper], expected[upper], 1e-12)


def test_knees_are_bent_and_the_pelvis_is_level_at_its_home_height(any_robot: RobotModel) -> None:
    q = standing_posture(any_robot)
    knees = [name for name in any_robot.joint_names if re.search("knee|leg_.*_4", name, re.IGNORECASE)]
    assert len(knees) == 2
    for name in knees:
        assert 0.5 < abs(q[7 + any_robot.joint_names.index(name)]) < 1.0
    data = any_robot.model.createData()
    pin.framesForwardKinematics(any_robot.model, data, q)
    pelvis = data.oMf[any_robot.pelvis]
    assert_close(pelvis.translation[2], any_robot.spec.home.base_height, 1e-4)
    up = 1 if any_robot.spec.name == "human" else 2
    assert_close(pelvis.rotation[:, up], [0.0, 0.0, 1.0], 1e-4)


def test_the_pelvis_of_g1_leans_over_the_stance_foot_because_its_ankle_cannot(
    g1: RobotModel, talos: RobotModel
) -> None:
    lean = np.arcsin(standing(g1, ("left",)).pelvis_rotation[2, 1])
    assert -0.2 < lean < -0.05
    ankle = g1.joint_names.index("left_ankle_roll_joint")
    angle = standing_posture(g1, ("left",))[7 + ankle]
    assert_close(angle, g1.position_upper[ankle] - MARGIN, 1e-3)
    assert_close(standing(talos, ("left",)).pelvis_rotation, np.eye(3), 1e-4)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_leaning_robot_has_its_com_outside_the_outer_edge(robot: RobotModel, side: str) -> None:
    """Fig. 9: outside by what was asked for, the sole where it always is."""
    foot = robot.foot_names.index(side)
    dynamics = robot.at(State(standing_posture(robot, (side,), 0.01), np.zeros(robot.nv)))
    upright = standing(robot, (side,))
    outwards = np.sign(dynamics.sole_position[foot, 1])
    corners = robot.soles[foot].corners + dynamics.sole_position[foot]
    edge = (outwards * corners[:, 1]).max()
    assert_close(outwards * dynamics.com_in_world[1], edge + 0.01, 1e-4)
    assert_close(dynamics.sole_position[foot], upright.sole_position[foot], 1e-4)
    assert_close(dynamics.sole_rotation[foot], np.eye(3), 1e-4)
    assert_close(dynamics.com_in_world[0], upright.com_in_world[0], 1e-4)


def test_outside_of_two_feet_is_refused(talos: RobotModel) -> None:
    with pytest.raises(RobotError, match="CoM outside: got left, right; allowed: a single foot"):
        standing_posture(talos, None, 0.01)


def test_standing_needs_no_more_torque_than_the_motors_have(
    any_robot: RobotModel, stance: tuple[str, ...]
) -> None:
    """Statics: the weight is split evenly and acts in the middle of each stance sole."""
    dynamics = standing(any_robot, stance)
    middle = sole_centres(any_robot, dynamics)
    force = np.array([0.0, 0.0, any_robot.mass * GRAVITY / len(stance)])
    torque = dynamics.nonlinear_effects.copy()
    for i, name in enumerate(any_robot.foot_names):
        if name in stance:
            moment = np.cross(middle[i] - dynamics.sole_position[i], force)
            torque -= dynamics.sole_jacobian[i].T @ np.concatenate([force, moment])
    assert_close(torque[:6], np.zeros(6), 0.05)
    assert (np.abs(torque[6:]) / any_robot.effort_limit).max() < (0.6 if len(stance) == 2 else 1.0)


def test_the_same_question_gets_the_same_bits(any_robot: RobotModel, stance: tuple[str, ...]) -> None:
    first = standing_posture(any_robot, stance)
    standing_posture(any_robot, ("right",))
    assert np.array_equal(standing_posture(RobotModel(any_robot.spec), stance), first)


def test_a_posture_is_solved_once_and_its_bits_are_nobodys_to_change(
    talos: RobotModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    fresh, solved = RobotModel(talos.spec), []
    solve = posture._solve

    def counted(*arguments) -> np.ndarray:
        solved.append(arguments)
        return solve(*arguments)

    monkeypatch.setattr(posture, "_solve", counted)
    first = standing_posture(fresh)
    kept = first.copy()
    first[:] = 0.0
    assert np.array_equal(standing_posture(fresh), kept)
    assert len(solved) == 1
    raised = [pin.SE3(np.eye(3), place + (0.0, 0.0, 0.02)) for place in posture.home_places(fresh)]
    assert not np.array_equal(standing_posture(fresh, places=raised), kept)
    assert len(solved) == 2


def test_all_feet_are_the_default(talos: RobotModel) -> None:
    assert np.array_equal(standing_posture(talos), standing_posture(talos, ("left", "right")))


def test_a_robot_without_meshes_stands_and_the_environment_is_left_alone(write_biped: WriteBiped) -> None:
    visual = '<visual><geometry><mesh filename="package://nowhere/none.stl"/></geometry></visual>'
    robot = RobotModel.named(str(write_biped(visual=visual)))
    before = dict(os.environ)
    dynamics = standing(robot, ("left", "right"))
    assert_close(dynamics.com_in_world[:2], [0.02, 0.0], 1e-4)
    assert dict(os.environ) == before


def test_nothing_is_printed_while_a_posture_is_found() -> None:
    code = (
        "from momentum_lab.robot.model import RobotModel\n"
        "from momentum_lab.robot.posture import standing_posture\n"
        "standing_posture(RobotModel.named('talos'))\n"
    )
    run = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, check=True
    )
    assert (run.stdout, run.stderr) == ("", "")


@pytest.mark.parametrize("stance", [(), ("left", "tail")])
def test_feet_that_do_not_exist_are_refused(talos: RobotModel, stance: tuple[str, ...]) -> None:
    with pytest.raises(RobotError, match=r"stance: got .*; allowed: one or more of left, right"):
        standing_posture(talos, stance)


def test_a_home_angle_outside_its_limits_is_named(write_biped: WriteBiped) -> None:
    path = write_biped(spec=(('"*_knee" = 0.7', 'neck = 1.5\n"*_knee" = 0.7'),))
    with pytest.raises(RobotError, match=r"home\.joints of biped: got neck = 1\.5; allowed: -1 to 1 rad"):
        standing_posture(RobotModel.named(str(path)))


def test_feet_too_far_apart_are_out_of_reach_by_so_much(write_biped: WriteBiped) -> None:
    robot = RobotModel.named(str(write_biped(spec=(("foot_distance = 0.2", "foot_distance = 2.5"),))))
    with pytest.raises(
        RobotError,
        match=r"standing posture of biped: got left sole \d+\.\d\d mm from its place; .*allowed: a home",
    ):
        standing_posture(robot)


def test_joints_without_room_are_out_of_reach(write_biped: WriteBiped) -> None:
    narrow = '<limit lower="-0.01" upper="0.01" effort="100" velocity="10"/>'
    wide = '<limit lower="-0.6" upper="0.6" effort="100" velocity="10"/>'
    robot = RobotModel.named(str(write_biped(urdf=((wide, narrow),))))
    with pytest.raises(RobotError, match=r"standing posture of biped: got .*allowed: a home \(foot_distance"):
        standing_posture(robot)
