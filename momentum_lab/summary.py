"""What came out of a run, in a few numbers."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from momentum_lab.finished import FinishedRun, com_speed
from momentum_lab.headless import Timing
from momentum_lab.momentum.pendulum import pendulum_frequency, pendulum_impulse_bound
from momentum_lab.momentum.support import distance_to_edge, support_margin, support_polygon
from momentum_lab.physics.push import Push
from momentum_lab.session import Session

# A robot whose CoM is slower than this at the end has settled, m/s.
SETTLED_SPEED = 0.02
# A sole that presses less than this on the ground does not support, N.
_LEAST_SUPPORT = 1.0


class Summary(msgspec.Struct, frozen=True, kw_only=True):
    """The outcome of one run; SI units. A run whose simulation broke down counts as a fall at its end.

    Attributes:
        robot: who was pushed.
        controller: who kept the balance.
        scenario: the scenario's name.
        engine: the physics.
        seconds: simulated time, s.
        fell: whether the robot has fallen.
        fall_time: when, s.
        fall_reason: why it counts as fallen.
        settled: not fallen, and the CoM slower than 0.02 m/s at the end.
        impulse: of all pushes until the end of the run, N s.
        impulse_ratio: horizontal impulse of a push over what a pendulum survives with its CoP alone; the largest.
        peak_com_excursion: largest horizontal distance of the CoM from its start, m.
        peak_angular_momentum: largest |k|, kg m^2/s.
        min_cop_margin: smallest distance of the CoP from the edge of the support until a fall, m; None if no
            sole ever supported.
        max_equation_residual: largest |A_G a + dA_G v - dh_measured| / (m g) (Eq. 20).
        peak_torque_ratio: largest torque that the controller asked for, as a part of its motor's limit.
        qp_failures: ticks on which the controller fell back to its fallback torque.
        real_time_factor: simulated time over wall time.
        tick_us_p50: median wall time of a tick, us.
        tick_us_p99: its 99th percentile, us.
        priority: at the end of the run; 0 keeps linear momentum, 1 angular momentum.
        gains: all gains at the end of the run.
        seed: the scenario's.
        error: why the simulation broke down; None when it did not.
        beside: the outcome of the robot beside the first; None when there is none.
    """

    robot: str
    controller: str
    scenario: str
    engine: str
    seconds: float
    fell: bool
    fall_time: float | None
    fall_reason: str | None
    settled: bool
    impulse: float
    impulse_ratio: float
    peak_com_excursion: float
    peak_angular_momentum: float
    min_cop_margin: float | None
    max_equation_residual: float
    peak_torque_ratio: float
    qp_failures: int
    real_time_factor: float
    tick_us_p50: float
    tick_us_p99: float
    priority: float
    gains: dict[str, float]
    seed: int
    error: str | None
    beside: Summary | None = None


def summarize(session: Session | FinishedRun, timing: Timing) -> Summary:
    """The summary of a session that has run.

    Args:
        session: at least one tick old, its recording reaching back to the start of the run.
        timing: how long the ticks took.
    """
    fell, fall_time, fall_reason = _fall(session, timing)
    seconds = session.time
    return Summary(
        robot=session.robot.spec.name,
        controller=session.choices.controller,
        scenario=session.scenario.name,
        engine=session.scenario.engine,
        seconds=seconds,
        fell=fell,
        fall_time=fall_time,
        fall_reason=fall_reason,
        settled=not fell and _com_speed(session) < SETTLED_SPEED,
        impulse=math.fsum(push.delivered(seconds) for push in session.pushes),
        impulse_ratio=max((_impulse_ratio(session, push) for push in session.pushes), default=0.0),
        peak_com_excursion=_peak_com_excursion(session),
        peak_angular_momentum=_largest(np.linalg.norm(session.recording.column("momentum")[:, 3:], axis=1)),
        min_cop_margin=_min_cop_margin(session, math.inf if fall_time is None else fall_time),
        max_equation_residual=_largest(session.recording.column("equation_residual")),
        peak_torque_ratio=_largest(session.recording.column("torque_ratio")),
        qp_failures=session.solver_failures,
        real_time_factor=seconds / timing.wall_time,
        tick_us_p50=_percentile_us(timing.tick_time, 50.0),
        tick_us_p99=_percentile_us(timing.tick_time, 99.0),
        priority=session.choices.priority,
        gains=msgspec.to_builtins(session.choices.gains),
        seed=session.scenario.seed,
        error=timing.error,
    )


def _fall(session: Session | FinishedRun, timing: Timing) -> tuple[bool, float | None, str | None]:
    if session.fall is not None:
        return True, session.fall.time, session.fall.reason
    if timing.error is not None:
        return True, session.time, timing.error
    return False, None, None


def _com_speed(session: Session | FinishedRun) -> float:
    """Speed of the CoM against the ground under the feet at the last sample, m/s."""
    return session.com_speed if isinstance(session, FinishedRun) else com_speed(session)


def _impulse_ratio(session: Session | FinishedRun, push: Push) -> float:
    """J over m omega delta * omega T / (1 - exp(-omega T)), delta and omega from the state at the push.

    Zero for a push that the recording does not hold or that did not meet a standing robot.
    """
    recording, stance = session.recording, list(session.stance)
    row = int(np.searchsorted(recording.column("time"), push.start + 1e-9, side="right")) - 1
    elapsed = min(push.duration, session.time - push.start)
    if row < 0 or elapsed <= 0.0 or (session.fall and session.fall.time <= push.start):
        return 0.0
    com = recording.column("com")[row]
    poses = recording.column("sole_pose")[row]
    polygon = support_polygon(corners_in_world(session, poses)[stance].reshape(-1, 3))
    distance = distance_to_edge(com[:2], push.along, polygon)
    omega = pendulum_frequency(float(com[2] - poses[stance, 2].min()))
    bound = pendulum_impulse_bound(session.robot.mass, omega, distance, elapsed)
    return push.horizontal_part * push.delivered(session.time) / bound if bound > 0.0 else 0.0


def _peak_com_excursion(session: Session | FinishedRun) -> float:
    """How far the CoM gets from where it was over the ground, which may move, m."""
    ground = session.recording.column("ground_pose")[:, list(session.stance), :2].mean(axis=1)
    com = session.recording.column("com")[:, :2] - (ground - ground[0])
    return _largest(np.linalg.norm(com - com[0], axis=1))


def _min_cop_margin(session: Session | FinishedRun, until: float) -> float | None:
    """Smallest margin of the measured CoP in the hull of the soles that carry more than 1 N, m."""
    recording = session.recording
    standing = recording.column("time") < until
    pressed = recording.column("foot_wrench_measured")[standing, :, 2] > _LEAST_SUPPORT
    corners = corners_in_world(session, recording.column("sole_pose")[standing])
    cops = recording.column("cop_measured")[standing]
    margins = [
        support_margin(cop, support_polygon(points[feet].reshape(-1, 3)))
        for cop, points, feet in zip(cops, corners, pressed, strict=True)
        if feet.any()
    ]
    return min(margins, default=None)


def corners_in_world(session: Session | FinishedRun, poses: np.ndarray) -> np.ndarray:
    """Corners of the soles (..., F, 4, 3) at sole poses (..., F, 7), m.

    x = p + 2 w (u x c) + 2 u x (u x c) + c for a corner c and the quaternion (u, w).
    """
    local = np.array([sole.corners for sole in session.robot.soles])
    position, vector, scalar = poses[..., None, :3], poses[..., None, 3:6], poses[..., None, 6:]
    turned = 2.0 * np.cross(vector, local)
    return position + local + scalar * turned + np.cross(vector, turned)


def _largest(values: np.ndarray) -> float:
    """The largest finite number, 0 if there is none."""
    return float(values[np.isfinite(values)].max(initial=0.0))


def _percentile_us(times: np.ndarray, percent: float) -> float:
    return 1e6 * float(np.percentile(times, percent)) if times.size else 0.0
