"""Active bounds against what the solvers' multipliers, the plates and the motors say of the same ticks."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.active_bounds import Active, Situation, bounds_of, held_for, in_words, slacks_of
from momentum_lab.control import slack_qp, whole_body_qp
from momentum_lab.control.controller import SLACKS
from momentum_lab.control.wrench_cone import ROWS
from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample
from momentum_lab.scenario import changed, load_scenario
from momentum_lab.session import Session
from tests.app.conftest import changed_sample, sample_at
from tests.runs import PUSH_END, PUSH_START, forward_push, play, played

TOES = "CoP on the toes"
MODULES = {"slack-qp": slack_qp, "whole-body-qp": whole_body_qp}
# Row of `wrench_cone`: -X f_z - n_y <= 0, the front edge.
_TOES_ROW = 8
# A multiplier larger than this presses; the programs' largest weight is 1.
_PRESSES = 1e-7


def situation(session: Session, time: float = 0.0, scale: float = 1.0) -> Situation:
    choices = session.choices
    gains = {name: getattr(choices.gains, name) for name in choices.gains.__dataclass_fields__}
    return Situation(session.robot, choices.controller, gains, tuple(session.ground.friction(time)), scale)


def active(session: Session, sample: Sample, scale: float = 1.0) -> tuple[Active, ...]:
    return bounds_of(sample, situation(session, sample.number("time"), scale)).active


def samples(session: Session) -> list[Sample]:
    return [Sample.of(session.recording.layout, row) for row in session.recording.rows()]


@pytest.fixture(params=MODULES)
def solved(request, robot, monkeypatch):
    """A push from behind, and for each tick the toes and motors whose multipliers press."""
    pressing: list[set[Active]] = []
    solve = MODULES[request.param].solve

    def watched(problem):
        solution = solve(problem)
        feet = len([label for _, label in problem.labels if label.startswith("force, friction")])
        cones = solution.multipliers.size - robot.na - ROWS * feet
        toes = {f for f in range(feet) if solution.multipliers[cones + ROWS * f + _TOES_ROW] > _PRESSES}
        motors = np.flatnonzero(np.abs(solution.multipliers[-robot.na :]) > _PRESSES)
        found = {Active(f"{robot.foot_names[foot]} foot", TOES) for foot in toes}
        pressing.append(found | {Active(robot.joint_names[j], "torque limit") for j in motors})
        return solution

    monkeypatch.setattr(MODULES[request.param], "solve", watched)
    session = play(robot, forward_push(robot, seconds=0.6, controller=request.param))
    return session, pressing


def test_whatever_presses_in_the_program_is_listed(solved):
    session, pressing = solved
    rows = samples(session)
    assert len(pressing) == len(rows)  # the push lifts no foot
    assert sum(Active("left foot", TOES) in found for found in pressing) > 20
    # The multipliers are those of the state at the start of the tick, and so is the sample.
    for sample, found in zip(rows, pressing, strict=True):
        assert found <= set(active(session, sample)), sample.number("time")


def test_what_is_listed_presses_or_is_about_to(solved):
    session, pressing = solved
    idle = [
        sample
        for sample, found in zip(samples(session), pressing, strict=True)
        if Active("left foot", TOES) in set(active(session, sample)) - found
    ]
    assert len(idle) <= 5  # the last percent of the way


@pytest.mark.parametrize("priority", [0.0, 1.0])
def test_the_toes_of_computed_torque_are_where_the_net_cop_stops(talos, priority):
    session = played(talos, forward_push(talos, seconds=0.6, priority=priority))
    front = talos.soles[0].upper[0] - session.choices.gains.safe_border
    for sample in samples(session)[::5]:
        edge = sample["sole_pose"][:, 0] + front  # the feet point forward, a little apart, and stay flat
        listed = {Active(f"{name} foot", TOES) for name in talos.foot_names} <= set(active(session, sample))
        assert listed == bool(np.abs(sample["cop_admissible"][0] - edge).max() < 1.5e-3)


def test_the_toes_of_the_peer_are_where_its_wrenches_lie(talos):
    """PlaCo tells no multipliers: the moment about the front edge of the sole without its border is what is left."""
    session = play(talos, forward_push(talos, seconds=0.45, controller="placo-wbc"))
    front = talos.soles[0].upper[0] - session.choices.gains.safe_border
    length = (talos.soles[0].upper - talos.soles[0].lower)[0] - 2.0 * session.choices.gains.safe_border
    on_toes = 0
    for sample in samples(session)[::3]:
        for foot, name in enumerate(talos.foot_names):
            place = pin.XYZQUATToSE3(sample["sole_pose"][foot])
            wrench = pin.Force(sample["foot_wrench_admissible"][foot])
            local = pin.SE3(place.rotation, np.zeros(3)).actInv(wrench)
            # About the edge the load turns the foot back by f_z times the CoP's distance from it.
            left = (local.angular[1] + front * local.linear[2]) / local.linear[2]
            listed = Active(f"{name} foot", TOES) in active(session, sample)
            assert listed == (left < 0.005 * length)
            on_toes += listed
    assert on_toes > 10


def test_a_robot_at_rest_is_held_by_nothing(robot):
    session = played(robot, forward_push(robot))
    sample = sample_at(session, PUSH_START - 0.05)
    bounds = bounds_of(sample, situation(session))
    assert bounds.active == ()
    assert all(abs(goal.missing) < 0.01 * max(1.0, abs(goal.asked)) for goal in bounds.goals)


def test_goals_are_what_the_desired_and_the_granted_cop_and_rates_are(talos):
    session = played(talos, forward_push(talos))
    sample = sample_at(session, PUSH_END + 0.02)
    goals = {goal.name: goal for goal in bounds_of(sample, situation(session)).goals}
    ahead, angular = goals["CoP ahead"], goals["angular rate about left"]
    # Eq. 21: a CoP that is not so far ahead, times the force, turns the robot back by so much less.
    force = sample["foot_wrench_admissible"][:, 2].sum()
    assert angular.missing == pytest.approx(-1e-3 * ahead.missing * force, rel=0.02)
    assert (ahead.unit, angular.unit, goals["linear rate, ahead"].unit) == ("mm", "N m", "N")
    assert all(abs(goals[f"linear rate, {axis}"].missing) < 1.0 for axis in ("ahead", "left", "up"))
    assert ahead.asked > ahead.granted + 10.0
    assert abs(goals["CoP left"].missing) < 5.0


def test_one_leg(talos):
    push = Push(velocity_change=0.15, direction_deg=90.0, duration=0.1, start=0.2)
    scenario = changed(load_scenario("one-leg"), pushes=(push,), seconds=0.4)
    rest = play(talos, changed(scenario, seconds=0.1))
    assert active(rest, rest.recording.latest) == (Active("right foot", "no load"),)
    session = play(talos, scenario)
    found = active(session, sample_at(session, 0.32))
    assert Active("left foot", "CoP on the outer edge") in found  # pushed to the left, on the left foot
    middle = (talos.soles[0].lower + talos.soles[0].upper)[1] / 2.0
    half = (talos.soles[0].upper - talos.soles[0].lower)[1] / 2.0
    sample = sample_at(session, 0.32)
    place = pin.XYZQUATToSE3(sample["sole_pose"][0])
    cop = place.actInv(np.append(sample["cop_admissible"], place.translation[2]))[1] - middle
    assert cop == pytest.approx(half - session.choices.gains.safe_border, abs=1e-3)


@pytest.mark.parametrize("controller", ["computed-torque", "whole-body-qp"])
def test_tilted_plates(talos, controller):
    """On slopes the CoP of a foot is where the moment of its wrench has no part in the plate."""
    push = Push(velocity_change=0.3, duration=0.1, start=0.2)
    session = play(
        talos, changed(load_scenario("slopes"), controller=controller, pushes=(push,), seconds=0.5)
    )
    on_toes = 0
    for sample in samples(session)[::5]:
        found = active(session, sample)
        for foot, sole in enumerate(talos.soles):
            place = pin.XYZQUATToSE3(sample["sole_pose"][foot])
            force, moment = sample["foot_wrench_admissible"][foot].reshape(2, 3)
            normal = place.rotation[:, 2]
            assert abs(np.degrees(np.arccos(normal[2])) - 10.0) < 2.0
            cop = np.cross(normal, moment) / (force @ normal)  # Eq. 21 in the plate's own plane
            left = sole.upper[0] - session.choices.gains.safe_border - place.rotation[:, 0] @ cop
            listed = Active(f"{sole.name} foot", TOES) in found
            assert listed == (left < 0.005 * (sole.upper - sole.lower)[0])
            on_toes += listed
    assert on_toes > 5


@pytest.mark.parametrize("controller", ["computed-torque", "whole-body-qp", "resolved-momentum"])
def test_a_foot_on_ice_slides_when_its_sole_moves(g1, controller):
    """Sliding is told from forces, the motion of the sole from poses: they agree."""
    session = play(g1, changed(load_scenario("ice"), controller=controller, seconds=1.0))
    poses = session.recording.column("sole_pose")
    speed = np.linalg.norm(np.diff(poses[:, :, :2], axis=0), axis=2) / session.scenario.timestep
    listed = np.array(
        [Active("left foot", "slides") in active(session, sample) for sample in samples(session)[:-1]]
    )
    moving = speed[:, 0] > 5e-3
    assert moving.sum() > 20
    assert listed[moving].all()
    assert not listed[:400].any()  # before the push, on the floor


def test_motors_that_are_weaker_than_believed(talos):
    scale = 0.4
    scenario = forward_push(talos, seconds=0.5, mismatch=Mismatch(torque_scale=scale))
    session = play(talos, scenario)
    # The ratio is that of the torque that was asked for to what the real motor gives.
    over = session.recording.column("torque_ratio") >= 1.0
    listed = [
        any(bound.what == "torque limit" for bound in active(session, sample, scale))
        for sample in samples(session)
    ]
    assert over.sum() > 5
    assert np.array(listed)[over].all()
    assert not any(
        bound.what == "torque limit"
        for bound in active(session, sample_at(session, PUSH_START - 0.05), scale)
    )


def test_friction_that_a_controller_trusts_in_is_named(talos):
    """A push to be answered with more than the trusted friction: each foot's force leaves its pyramid nowhere."""
    gains = {"friction": 0.05, "linear_damping": 20.0}
    for controller, facets in (("computed-torque", 8), ("whole-body-qp", 4)):
        session = play(talos, forward_push(talos, seconds=0.32, controller=controller, gains=gains))
        sample = sample_at(session, PUSH_END)
        assert Active("left foot", "friction limit") in active(session, sample)
        force = sample["foot_wrench_admissible"][0, :3]
        largest = 0.05 * force[2]
        assert largest * np.cos(np.pi / facets) * 0.985 <= np.linalg.norm(force[:2]) <= largest * 1.001


def test_slacks_by_name_and_size(talos):
    session = played(talos, forward_push(talos, seconds=0.4, controller="slack-qp"))
    sample = sample_at(session, PUSH_END + 0.02)
    named = {name: (size, unit) for name, size, unit in slacks_of(sample)}
    assert named
    for name, (size, unit) in named.items():
        assert size == sample["slack"][SLACKS.index(name)]
        assert unit == ("m/s^2" if name.startswith("com") else "rad/s^2")


def test_a_joint_at_its_stop(talos):
    session = played(talos, forward_push(talos))
    sample = sample_at(session, PUSH_START - 0.05)
    q = sample["q"].copy()
    q[7 + 3] = talos.position_upper[3]
    moved = changed_sample(sample, session.recording.layout, q=q)
    assert active(session, moved) == (Active(talos.joint_names[3], "end of its range"),)


def test_a_robot_that_falls_from_the_air_has_no_cop(talos):
    session = played(talos, forward_push(talos))
    sample = changed_sample(
        sample_at(session, 0.1),
        session.recording.layout,
        foot_wrench_measured=0.0,
        foot_wrench_admissible=0.0,
        cop_desired=np.nan,
    )
    words = in_words(bounds_of(sample, situation(session)).active)
    assert words == "left foot: no load; right foot: no load"


def test_how_long_a_run_was_held(talos):
    session = played(talos, forward_push(talos))
    held = held_for(session)
    each_tick = sum(Active("left foot", TOES) in active(session, sample) for sample in samples(session))
    assert held[Active("left foot", TOES)] == pytest.approx(1e-3 * each_tick, abs=0.02)
    assert list(held.values()) == sorted(held.values(), reverse=True)
