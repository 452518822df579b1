"""momentum-lab replay: a run file or a trace again, and whether every bit is as it was."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import Any

import msgspec

from momentum_lab.cli.run import played, said
from momentum_lab.errors import InputError
from momentum_lab.provenance import versions
from momentum_lab.replay import Agreement, end_agreement, trace_agreement
from momentum_lab.run_file import KINDS, Run, read_run, run_of_trace
from momentum_lab.session import Session
from momentum_lab.trace import Trace, load_trace


def replay(args: Namespace) -> int:
    """Play the run of a file again and print whether it is the same.

    Returns:
        0 if the bits agree, or if the file does not say what they were; 1 if they differ.

    Raises:
        InputError: the file cannot be read or holds no run.
        KeyboardInterrupt: Ctrl+C.
    """
    if not args.file:
        raise InputError("file", "nothing", f"a file that ends in {', '.join(KINDS)}")
    path = Path(args.file)
    trace = load_trace(path) if path.suffix.lower() == ".npz" else None
    run = read_run(path) if trace is None else run_of_trace(trace)
    session, _, stopped = played(run)
    if stopped:
        raise KeyboardInterrupt
    agreement = _agreement(run, trace, session)
    others = {} if trace is None else _other_versions(trace.meta.get("versions"))
    if args.json:
        print(msgspec.json.encode(_plain(session, agreement, others)).decode())
    else:
        print(f"{run.scenario.name}, {session.robot.spec.name}: {session.ticks} ticks, {_done(run)}")
        print(
            "nothing to compare: the file does not say how the run ended"
            if agreement is None
            else said(agreement)
        )
        for name, (then, now) in others.items():
            print(f"recorded with {name} {then}, replayed with {now}")
    return 0 if agreement is None or agreement.agrees else 1


def _done(run: Run) -> str:
    """What was done in a run: the pushes of its scenario, and all that came on top."""
    pushes, events = len(run.scenario.pushes), len(run.events)
    return f"{pushes} push{'' if pushes == 1 else 'es'} in its scenario, {events} event{'' if events == 1 else 's'}"


def _agreement(run: Run, trace: Trace | None, session: Session) -> Agreement | None:
    if trace is not None:
        return trace_agreement(trace, session)
    return end_agreement(run, session) if run.end else None


def _other_versions(recorded: Any) -> dict[str, tuple[str, str]]:
    """Name -> version then and now, of what has changed since."""
    if not isinstance(recorded, dict):
        return {}
    return {
        name: (str(recorded.get(name, "unknown")), now)
        for name, now in versions().items()
        if recorded.get(name) != now
    }


def _plain(
    session: Session, agreement: Agreement | None, others: dict[str, tuple[str, str]]
) -> dict[str, Any]:
    return {
        "scenario": session.scenario.name,
        "robot": session.robot.spec.name,
        "ticks": session.ticks,
        "agrees": None if agreement is None else agreement.agrees,
        "compared": None if agreement is None else agreement.compared,
        "difference": None if agreement is None else agreement.difference,
        "other_versions": others,
    }
