"""Every number of the summary against a derivation from the recorded columns alone."""

from __future__ import annotations

import json
import math
from types import SimpleNamespace

import msgspec
import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.events import ApplyPush, SetGain, SetPriority
from momentum_lab.headless import Timing, run_headless
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.summary import Summary, summarize
from tests.runs import CHAPTER_PUSH, PUSH_END, PUSH_START, forward_push, played

GRAVITY = 9.81
SECONDS = 0.8
TIMING = Timing(tick_time=np.linspace(1e-4, 1e-3, 101), wall_time=0.5)
# Edges of the physical soles in the sole frame, as the robots' files document them, m.
FRONT = {"talos": 0.091, "g1": 0.12}
REAR = {"talos": -0.100, "g1": -0.05}
HALF_WIDTH = {"talos": 0.060, "g1": 0.025}


def summary_of(session: Session) -> Summary:
    return summarize(session, TIMING)


def column(session: Session, name: str) -> np.ndarray:
    return session.recording.column(name)


@pytest.fixture(scope="module")
def forward(robot: RobotModel) -> Session:
    return played(robot, forward_push(robot, SECONDS))


@pytest.fixture(scope="module")
def fallen(talos: RobotModel) -> Session:
    """A push that nobody survives without a step."""
    push = Push(force=600.0, start=0.05)
    return played(talos, Scenario("fall", seconds=1.3, pushes=(push,)))


@pytest.fixture(scope="module")
def sideways(talos: RobotModel) -> Session:
    """Two pushes, the later and weaker one to the left."""
    pushes = (
        Push(force=100.0, start=0.1),
        Push(force=80.0, start=0.3, direction_deg=90.0, shape="half-sine"),
    )
    return played(talos, Scenario("sideways", seconds=0.6, pushes=pushes))


def test_names_are_those_of_the_run(forward: Session, robot: RobotModel) -> None:
    summary = summary_of(forward)
    assert (summary.robot, summary.controller) == (robot.spec.name, "computed-torque")
    assert (summary.scenario, summary.engine, summary.seed) == ("forward", "pinocchio", 0)
    assert summary.seconds == pytest.approx(SECONDS, abs=1e-12)


def test_impulse_is_the_integral_of_the_recorded_force(
    forward: Session, sideways: Session, robot: RobotModel
) -> None:
    for session in (forward, sideways):
        force = np.linalg.norm(column(session, "push_wrench")[:, :3], axis=1)
        assert summary_of(session).impulse == pytest.approx(1e-3 * force.sum(), abs=1e-9)
    assert summary_of(forward).impulse == pytest.approx(0.1 * CHAPTER_PUSH[robot.spec.name], abs=1e-9)


def test_impulse_ratio_is_over_the_pendulum_bound(forward: Session, robot: RobotModel) -> None:
    """J / (m w d w T / (1 - exp(-w T))) with d to the toes, from the row at which the push starts."""
    row = round(PUSH_START / 1e-3)
    toes = column(forward, "sole_pose")[row, :, 0] + FRONT[robot.spec.name]
    com = column(forward, "com")[row]
    omega = math.sqrt(GRAVITY / com[2])
    duration = PUSH_END - PUSH_START
    bound = robot.mass * omega * (toes.min() - com[0]) * omega * duration / (1 - math.exp(-omega * duration))
    assert summary_of(forward).impulse_ratio == pytest.approx(
        0.1 * CHAPTER_PUSH[robot.spec.name] / bound, rel=1e-4
    )


def test_impulse_ratio_is_that_of_the_largest_push(sideways: Session, talos: RobotModel) -> None:
    ratios = []
    com, soles = column(sideways, "com"), column(sideways, "sole_pose")
    for row, impulse, axis, edge in (
        (100, 10.0, 0, FRONT["talos"]),
        (300, 80.0 * 0.1 * 2 / math.pi, 1, 0.06),
    ):
        distance = soles[row, :, axis].max() + edge - com[row, axis]
        omega = math.sqrt(GRAVITY / com[row, 2])
        ratios.append(impulse * (1 - math.exp(-0.1 * omega)) / (talos.mass * omega**2 * distance * 0.1))
    assert ratios[0] > ratios[1] > 0.05
    assert summary_of(sideways).impulse_ratio == pytest.approx(ratios[0], rel=1e-3)


def test_impulse_ratio_sees_which_way_the_push_goes(talos: RobotModel) -> None:
    """The same push backwards and on one foot: the edge is the heel, or the side of the one sole."""
    for stance, direction, axis, edge in (((), 180.0, 0, REAR["talos"]), (("left",), 90.0, 1, 0.06)):
        push = Push(force=50.0, start=0.0, duration=0.01, direction_deg=direction)
        session = played(talos, Scenario("short", stance=stance, seconds=0.02, pushes=(push,)))
        com, sole = column(session, "com")[0], column(session, "sole_pose")[0, 0]
        distance = abs(sole[axis] + edge - com[axis])
        omega = math.sqrt(GRAVITY / com[2])
        bound = talos.mass * omega**2 * distance * 0.01 / (1 - math.exp(-omega * 0.01))
        assert summary_of(session).impulse_ratio == pytest.approx(0.5 / bound, rel=1e-4)


def test_impulse_ratio_measures_from_where_the_com_has_gone_and_along_the_push(talos: RobotModel) -> None:
    """A second push meets a CoM that the first has brought nearer to the toes than to the heels."""
    pushes = (Push(force=100.0, start=0.0), Push(force=200.0, start=0.2))
    session = played(talos, Scenario("twice", seconds=0.31, pushes=pushes))
    com, sole = column(session, "com")[200], column(session, "sole_pose")[200, 0]
    ahead, behind = sole[0] + FRONT["talos"] - com[0], com[0] - sole[0] - REAR["talos"]
    assert behind > 1.1 * ahead
    omega = math.sqrt(GRAVITY / com[2])
    bound = talos.mass * omega**2 * ahead * 0.1 / (1 - math.exp(-omega * 0.1))
    assert summary_of(session).impulse_ratio == pytest.approx(20.0 / bound, rel=1e-3)


def test_without_a_push_there_is_no_impulse(talos: RobotModel) -> None:
    late = Push(force=100.0, start=5.0)
    for pushes in ((), (late,)):
        summary = summary_of(played(talos, Scenario("quiet", seconds=0.02, pushes=pushes)))
        assert (summary.impulse, summary.impulse_ratio) == (0.0, 0.0)


def test_push_of_an_event_counts_and_one_cut_short_counts_as_far_as_it_went(talos: RobotModel) -> None:
    session = Session(Scenario("cut", seconds=0.05), talos)
    session.post(ApplyPush(Push(force=60.0, duration=1.0)))
    run_headless(session)
    summary = summary_of(session)
    assert summary.impulse == pytest.approx(60.0 * 0.05, abs=1e-9)
    push = Push(force=60.0, duration=0.05, start=0.0)
    whole = summary_of(played(talos, Scenario("cut", seconds=0.05, pushes=(push,))))
    assert summary.impulse_ratio == pytest.approx(whole.impulse_ratio, rel=1e-12)


def test_excursion_and_angular_momentum_are_the_largest(forward: Session, fallen: Session) -> None:
    for session in (forward, fallen):
        com, momentum = column(session, "com"), column(session, "momentum")
        summary = summary_of(session)
        far = max(math.hypot(x - com[0, 0], y - com[0, 1]) for x, y, _ in com)
        assert summary.peak_com_excursion == pytest.approx(far, rel=1e-12)
        assert summary.peak_angular_momentum == pytest.approx(
            math.sqrt((momentum[:, 3:] ** 2).sum(1).max()), rel=1e-12
        )


def test_cop_margin_is_the_distance_to_the_nearest_edge(forward: Session, robot: RobotModel) -> None:
    """Both feet level and side by side: the support polygon is a rectangle."""
    name = robot.spec.name
    cop, soles = column(forward, "cop_measured"), column(forward, "sole_pose")
    assert (column(forward, "foot_wrench_measured")[..., 2] > 1.0).all()
    edges = [
        soles[:, :, 0].min(1) + FRONT[name] - cop[:, 0],
        cop[:, 0] - soles[:, :, 0].max(1) - REAR[name],
        soles[:, :, 1].max(1) + HALF_WIDTH[name] - cop[:, 1],
        cop[:, 1] - soles[:, :, 1].min(1) + HALF_WIDTH[name],
    ]
    assert summary_of(forward).min_cop_margin == pytest.approx(np.min(edges), abs=1e-4)


def test_cop_margin_on_one_foot_is_that_of_one_sole(talos: RobotModel) -> None:
    session = played(talos, Scenario("leg", stance=("left",), seconds=0.02))
    cop = column(session, "foot_cop_measured")[:, 0]
    assert (column(session, "foot_wrench_measured")[:, 1] == 0.0).all()
    edges = np.abs(cop[:, :, None] - [[REAR["talos"], FRONT["talos"]], [-0.06, 0.06]])
    assert summary_of(session).min_cop_margin == pytest.approx(edges.min(), abs=1e-6)


def test_fall_is_told_with_its_time_and_reason(fallen: Session) -> None:
    summary = summary_of(fallen)
    assert summary.fell is True
    assert summary.settled is False
    touched = np.abs(column(fallen, "other_contact_wrench")).max(1) > 0.0
    low = column(fallen, "com")[:, 2] < 0.6 * column(fallen, "com")[0, 2]
    first = int(np.argmax(touched | low))
    assert summary.fall_time == pytest.approx(column(fallen, "time")[first], abs=1e-12)
    assert summary.fall_reason


def test_cop_after_the_fall_does_not_count(fallen: Session) -> None:
    """Lying on its side a robot has a CoP far outside its soles."""
    summary = summary_of(fallen)
    soles = column(fallen, "sole_pose")[..., :2].mean(1)
    away = np.linalg.norm(column(fallen, "cop_measured") - soles, axis=1)
    late = column(fallen, "time") > summary.fall_time
    assert np.nanmax(away[late]) > 0.3
    assert summary.min_cop_margin is not None
    assert summary.min_cop_margin > -0.05


def test_settled_is_slow_at_the_end(talos: RobotModel, forward: Session) -> None:
    speed = np.linalg.norm(column(forward, "com_velocity")[-1])
    assert summary_of(forward).settled == (speed < 0.02)
    still = played(talos, Scenario("still", seconds=0.02))
    moving = played(talos, Scenario("moving", seconds=0.06, pushes=(Push(force=300.0, start=0.0),)))
    assert np.linalg.norm(column(moving, "com_velocity")[-1]) > 0.1
    assert (summary_of(still).settled, summary_of(moving).settled) == (True, False)


def test_equation_residual_is_that_of_the_trace(forward: Session, robot: RobotModel) -> None:
    """A_G a + dA_G v by Pinocchio's own call, against the sum of the measured wrenches (Eq. 20)."""
    q, v, rate = (column(forward, name) for name in ("q", "v", "momentum_rate_measured"))
    data = robot.model.createData()
    residuals = [
        np.abs(
            pin.computeCentroidalMomentumTimeVariation(
                robot.model, data, q[i], v[i], (v[i + 1] - v[i]) / 1e-3
            ).vector
            - rate[i]
        ).max()
        for i in range(0, len(q) - 1, 10)
    ]
    assert max(residuals) / (robot.mass * GRAVITY) < 1e-10
    assert 0.0 < summary_of(forward).max_equation_residual < 1e-10


def test_largest_residual_and_all_solver_failures_are_reported(talos: RobotModel) -> None:
    session = Session(Scenario("odd", seconds=0.01), talos)
    run_headless(session)
    session.recording.rows()[4, session.recording.slices["equation_residual"]] = 0.25
    session.solver_failures = 3
    summary = summary_of(session)
    assert (summary.max_equation_residual, summary.qp_failures) == (0.25, 3)


def test_timing_is_simulated_over_wall_time_and_percentiles(forward: Session) -> None:
    summary = summary_of(forward)
    assert summary.real_time_factor == pytest.approx(SECONDS / 0.5)
    assert summary.tick_us_p50 == pytest.approx(550.0)
    assert summary.tick_us_p99 == pytest.approx(991.0)


def test_gains_and_priority_are_those_in_effect(talos: RobotModel) -> None:
    session = Session(Scenario("set", seconds=0.01, gains={"linear_damping": 7.0}), talos)
    session.post(SetGain("angular_damping", 6.0))
    session.post(SetPriority(0.5))
    run_headless(session)
    summary = summary_of(session)
    assert summary.priority == 0.5
    assert {**summary.gains, "linear_damping": 7.0, "angular_damping": 6.0} == summary.gains
    assert summary.gains["linear_stiffness"] == 16.0


def test_simulation_that_broke_down_counts_as_a_fall(talos: RobotModel) -> None:
    session = Session(Scenario("broken", seconds=0.03), talos)
    run_headless(session)
    session.recording.rows()[-1, session.recording.slices["equation_residual"]] = np.nan
    summary = summarize(session, Timing(TIMING.tick_time, 0.5, error="the state is not finite any more"))
    assert (summary.fell, summary.settled, summary.fall_time) == (True, False, pytest.approx(0.03))
    assert summary.error == summary.fall_reason == "the state is not finite any more"
    assert math.isfinite(summary.max_equation_residual)


def test_json_has_every_key_and_no_nan(fallen: Session, talos: RobotModel) -> None:
    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    for session in (fallen, played(talos, Scenario("still", seconds=0.02))):
        document = json.loads(msgspec.json.encode(summary_of(session)), parse_constant=refuse)
        assert document.keys() >= KEYS.keys()
        for key, kinds in KEYS.items():
            assert type(document[key]) in kinds, key


KEYS: dict[str, tuple[type, ...]] = {
    "robot": (str,),
    "controller": (str,),
    "scenario": (str,),
    "engine": (str,),
    "seconds": (float,),
    "fell": (bool,),
    "fall_time": (float, type(None)),
    "settled": (bool,),
    "impulse": (float,),
    "impulse_ratio": (float,),
    "peak_com_excursion": (float,),
    "peak_angular_momentum": (float,),
    "min_cop_margin": (float,),
    "max_equation_residual": (float,),
    "qp_failures": (int,),
    "real_time_factor": (float,),
    "tick_us_p50": (float,),
    "tick_us_p99": (float,),
}


def test_headless_run_times_every_tick_and_stops_when_told() -> None:
    clock = SimpleNamespace(ticks=0)
    session = SimpleNamespace(scenario_ticks=10, tick=lambda: setattr(clock, "ticks", clock.ticks + 1))
    fractions: list[float] = []

    def proceed(fraction: float) -> bool:
        fractions.append(fraction)
        return fraction < 0.45

    timing = run_headless(session, proceed)  # type: ignore[arg-type]
    assert clock.ticks == len(timing.tick_time) == 5
    assert fractions == [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]
    assert (timing.tick_time > 0.0).all()
    assert timing.wall_time >= timing.tick_time.sum()
    assert timing.error is None
