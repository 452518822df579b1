"""A run as something to keep and to give away: the scenario and everything that was done in it."""

from __future__ import annotations

import hashlib
import io
import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from momentum_lab.errors import InputError, ScenarioError
from momentum_lab.events import LoggedEvent, SessionEvent
from momentum_lab.scenario import MAX_SECONDS, Scenario, check_finite, scenario_from
from momentum_lab.session import Session
from momentum_lab.trace import Trace, load_trace

FORMAT, VERSION = "momentum_lab run", 1
KINDS = (".json", ".toml", ".npz")
"""What a run can be read from: two forms of a run file, and a trace, which holds its run."""

MOST_EVENTS = 20_000
_LARGEST = {".json": 5_000_000, ".toml": 5_000_000, ".npz": 1_000_000_000}


class Run(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A scenario and its events: enough to see the same run again, bit for bit.

    Attributes:
        scenario: what was decided before the run.
        events: what was done in it, each with its tick.
        ticks: how long it lasted; 0: as long as the scenario.
        end: fingerprint of its last sample; empty: not known.
    """

    scenario: Scenario
    events: tuple[LoggedEvent, ...] = ()
    ticks: int = 0
    end: str = ""

    @property
    def length(self) -> int:
        """How many ticks a replay has to do."""
        return self.ticks or math.ceil(self.scenario.seconds / self.scenario.timestep - 1e-9)


def as_run(first: Scenario | Run) -> Run:
    """A scenario as a run in which nothing has been done yet; a run as it is."""
    return first if isinstance(first, Run) else Run(first)


def run_of(session: Session, waiting: Iterable[SessionEvent] = ()) -> Run:
    """What a session has done so far.

    Args:
        session: a session between two ticks.
        waiting: events that it will do at the start of its next tick.
    """
    events = (*session.log, *(LoggedEvent(session.ticks, event) for event in waiting))
    end = fingerprint(session.recording.latest.row) if len(session.recording) else ""
    return Run(session.scenario, events, session.ticks, end)


def fingerprint(row: np.ndarray) -> str:
    """Twelve digits that change with any bit of a sample (width,)."""
    return hashlib.sha256(np.ascontiguousarray(row, dtype=np.float64).tobytes()).hexdigest()[:12]


def encoded(run: Run) -> bytes:
    """The run as the text of a .json file."""
    data = {"format": FORMAT, "version": VERSION, **msgspec.to_builtins(run)}
    return (json.dumps(data, indent=1, allow_nan=False) + "\n").encode()


def read_run(path: Path) -> Run:
    """The run of a file.

    Raises:
        InputError: it cannot be read, or holds no run.
    """
    try:
        content = path.read_bytes() if path.stat().st_size <= _limit(path.name) else b""
    except OSError as error:
        raise InputError("run file", path, f"a file that can be read ({error.strerror})") from error
    return decoded(str(path), content)


def decoded(name: str, content: bytes) -> Run:
    """The run in the content of a file.

    Args:
        name: of the file; its end says what is in it.
        content: all of it.

    Raises:
        InputError: it is no run, of another version, or too large.
    """
    kind, limit = Path(name).suffix.lower(), _limit(name)
    if not 0 < len(content) <= limit:
        raise InputError("run file", f"{name} of {len(content)} bytes", f"1 to {limit} bytes")
    if kind == ".npz":
        return run_of_trace(load_trace(io.BytesIO(content), name))
    try:
        data = msgspec.toml.decode(content) if kind == ".toml" else msgspec.json.decode(content)
    except (ValueError, RecursionError) as error:
        raise InputError("run file", name, f"a {kind} file that can be read ({error})") from error
    return _from_file(data, name)


def run_of_trace(trace: Trace) -> Run:
    """The run that a trace was recorded in.

    Raises:
        InputError: its meta entry holds none.
    """
    data = {name: trace.meta.get(name) for name in ("scenario", "events", "ticks")}
    if data["ticks"] is None:
        data["ticks"] = len(trace.columns["time"])
    last = [np.ravel(column[-1]) for column in trace.columns.values() if len(column)]
    return run_from({**data, "end": fingerprint(np.concatenate(last)) if last else ""}, " in the trace")


def run_from(data: Any, where: str = "") -> Run:
    """Plain data as a run; whether its robot can do all its events is found out by a session.

    Raises:
        InputError: it is no run; the message names the field.
    """
    if not isinstance(data, dict) or not isinstance(data.get("scenario"), dict):
        raise ScenarioError("scenario" + where, "nothing", "a table with the fields of a scenario")
    scenario = scenario_from(data["scenario"], where)
    check_finite({name: value for name, value in data.items() if name != "scenario"}, where)
    try:
        run = msgspec.convert({**data, "scenario": scenario}, Run)
    except msgspec.ValidationError as error:
        rule, _, place = str(error).partition(" - at ")
        field = place.strip("`").removeprefix("$.") or "run"
        raise InputError(field + where, "something else", rule.replace("`", "")) from error
    return _in_order(run, where)


def _in_order(run: Run, where: str) -> Run:
    most = round(MAX_SECONDS / run.scenario.timestep)
    if not 0 <= run.ticks <= most:
        raise InputError("ticks" + where, run.ticks, f"0 to {most}, which is {MAX_SECONDS:g} s")
    if len(run.events) > MOST_EVENTS:
        raise InputError("events" + where, len(run.events), f"at most {MOST_EVENTS}")
    ticks = [entry.tick for entry in run.events]
    if ticks != sorted(ticks) or (ticks and not 0 <= ticks[0] <= ticks[-1] <= run.length):
        raise InputError("events" + where, f"ticks {ticks[:5]}...", f"ticks in order, 0 to {run.length}")
    return run


def _from_file(data: Any, name: str) -> Run:
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise InputError("run file", name, f'a file with format = "{FORMAT}"')
    if data.get("version") != VERSION:
        raise InputError(f"version in {name}", data.get("version"), f"{VERSION}, which this lab writes")
    return run_from({k: v for k, v in data.items() if k not in ("format", "version")}, f" in {name}")


def _limit(name: str) -> int:
    kind = Path(name).suffix.lower()
    if kind not in _LARGEST:
        raise InputError("run file", name, f"a file that ends in {', '.join(KINDS)}")
    return _LARGEST[kind]
