"""What the controller must show in closed loop: the chapter's push, the pair, all directions, one leg."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.control.situations import goal, home
from tests.runs import PUSH_END, PUSH_START, forward_push, play, played, settled_after

G = 9.81
# A forward push of 0.1 s at which keeping linear momentum stands and keeping angular momentum falls, N.
PAIR_PUSH = {"talos": 340.0, "g1": 128.0}
# Pushes so small that the CoP stays off the border with the default gains, N.
SMALL_PUSH = {"talos": 60.0, "g1": 20.0}
DIRECTIONS = (0, 45, 90, 135, 180, 225, 270, 315)
MM = 1e-3


def desired_force(session: Session) -> np.ndarray:
    """Net ground reaction force that the desired linear rate needs (N, 3), Eq. 39."""
    return session.recording.column("momentum_rate_desired")[:, :3] + [0.0, 0.0, session.robot.mass * G]


def is_saturated(session: Session) -> np.ndarray:
    """Ticks in which the desired CoP is out of the safe polygon: a tenth of a millimetre of it is given up (N,)."""
    column = session.recording.column
    return np.linalg.norm(column("cop_desired") - column("cop_admissible"), axis=1) > 0.1 * MM


def one_push(robot, seconds=2.5, start=PUSH_START, priority=0.0, stance=(), **push) -> Scenario:
    return Scenario(
        "balance",
        robot=robot.spec.name,
        seconds=seconds,
        priority=priority,
        stance=stance,
        pushes=(Push(start=start, duration=0.1, **push),),
    )


class TestTheChaptersPush:
    """Fig. 8 at the same velocity change: 217 N on TALOS, 80 N on G1, for 0.1 s, from behind."""

    @pytest.fixture
    def session(self, robot) -> Session:
        return played(robot, forward_push(robot))

    def test_it_stands_and_settles_within_three_seconds(self, session):
        assert session.fall is None
        assert session.solver_failures == 0
        assert settled_after(session) < PUSH_END + 2.0
        com = session.recording.column("com")
        assert np.linalg.norm(com[-1] - com[0]) < 5 * MM

    def test_the_cop_rests_on_the_safe_border_for_a_while(self, session):
        """Commanded: on the border of the safe polygon. Measured: ahead of everything that is safe, or nearly."""
        saturated = is_saturated(session)
        assert 0.05 < saturated.sum() * 1e-3 < 0.8
        soles = session.recording.column("sole_pose")[:, :, 0]
        front = soles.max(axis=1) + session.robot.soles[0].upper[0]
        border = front - session.choices.gains.safe_border
        cop = session.recording.column("cop_admissible")[:, 0]
        assert np.abs(cop - border)[saturated].max() < 1 * MM
        times = session.recording.column("time")
        after_push = saturated & (times > PUSH_END + 0.02)
        measured = session.recording.column("cop_measured")[:, 0]
        assert after_push.any()
        assert np.abs(measured - border)[after_push].max() < session.choices.gains.safe_border + 1 * MM

    def test_meanwhile_linear_momentum_is_kept_and_angular_is_not(self, session):
        column, weight = session.recording.column, session.robot.mass * G
        saturated = is_saturated(session)
        error = column("momentum_rate_admissible") - column("momentum_rate_desired")
        assert np.linalg.norm(error[saturated, :3], axis=1).max() < 0.02 * weight
        assert np.abs(error[saturated, 4]).max() > 0.02 * weight
        # What is given up is exactly the way of the CoP times the force (Fig. 7 left).
        way = (column("cop_desired") - column("cop_admissible"))[:, 0]
        given_up = way * desired_force(session)[:, 2]
        assert np.abs(error[:, 4] - given_up)[saturated].max() < 0.01 * weight

    def test_the_body_turns_with_the_push(self, session):
        """(dk_a - dk_d)_y >= 0 all the while, and k_y peaks above zero: forwards, about +y."""
        column = session.recording.column
        saturated = is_saturated(session)
        error = column("momentum_rate_admissible") - column("momentum_rate_desired")
        assert error[saturated, 4].min() >= 0.0
        assert column("momentum")[saturated, 4].max() > 0.0

    def test_after_saturation_both_rates_are_as_desired(self, session):
        """Within half a percent of the weight: small terms of the two programs remain."""
        column = session.recording.column
        calm = ~is_saturated(session) & (column("time") > PUSH_END)
        error = column("momentum_rate_admissible") - column("momentum_rate_desired")
        assert calm.sum() > 1000
        assert np.abs(error[calm]).max() < 5e-3 * session.robot.mass * G


def test_an_unsaturated_com_is_a_spring_and_damper(robot):
    """r'' + G21 r' + G22 r = 0 after a small push, with r'' from the measured forces (Eq. 38 closed by Eq. 2)."""
    force = SMALL_PUSH[robot.spec.name]
    session = played(robot, one_push(robot, seconds=0.9, force=force))
    assert not is_saturated(session).any()
    column, gains = session.recording.column, session.choices.gains
    after = column("time") > PUSH_END + 1e-3
    target = goal(robot, home(robot)).com[0]
    r = column("com")[after, 0] - target
    velocity = column("com_velocity")[after, 0]
    acceleration = column("momentum_rate_measured")[after, 0] / robot.mass
    law = acceleration + gains.linear_damping * velocity + gains.linear_stiffness * r
    assert np.abs(law).max() < 0.02 * np.abs(acceleration).max()


def test_angular_momentum_decays_with_its_gain(robot):
    """Eq. 37 without the pelvis term: k after a small push falls by e in 1 / Gamma_11."""
    push = Push(force=SMALL_PUSH[robot.spec.name], duration=0.1, start=PUSH_START, height=1.2)
    scenario = Scenario(
        "spin",
        robot=robot.spec.name,
        seconds=0.6,
        pushes=(push,),
        gains={"pelvis_stiffness": 0.0, "pelvis_weight": 0.0},
    )
    session = played(robot, scenario)
    column = session.recording.column
    assert not is_saturated(session).any()
    k, rate = column("momentum")[:, 4], column("momentum_rate_measured")[:, 4]
    after = column("time") > PUSH_END + 1e-3
    law = rate + session.choices.gains.angular_damping * k
    assert np.abs(law[after]).max() < 0.03 * np.abs(rate[after]).max()


def test_the_pair(robot):
    """The lesson of the chapter: the same push, kept linear momentum stands, kept angular momentum falls."""
    force = PAIR_PUSH[robot.spec.name]
    stands = play_until_decided(robot, one_push(robot, force=force, priority=0.0))
    falls = play_until_decided(robot, one_push(robot, force=force, priority=1.0))
    assert stands.fall is None
    assert np.linalg.norm(stands.recording.latest["com_velocity"]) < 0.05
    assert falls.fall is not None


def play_until_decided(robot, scenario: Scenario) -> Session:
    """The run, up to a fall."""
    session = Session(scenario, robot=robot)
    for _ in range(round(scenario.seconds / scenario.timestep)):
        session.tick()
        if session.fall is not None:
            break
    return session


def pendulum_bound(robot, degrees: float, duration: float) -> float:
    """Largest impulse that a CoP at the edge can catch, m w d wT / (1 - exp(-wT)), N s."""
    dynamics = home(robot)
    corners = np.concatenate(
        [
            dynamics.sole_position[foot] + sole.corners @ dynamics.sole_rotation[foot].T
            for foot, sole in enumerate(robot.soles)
        ]
    )[:, :2]
    direction = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    edges = ConvexHull(corners).equations
    ahead = edges[:, :2] @ direction
    clearance = -(edges[:, :2] @ dynamics.com_in_world[:2] + edges[:, 2])
    distance = (clearance[ahead > 1e-9] / ahead[ahead > 1e-9]).min()
    omega = math.sqrt(G / dynamics.com_in_world[2])
    return robot.mass * omega * distance * omega * duration / (1.0 - math.exp(-omega * duration))


@pytest.mark.parametrize("degrees", DIRECTIONS)
def test_it_stands_a_push_from_every_side(robot, degrees):
    """At 0.85 of what the CoP alone could catch, along x at 0.95."""
    ratio = 0.95 if degrees in (0, 180) else 0.85
    force = ratio * pendulum_bound(robot, degrees, 0.1) / 0.1
    session = play_until_decided(
        robot, one_push(robot, seconds=2.2, start=0.1, force=force, direction_deg=degrees)
    )
    assert session.fall is None, session.fall
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.1


SINGLE_SUPPORT_PUSH = {"talos": 20.0, "g1": 7.0}


@pytest.mark.parametrize("foot", ["left", "right"])
def test_it_stands_on_one_leg_and_takes_a_small_push(robot, foot):
    """Ten seconds on the left leg, four on the right: still before the push at 1 s, and still at the end."""
    seconds = 10.0 if foot == "left" else 4.0
    force = SINGLE_SUPPORT_PUSH[robot.spec.name]
    session = play(robot, one_push(robot, seconds=seconds, start=1.0, stance=(foot,), force=force))
    assert session.fall is None
    assert session.solver_failures == 0
    column = session.recording.column
    index = robot.foot_names.index(foot)
    lifted = 1 - index
    speed = np.linalg.norm(column("com_velocity"), axis=1)
    assert speed[:1000].max() < 2e-3
    assert speed[-1] < 2e-3
    assert not column("foot_wrench_measured")[:, lifted].any()
    assert column("sole_pose")[:, lifted, 2].min() > 0.02
    drift = np.linalg.norm(column("sole_pose")[:, index, :2] - column("sole_pose")[0, index, :2], axis=1)
    assert drift.max() < 1 * MM
    inside = column("foot_cop_measured")[:, index]
    sole = robot.soles[index]
    assert np.minimum(inside - sole.lower, sole.upper - inside).min() > 0.0
