"""The controller believes in one robot, the world has another: what each is given, what is recorded, who stands."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, Reset, SetMismatch
from momentum_lab.physics.mismatch import EXACT, Mismatch
from momentum_lab.physics.push import Push
from momentum_lab.physics.sensors import measured
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session
from momentum_lab.timeline import Timeline
from tests.conftest import assert_close
from tests.runs import forward_push, played, settled_after

ALL_WRONG = Mismatch(0.1, 0.01, 2.0, 1e-4, 1e-3, 0.8)
G = 9.81


class Spy:
    """A controller that remembers what it was given and what it answered."""

    def __init__(self, inner) -> None:
        self.inner, self.given, self.asked = inner, [], []
        self.initial_memory = inner.initial_memory

    def compute(self, dynamics, *rest):
        output = self.inner.compute(dynamics, *rest)
        self.given.append(dynamics)
        self.asked.append(output.torque)
        return output


def spied(robot, mismatch: Mismatch, ticks: int = 0, **changes) -> tuple[Session, Spy]:
    scenario = Scenario("test", robot=robot.spec.name, seed=11, mismatch=mismatch, **changes)
    session = Session(scenario, robot)
    session.steering._controller = spy = Spy(session.steering._controller)
    for _ in range(ticks):
        session.tick()
    return session, spy


def bits(session: Session) -> bytes:
    return session.recording.rows().tobytes()


# What each is given


def test_without_errors_controller_and_world_share_one_dynamics(talos):
    session, spy = spied(talos, EXACT)
    seen = []
    session._simulator.step = _watched(session._simulator.step, seen)
    for _ in range(3):
        session.tick()
    assert all(one is other for one, other in zip(spy.given, seen, strict=True))


def test_the_controller_sees_the_measured_state_of_the_robot_it_believes_in(robot):
    session, spy = spied(robot, ALL_WRONG, 5)
    column = session.recording.column
    for tick, dynamics in enumerate(spy.given):
        true = State(column("q")[tick], column("v")[tick])
        assert_close(dynamics.state.q, measured(robot, true, ALL_WRONG, 11, tick).q, 1e-12)
        assert not np.array_equal(dynamics.state.q, true.q)
        believed = robot.at(dynamics.state)
        assert_close(dynamics.mass_matrix, believed.mass_matrix, 1e-12)


def test_the_recording_is_of_the_robot_that_is_there(robot):
    """h of a robot ten per cent heavier, Eq. 20 with it, ground forces that carry it."""
    session, _ = spied(robot, ALL_WRONG, 1500, pushes=(Push(velocity_change=0.1, start=0.2),))
    column, weight = session.recording.column, 1.1 * robot.mass * G
    believed = robot.at(State(column("q")[300], column("v")[300]))
    assert_close(column("momentum")[300], 1.1 * believed.momentum, 1e-9)
    assert np.abs(column("momentum")[300]).max() > 0.5
    assert column("equation_residual").max() < 1e-9
    carried = column("foot_wrench_measured")[500:, :, 2].sum(axis=1).mean()
    assert carried == pytest.approx(weight, rel=5e-3)


def test_late_motors_give_what_was_asked_two_ticks_ago(talos):
    session, spy = spied(talos, Mismatch(torque_delay_ms=2.0), 40)
    given, limit = session.recording.column("torque"), talos.effort_limit
    asked = np.clip(spy.asked, -limit, limit)
    assert np.array_equal(given[2:], asked[:-2])
    assert np.array_equal(given[:2], asked[[0, 0]])


@pytest.mark.parametrize("scale", [0.3, 1.0])
def test_no_motor_gives_more_than_its_real_limit_and_the_demand_is_recorded(talos, scale):
    push = Push(force=400.0, start=0.0)
    session, spy = spied(talos, Mismatch(torque_scale=scale), 250, pushes=(push,))
    column, real = session.recording.column, scale * talos.effort_limit
    assert (np.abs(column("torque")) <= real).all()
    demand = (np.abs(spy.asked) / real).max(axis=1)
    assert_close(column("torque_ratio")[: len(demand)], demand, 1e-12)
    assert demand.max() > 1.0 or scale == 1.0


# Events and the way back


def test_an_error_can_come_and_go_in_mid_run(talos):
    session, _ = spied(talos, EXACT, 20)
    session.post(SetMismatch("mass_error", 0.2))
    momentum = session.tick()["momentum"]
    assert session.choices.mismatch == Mismatch(mass_error=0.2)
    assert session.dynamics.mass_matrix[0, 0] == pytest.approx(1.2 * talos.mass)
    assert np.isfinite(momentum).all()
    session.post(SetMismatch("mass_error", 0.0))
    session.tick()
    assert session.choices.mismatch == EXACT
    assert session.dynamics.mass_matrix[0, 0] == pytest.approx(talos.mass)


def test_an_error_out_of_range_is_refused_before_it_acts(talos):
    session, _ = spied(talos, EXACT, 1)
    with pytest.raises(InputError, match=r"^mismatch mass_error: got 2\.0; allowed: a number from -0\.3 to"):
        session.post(SetMismatch("mass_error", 2.0))
    session.tick()
    assert session.choices.mismatch == EXACT


def test_standing_up_again_keeps_the_errors_and_repeats_the_noise(g1):
    session, _ = spied(g1, ALL_WRONG, 60)
    before = bits(session)
    session.post(Reset())
    for _ in range(60):
        session.tick()
    assert bits(session) == before


def test_seed_and_errors_decide_every_bit(talos):
    one, same = (spied(talos, ALL_WRONG, 60)[0] for _ in range(2))
    assert bits(one) == bits(same)
    other = Session(changed(one.scenario, seed=12), talos)
    for _ in range(60):
        other.tick()
    assert bits(other) != bits(one)


def test_a_way_back_through_errors_repeats_the_run_bit_for_bit(robot):
    """To instants at which torques wait in line, and across a change of robot, delay and noise."""
    events = {
        15: ApplyPush(Push(velocity_change=0.15)),
        71: SetMismatch("mass_error", -0.1),
        72: SetMismatch("torque_delay_ms", 5.0),
        95: SetMismatch("encoder_noise", 0.0),
    }
    session = Session(Scenario("test", robot=robot.spec.name, mismatch=ALL_WRONG), robot, 400)
    timeline = Timeline(session)

    def run(until: int) -> None:
        while session.ticks < until:
            if session.ticks in events:
                session.post(events[session.ticks])
            timeline.note()
            session.tick()

    run(150)
    before = bits(session)
    for back in (83, 73, 47):
        timeline.go_back(session.ticks - back)
        assert session.ticks == back
        run(150)
        assert bits(session) == before


def test_a_scenario_carries_its_errors(tmp_path):
    path = tmp_path / "heavy.toml"
    path.write_text('name = "heavy"\n[mismatch]\nmass_error = 0.1\ntorque_delay_ms = 2\n')
    scenario = load_scenario(str(path))
    assert scenario.mismatch == Mismatch(mass_error=0.1, torque_delay_ms=2.0)
    assert msgspec.json.decode(msgspec.json.encode(scenario), type=Scenario) == scenario
    assert msgspec.json.decode(b'{"name": "x"}', type=Scenario).mismatch == EXACT


# The other engine


def test_mujoco_has_the_heavier_robot_too(talos):
    """What the feet carry is 1.1 m g and what the CoM gains, and Eq. 20 holds with the heavier robot."""
    session, _ = spied(talos, Mismatch(mass_error=0.1, torque_delay_ms=1.0), 800, engine="mujoco")
    column = session.recording.column
    carried = column("foot_wrench_measured")[:-1, :, 2].sum(axis=1).mean()
    gained = (column("momentum")[-1, 2] - column("momentum")[0, 2]) / 0.799
    assert carried - gained == pytest.approx(1.1 * talos.mass * G, rel=1e-3)
    assert column("equation_residual").max() < 1e-6
    assert session.fall is None


def test_mujoco_refuses_friction_of_joints_before_it_acts(talos):
    said = r"^mismatch joint_friction: got 0\.05; allowed: 0 with the engine mujoco$"
    with pytest.raises(InputError, match=said):
        spied(talos, Mismatch(joint_friction=0.05), engine="mujoco")
    session, _ = spied(talos, EXACT, engine="mujoco")
    with pytest.raises(InputError, match=said):
        session.post(SetMismatch("joint_friction", 0.05))


# Who stands


@pytest.mark.parametrize("error", [0.1, -0.1])
def test_the_chapters_push_is_survived_with_a_wrong_mass_late_motors_and_noise(robot, error):
    """217 N on TALOS, 80 N on G1, 0.1 s from behind, with the default gains; the rest is a sag and a tremble.

    Nothing in Eq. 38 carries weight that is not in the model: m k dz = e m g, so the CoM settles at most e g / k
    lower, 61 mm, or as much higher; posture and pelvis hold against it.
    """
    wrong = Mismatch(mass_error=error, torque_delay_ms=2.0, encoder_noise=1e-4, imu_noise=1e-3)
    session = played(robot, forward_push(robot, mismatch=wrong))
    column = session.recording.column
    assert session.fall is None
    assert session.solver_failures == 0
    assert settled_after(session) < 2.2
    com = column("com")
    drop = com[0, 2] - com[-200:, 2].mean()
    assert 0.02 < np.sign(error) * drop < 0.1 * G / 16.0
    assert np.abs(com[-200:, 0].mean() - com[0, 0]) < 0.01
    assert column("equation_residual").max() < 1e-9
    assert (np.abs(column("torque")) <= robot.effort_limit).all()


def _watched(step, seen: list):
    def watch(dynamics, *rest):
        seen.append(dynamics)
        return step(dynamics, *rest)

    return watch
