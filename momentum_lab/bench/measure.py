"""The measurement: stages, whole ticks and PlaCo take turns, so that all see the same machine."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import msgspec
import numpy as np

from momentum_lab.bench.placo_peer import PlacoPeer
from momentum_lab.bench.stages import STAGES, StagedTick
from momentum_lab.events import ApplyPush
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

ROBOTS = ("talos", "g1")
# Ticks of one kind in a row: long enough for warm caches, short enough that a busy machine hits all kinds.
_TURN = 50
_KEPT = 1000
_PUSH = Push(velocity_change=0.15)
_PUSH_EVERY = 2000


class Percentiles(msgspec.Struct, frozen=True):
    """Wall time of one call, us."""

    p50: float
    p99: float


class RobotBench(msgspec.Struct, frozen=True):
    """Speed with one robot standing on both feet, pushed by 0.15 m/s every two seconds.

    Attributes:
        robot: its name.
        ticks: how many ticks of each kind were measured.
        state_terms: `RobotModel.at`.
        controller: the reference and `Controller.compute`.
        physics: `Simulator.step`.
        recording: `observe` into a row of the recording.
        tick: the whole `Session.tick`.
        real_time_factor: simulated time over wall time of `Session.tick`.
        placo_solve: `DynamicsSolver.solve()` of PlaCo, its kinematics already up to date.
    """

    robot: str
    ticks: int
    state_terms: Percentiles
    controller: Percentiles
    physics: Percentiles
    recording: Percentiles
    tick: Percentiles
    real_time_factor: float
    placo_solve: Percentiles


def measure(name: str, seconds: float, report: Callable[[float], None]) -> RobotBench:
    """Measure with one robot.

    Args:
        name: a robot of the catalog.
        seconds: how long, wall time, s; at least one turn is measured.
        report: is told the fraction that is done.
    """
    robot = RobotModel.named(name)
    scenario = Scenario("bench", robot=name)
    staged = StagedTick(robot, scenario)
    session = Session(scenario, robot, capacity=_KEPT)
    peer = PlacoPeer(robot, session.state, scenario.timestep)
    _turn(staged, session, peer)
    turns: list[np.ndarray] = []
    start = perf_counter()
    while not turns or perf_counter() - start < seconds:
        turns.append(_turn(staged, session, peer))
        report((perf_counter() - start) / seconds)
    times = np.concatenate(turns)
    stages = {stage: _percentiles(times[:, i]) for i, stage in enumerate(STAGES)}
    ticks, solves = times[:, len(STAGES)], times[:, len(STAGES) + 1]
    return RobotBench(
        robot=name,
        ticks=len(times),
        **stages,
        tick=_percentiles(ticks),
        real_time_factor=scenario.timestep / float(ticks.mean()),
        placo_solve=_percentiles(solves),
    )


def _turn(staged: StagedTick, session: Session, peer: PlacoPeer) -> np.ndarray:
    """Wall times of the stages, of the whole tick and of PlaCo (n, 6), s."""
    if session.ticks % _PUSH_EVERY == 0:
        push = _PUSH.sized_for(session.robot.mass)
        staged.pushes = (msgspec.structs.replace(push, start=staged.time),)
        session.post(ApplyPush(push))
    stages = [staged.tick() for _ in range(_TURN)]
    ticks = [_timed(session.tick) for _ in range(_TURN)]
    peer.follow(session.state)
    solves = [_timed(peer.solve) for _ in range(_TURN)]
    return np.column_stack([stages, ticks, solves])


def _timed(call: Callable[[], object]) -> float:
    start = perf_counter()
    call()
    return perf_counter() - start


def _percentiles(times: np.ndarray) -> Percentiles:
    return Percentiles(*(1e6 * np.percentile(times, (50.0, 99.0))).tolist())
