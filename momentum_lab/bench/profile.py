"""Where a tick's time goes, call by call."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from types import FrameType
from typing import Any

from numba.core import serialize

from momentum_lab.session import Session

# Every array that a compiled function returns passes through this function of numba's; it is not counted.
_INSIDE_NUMBA = getattr(getattr(serialize, "_numba_unpickle", None), "__code__", None)
# The last word of what a session calls in a tick -> its stage; everything else is the session's own.
_STAGE = {
    "dynamics": "state terms",
    "_believed": "state terms",
    "_control": "controller",
    "step": "physics",
    "_record": "recording",
}
SESSION = "session"
_WARM_UP, _COUNTED, _PROFILED = 20, 50, 300


@dataclass(slots=True)
class Call:
    """One function at one place of the tree of calls, over all profiled ticks.

    Attributes:
        name: of the function, with its file.
        calls: how often it was called.
        seconds: time spent in it and in what it calls, s.
        callees: what it calls, by name.
    """

    name: str
    calls: int = 0
    seconds: float = 0.0
    callees: dict[str, Call] = field(default_factory=dict)

    @property
    def own_seconds(self) -> float:
        """Time spent in the function itself, s."""
        return self.seconds - sum(call.seconds for call in self.callees.values())


@dataclass(frozen=True, slots=True)
class ProfileRow:
    """One line of the table.

    Attributes:
        depth: how many functions on the way from the tick.
        name: of the function, with its file.
        own: time in the function itself per tick, us.
        total: time in it and in what it calls per tick, us.
        calls: calls per tick.
    """

    depth: int
    name: str
    own: float
    total: float
    calls: float


def calls_per_tick(session: Session) -> float:
    """Calls of functions in one tick, Python and C alike: a measure of work that no busy machine disturbs."""
    for _ in range(_WARM_UP):
        session.tick()
    count = 0

    def watch(frame: FrameType, event: str, what: Any) -> None:
        nonlocal count
        inside = what is sys.setprofile or frame.f_code is _INSIDE_NUMBA
        count += event in ("call", "c_call") and not inside

    _watched(session, _COUNTED, watch)
    return count / _COUNTED


def profile(session: Session, least: float = 1.0) -> list[ProfileRow]:
    """The tree of calls of a tick; watching it makes each call about a microsecond slower.

    Args:
        session: what ticks.
        least: a function with all it calls is listed from this time per tick on, us.

    Returns:
        the functions, each followed by what it calls, the slowest first.
    """
    for _ in range(_WARM_UP):
        session.tick()
    root = Call("root")
    path = [root]
    starts = [0.0]

    def watch(frame: FrameType, event: str, what: Any) -> None:
        if what is sys.setprofile or frame.f_code is _INSIDE_NUMBA:
            return
        if event in ("call", "c_call"):
            name = _name(frame) if event == "call" else _builtin_name(what)
            path.append(path[-1].callees.setdefault(name, Call(name)))
            starts.append(perf_counter())
        elif len(path) > 1:
            call = path.pop()
            call.calls += 1
            call.seconds += perf_counter() - starts.pop()

    _watched(session, _PROFILED, watch)
    return _rows(root, 0, least)


def stages_of(rows: list[ProfileRow]) -> dict[str, float]:
    """Time of each stage of a tick, us, in the order in which they happen; they add up to the tick.

    Args:
        rows: the tree of calls of a tick.
    """
    stages = dict.fromkeys([*_STAGE.values(), SESSION], 0.0)
    for row in rows:
        if row.depth == 1:
            stages[_STAGE.get(row.name.rpartition(".")[2], SESSION)] += row.total
    stages[SESSION] += rows[0].total - sum(stages.values())
    return stages


def _watched(session: Session, ticks: int, watch: Any) -> None:
    before = sys.getprofile()
    for _ in range(ticks):
        sys.setprofile(watch)
        try:
            session.tick()
        finally:
            sys.setprofile(before)


def _rows(parent: Call, depth: int, least: float) -> list[ProfileRow]:
    rows = []
    for call in sorted(parent.callees.values(), key=lambda call: -call.seconds):
        total = 1e6 * call.seconds / _PROFILED
        if total >= least:
            own = 1e6 * call.own_seconds / _PROFILED
            rows.append(ProfileRow(depth, call.name, own, total, call.calls / _PROFILED))
            rows += _rows(call, depth + 1, least)
    return rows


def _name(frame: FrameType) -> str:
    """Module and function; frames of compiled functions know their file only."""
    module = frame.f_globals.get("__name__") or Path(frame.f_code.co_filename).stem
    file = module.removeprefix("momentum_lab.")
    return f"{file}.{getattr(frame.f_code, 'co_qualname', frame.f_code.co_name)}"


def _builtin_name(what: Any) -> str:
    return f"{what.__module__ or type(what.__self__).__name__}.{what.__name__}"
