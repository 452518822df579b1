"""The measurement: stages, whole ticks and the peer take turns, so that all see the same machine."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import msgspec
import numpy as np
from threadpoolctl import threadpool_limits

from momentum_lab.bench.peer import PeerLoop, PlacoPeer
from momentum_lab.bench.profile import calls_per_tick
from momentum_lab.bench.stages import STAGES, StagedTick
from momentum_lab.errors import LabError
from momentum_lab.events import ApplyPush
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import State
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

ROBOTS = ("talos", "g1")
# Ticks of one kind in a row: long enough for warm caches, short enough that a busy machine hits all kinds.
_TURN = 50
_KEPT = 1000
_PUSH = Push(velocity_change=0.15)
_PUSH_EVERY, _PUSH_TICKS = 2000, 100


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
        calls_per_tick: calls of functions in one `Session.tick`, those written in C included.
        peer_tick: the loop that a user would build instead, `PeerLoop.tick`; None without MuJoCo.
        peer_placo: its controller: MuJoCo's state into PlaCo, kinematics, `DynamicsSolver.solve()`.
        peer_mujoco: its physics: `mj_step` with four contacts under each foot.
        tick_to_peer: median of `tick` over median of `peer_tick`.
        missing: why there is no peer, in words.
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
    calls_per_tick: float
    peer_tick: Percentiles | None = None
    peer_placo: Percentiles | None = None
    peer_mujoco: Percentiles | None = None
    tick_to_peer: float | None = None
    missing: str | None = None


def measure(name: str, seconds: float, report: Callable[[float], None]) -> RobotBench:
    """Measure with one robot, on one thread.

    Args:
        name: a robot of the catalog.
        seconds: how long, wall time, s; at least one turn is measured.
        report: is told the fraction that is done.
    """
    with threadpool_limits(1):
        field = _Field(name)
        field.turn()
        turns: list[np.ndarray] = []
        start = perf_counter()
        while not turns or perf_counter() - start < seconds:
            turns.append(field.turn())
            report((perf_counter() - start) / seconds)
        return field.result(np.concatenate(turns))


class _Field:
    """All that take part, side by side."""

    def __init__(self, name: str) -> None:
        robot = RobotModel.named(name)
        scenario = Scenario("bench", robot=name)
        self.force = _PUSH.sized_for(robot.mass)
        self.staged = StagedTick(robot, scenario)
        self.session = Session(scenario, robot, capacity=_KEPT)
        self.placo = PlacoPeer(robot, self.session.state, scenario.timestep)
        self.peer, self.missing = _peer(self.placo, self.session.state, scenario.timestep)
        self.calls = calls_per_tick(Session(scenario, robot, capacity=_KEPT))

    def turn(self) -> np.ndarray:
        """Wall times of the stages, of the whole tick, of PlaCo and of the peer's two parts (n, 6 or 8), s."""
        self._push()
        stages = [self.staged.tick() for _ in range(_TURN)]
        ticks = [_timed(self.session.tick) for _ in range(_TURN)]
        self.placo.follow(self.session.state)
        columns: list[Any] = [stages, ticks, [_timed(self.placo.solve) for _ in range(_TURN)]]
        if self.peer is not None:
            columns.append([(_timed(self.peer.control), _timed(self.peer.move)) for _ in range(_TURN)])
        return np.column_stack(columns)

    def _push(self) -> None:
        phase = self.session.ticks % _PUSH_EVERY
        if phase == 0:
            self.staged.pushes = (msgspec.structs.replace(self.force, start=self.staged.time),)
            self.session.post(ApplyPush(self.force))
        if self.peer is not None and phase in (0, _PUSH_TICKS):
            size = 0.0 if phase else self.force.mean_force(self.force.start, self.session.scenario.timestep)
            self.peer.push(size * self.force.direction)

    def result(self, times: np.ndarray) -> RobotBench:
        """The percentiles of the columns of all turns."""
        parts: dict[str, Any] = {stage: _percentiles(times[:, i]) for i, stage in enumerate(STAGES)}
        ticks, solves = times[:, len(STAGES)], times[:, len(STAGES) + 1]
        parts.update(_peer_result(ticks, times[:, len(STAGES) + 2 :]))
        return RobotBench(
            robot=self.session.robot.spec.name,
            ticks=len(times),
            tick=_percentiles(ticks),
            real_time_factor=self.session.scenario.timestep / float(ticks.mean()),
            placo_solve=_percentiles(solves),
            calls_per_tick=self.calls,
            missing=self.missing,
            **parts,
        )


def _peer(placo: PlacoPeer, home: State, timestep: float) -> tuple[PeerLoop | None, str | None]:
    """The peer, or what it lacks."""
    try:
        return PeerLoop(placo, home, timestep), None
    except LabError as error:
        return None, str(error)


def _peer_result(ticks: np.ndarray, times: np.ndarray) -> dict[str, Any]:
    if not times.size:
        return {}
    whole = times.sum(axis=1)
    return {
        "peer_tick": _percentiles(whole),
        "peer_placo": _percentiles(times[:, 0]),
        "peer_mujoco": _percentiles(times[:, 1]),
        "tick_to_peer": float(np.median(ticks) / np.median(whole)),
    }


def _timed(call: Callable[[], object]) -> float:
    start = perf_counter()
    call()
    return perf_counter() - start


def _percentiles(times: np.ndarray) -> Percentiles:
    return Percentiles(*(1e6 * np.percentile(times, (50.0, 99.0))).tolist())
