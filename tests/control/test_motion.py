"""Motions: smooth courses, joints from the robot's file, and the angular momentum that belongs to them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.control.motion import MOTIONS, MovingGoal, reach_of
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import InputError, ScenarioError
from momentum_lab.events import SetAngularGoal, SetMotion
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario, changed
from momentum_lab.session import Session
from tests.conftest import assert_close
from tests.control.situations import BOTH, goal, home

DT = 1e-3
STANCE = {"kick": (0,), "reach": BOTH, "arm-swing": BOTH, "cat-left": BOTH, "cat-right": BOTH}
ON_THE_GROUND = ("kick", "reach", "arm-swing")
# An instant at which all its joints move, s.
MIDWAY = {"kick": 0.675, "reach": 0.8, "arm-swing": 2.0}
IN_THE_AIR = ("cat-left", "cat-right")
COURSES = [(name, table) for name, motion in MOTIONS.items() for table in motion.courses]


def moving(robot, name, angular_goal="zero") -> MovingGoal:
    stance = STANCE[name]
    return MovingGoal(robot, home(robot, stance), stance, name, angular_goal, DT)


@pytest.mark.parametrize(("name", "table"), COURSES)
def test_the_rate_is_the_slope_of_the_way_and_nothing_jumps(name, table):
    """A tick changes the rate by 100 1/s^2 at most on the ground, in the air by 200."""
    course = MOTIONS[name].courses[table]
    times = np.arange(0.0, 6.0, DT)
    way, rate = np.array([course(time) for time in times]).T
    on_the_ground = MOTIONS[name].where == "ground"
    assert_close(rate[1:-1], (way[2:] - way[:-2]) / (2.0 * DT), 5e-4 if on_the_ground else 2e-3)
    assert np.abs(np.diff(rate)).max() < (0.1 if on_the_ground else 0.2)
    assert (way[times <= (0.5 if on_the_ground else 0.02)] == 0.0).all()
    assert way.max() == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize(("name", "table"), COURSES)
def test_in_full_swing_it_repeats_itself(name, table):
    motion = MOTIONS[name]
    course = motion.courses[table]
    for time in np.arange(2.0, 4.0, 0.0137):
        assert_close(np.array(course(time + motion.period)), np.array(course(time)), 1e-9)


@pytest.mark.parametrize("name", ON_THE_GROUND)
def test_only_joints_of_the_robots_file_move(robot, name):
    dynamics = home(robot, STANCE[name])
    still = goal(robot, dynamics, STANCE[name])
    moved = moving(robot, name).applied(still, 0.73)
    way, rate = MOTIONS[name].courses[name](0.73)
    (reach,) = moving(robot, name).reach
    assert_close(moved.posture, still.posture + way * reach, 1e-12)
    assert_close(moved.posture_rate, rate * reach, 1e-12)
    assert_close(moved.angular_momentum, np.zeros(3), 0.0)
    patterns = robot.spec.motions[name]
    assert 0 < np.count_nonzero(reach) <= 2 * len(patterns)
    assert set(np.abs(reach[reach != 0.0])) == {abs(angle) for angle in patterns.values()}
    assert dataclasses.replace(moved, posture=still.posture).com is still.com


def test_the_reaching_hand_goes_forward(robot):
    """By a good part of the arm's length, and its elbow straightens."""
    model, data = robot.model, robot.model.createData()
    hand = model.getFrameId(robot.spec.push_bodies["right_hand"])
    q = home(robot).state.q.copy()
    places = []
    for way in (0.0, 1.0):
        pin.framesForwardKinematics(
            model, data, robot.integrate(q, np.append(np.zeros(6), way * reach_of(robot, "reach")[0]))
        )
        places.append(data.oMf[hand].translation.copy())
    forward, _, up = places[1] - places[0]
    assert forward > 0.2 * robot.at(State(q, np.zeros(robot.nv))).com_in_world[2]
    assert 0.0 < up < forward


@pytest.mark.parametrize("name", IN_THE_AIR)
def test_a_loop_of_the_joints_closes_and_has_an_inside(robot, name):
    """Its rates and accelerations are the slopes of its angles; the area is what turns the body."""
    motion = moving(robot, name)
    still = goal(robot, home(robot), BOTH)
    flown = [motion.applied(still, time).in_the_air for time in np.arange(0.0, 0.76, DT)]
    angle, rate = np.array([at.angle for at in flown]), np.array([at.rate for at in flown])
    acceleration = np.array([at.acceleration for at in flown])
    assert_close(rate[1:-1], (angle[2:] - angle[:-2]) / (2.0 * DT), 2e-3)
    assert_close(acceleration[1:-1], (rate[2:] - rate[:-2]) / (2.0 * DT), 2.0)
    assert_close(angle[-1], still.posture, 1e-12)
    assert (angle > robot.position_lower).all()
    assert (angle < robot.position_upper).all()
    ways = np.array(
        [[course(time)[0] for course in MOTIONS[name].courses.values()] for time in np.arange(0.0, 0.76, DT)]
    )
    area = 0.5 * np.sum(ways[:-1, 0] * ways[1:, 1] - ways[1:, 0] * ways[:-1, 1])
    assert abs(area) == pytest.approx(np.pi / 2.0, rel=1e-3)
    assert (area > 0.0) == (name == "cat-left")


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_in_the_air_every_controller_goes_the_loop_and_nothing_has_failed(robot, controller):
    flight = Scenario("m", robot=robot.spec.name, controller=controller, motion="cat-right", drop_height=3.0)
    session = Session(flight, robot)
    for _ in range(750):
        session.tick()
    joints = session.recording.column("q")[:, 7:]
    reach = np.abs(session.steering.motion_reach)
    assert_close(np.abs(joints - joints[0]).max(axis=0)[reach > 0.0], reach[reach > 0.0], 0.01)
    assert_close(joints[-1], joints[0], 5e-3)
    assert session.solver_failures == 0


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_a_motion_for_the_air_does_nothing_on_the_ground(robot, controller):
    still, asked = (
        Session(Scenario("m", robot=robot.spec.name, controller=controller, motion=motion), robot)
        for motion in ("", "cat-left")
    )
    for _ in range(300):
        still.tick(), asked.tick()
    assert (asked.state.q == still.state.q).all()


@pytest.mark.parametrize("name", ON_THE_GROUND)
def test_the_reference_goal_is_the_motions_own_momentum(robot, name):
    """k_d by Pinocchio's map at the same joint rates, when the body may go along as kinematics wants it."""
    zero, reference = moving(robot, name), moving(robot, name, "reference")
    assert_close(zero.angular_momentum(1.234), np.zeros(3), 0.0)
    assert_close(reference.angular_momentum(0.4), np.zeros(3), 1e-9)
    found = np.array([reference.angular_momentum(time) for time in np.arange(0.5, 2.4, 0.01)])
    assert np.abs(found).max() > 0.2
    period = MOTIONS[name].period
    assert_close(reference.angular_momentum(40.0), reference.angular_momentum(40.0 + period), 1e-12)
    # With everything but the joints of the motion held, k would be A_G v; the body gives way to it a little.
    dynamics = home(robot, STANCE[name])
    v = np.concatenate([np.zeros(6), MOTIONS[name].courses[name](MIDWAY[name])[1] * zero.reach[0]])
    alone = robot.at(State(dynamics.state.q, v)).momentum[3:]
    assert reference.angular_momentum(MIDWAY[name]) @ alone > 0.0


@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize(
    ("name", "stance", "ticks"), [("kick", ("left",), 1200), ("reach", (), 1950), ("arm-swing", (), 1800)]
)
def test_every_controller_follows_smoothly(robot, controller, name, stance, ticks):
    """The joints get there, the robot stands, and no torque jumps by a tenth of its limit."""
    session = Session(
        Scenario("m", robot=robot.spec.name, controller=controller, motion=name, stance=stance, seconds=2.0),
        robot,
    )
    for _ in range(ticks):
        session.tick()
    joints = np.flatnonzero(session.steering.motion_reach)
    angles = session.recording.column("q")[:, 7 + joints]
    way = (angles - angles[0]) / session.steering.motion_reach[joints]
    assert way.max() > 0.6
    assert session.fall is None
    assert session.solver_failures == 0
    jumps = np.abs(np.diff(session.recording.column("torque"), axis=0)) / robot.effort_limit
    assert jumps[5:].max() < 0.1


def test_a_motion_begins_and_ends_in_mid_run_without_a_jump(robot):
    """From its own start, whenever it is asked for; and the robot is back in its posture after it."""
    session = Session(Scenario("m", robot=robot.spec.name, seconds=4.0), robot)
    for tick in range(3800):
        if tick in (300, 2100):
            session.post(SetMotion("arm-swing" if tick == 300 else ""))
        if tick == 900:
            session.post(SetAngularGoal("reference"))
        session.tick()
    posture = session.recording.column("q")[:, 7:]
    moved = np.abs(posture - posture[0]).max(axis=1)
    assert moved[:800].max() < 5e-3
    assert moved[800:2100].max() > 0.3
    assert moved[-1] < 0.02
    jumps = np.abs(np.diff(session.recording.column("torque"), axis=0)) / robot.effort_limit
    assert jumps[5:].max() < 0.1
    assert session.choices.motion == ""
    with pytest.raises(InputError, match=r"^motion: got dance"):
        session.post(SetMotion("dance"))


def test_what_cannot_be_done_is_said(talos):
    with pytest.raises(
        InputError, match=r"^motion: got dance; allowed: one of kick, reach, arm-swing, cat-left, cat-right$"
    ):
        Session(Scenario("m", motion="dance"), talos)
    with pytest.raises(
        InputError, match=r"^motion: got kick; allowed: a motion that the file of romeo describes"
    ):
        Session(Scenario("m", robot="romeo", motion="kick"))
    with pytest.raises(ScenarioError, match=r"^angular_goal: got big; allowed: one of zero, reference$"):
        changed(Scenario("m"), angular_goal="big")
