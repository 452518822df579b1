"""momentum-lab run: a scenario without a screen, its summary and its trace."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import msgspec
from rich.console import Console
from rich.table import Table

from momentum_lab.active_bounds import held_for
from momentum_lab.cli.choices import chosen_run
from momentum_lab.cli.progress import interruptible, progress
from momentum_lab.errors import InputError, SimulationError
from momentum_lab.headless import Timing, run_headless
from momentum_lab.plain import plain
from momentum_lab.provenance import provenance
from momentum_lab.replay import Agreement, Script, end_agreement, prepared
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.summary import Summary, summarize
from momentum_lab.trace import save_trace, writable_file

if TYPE_CHECKING:
    from momentum_lab.cli.beside import Second

Made = TypeVar("Made")
_MOST_BOUNDS = 5
_USUAL_ENGINE = Scenario("").engine


def run(args: Namespace) -> int:
    """Run a scenario, save its trace if asked to, print its summary.

    A scenario with two robots is run for both, one after the other; trace and summary are the first one's and hold
    those of the other. A simulation that breaks down (its state is not finite any more) is reported on stderr with
    exit code 1; what was recorded before is saved and summarized, as a fall. Ctrl+C saves what there is, of the
    second robot nothing, and prints no summary.

    Raises:
        InputError: something that was typed cannot be used.
        SimulationError: the simulation broke down before its first sample.
        KeyboardInterrupt: Ctrl+C.
    """
    chosen = chosen_run(args)
    out = None if args.out is None else writable_file(Path(args.out))
    second = None if chosen.scenario.beside is None else _fitting(chosen, _second)
    session, timing, stopped = played(chosen)
    if out is not None:
        save_trace(session.recording, provenance(session), out)
    if stopped:
        raise KeyboardInterrupt
    if chosen.end:
        _note(said(end_agreement(chosen, session)))
    summary = summarize(session, timing)
    if second is not None:
        summary = msgspec.structs.replace(summary, beside=_beside(second, chosen))
        if out is not None:
            save_trace(session.recording, provenance(session), out, second.session.recording)
    if args.json:
        print(msgspec.json.encode(summary).decode())
    else:
        show(summary)
        print(f"bounds: {_bounds(session)}")
        if out is not None:
            print(f"trace: {out}")
    errors = [each.error for each in (summary, summary.beside) if each is not None and each.error is not None]
    for error in errors:
        _note(error)
    return 1 if errors else 0


def played(chosen: Run) -> tuple[Session, Timing, bool]:
    """A run to its end or to Ctrl+C, with a bar on a terminal; and whether it was the latter.

    Raises:
        InputError: something in it is not possible here.
        SimulationError: it broke down before its first sample.
    """
    session = _fitting(chosen, prepared)
    end = chosen.length * session.scenario.timestep
    for push in chosen.scenario.pushes:
        if push.start >= end:
            _note(f"the push at {push.start:g} s comes after the end of the run at {end:g} s")
    return session, *_timed(session, Script(chosen).cue, chosen.length)


def said(agreement: Agreement) -> str:
    """Whether the bits agree, in one line."""
    if agreement.agrees:
        return f"the same bits: {agreement.compared}"
    return f"other bits: {agreement.compared}; {agreement.difference}"


def show(summary: Summary) -> None:
    """The summary for people, on stdout."""
    table = Table(title=f"{summary.scenario}: {summary.robot}, {summary.controller}", show_header=False)
    robots = [summary] if summary.beside is None else [summary, summary.beside]
    for lines in zip(*map(_lines, robots), strict=True):
        table.add_row(lines[0][0], *(text for _, text in lines))
    if summary.engine != _USUAL_ENGINE:
        table.add_row("engine", *(each.engine for each in robots))
    if summary.beside is not None:
        table.add_row("controller", *(each.controller for each in robots))
        table.add_row("priority", *(f"{each.priority:g}" for each in robots))
    Console(markup=False).print(table)


def _bounds(session: Session) -> str:
    """The bounds that the first robot was held by for longest."""
    held = list(held_for(session).items())
    words = [f"{bound.holder}: {bound.what} {seconds:.2f} s" for bound, seconds in held[:_MOST_BOUNDS]]
    rest = len(held) - len(words)
    return "; ".join([*words, *([f"{rest} more"] if rest else [])]) or "none"


def _second(chosen: Run) -> Second:
    from momentum_lab.cli.beside import Second  # loads a part of the app, which one robot does not need

    return Second(chosen)


def played_beside(chosen: Run) -> tuple[Session, Timing, bool]:
    """As `played`, for the robot beside the first."""
    second = _fitting(chosen, _second)
    return second.session, *_timed(second.session, second.cue, chosen.length)


def _beside(second: Second, chosen: Run) -> Summary:
    """Run the robot beside the first one.

    Raises:
        SimulationError: the simulation broke down before its first sample.
        KeyboardInterrupt: Ctrl+C.
    """
    timing, stopped = _timed(second.session, second.cue, chosen.length)
    if stopped:
        raise KeyboardInterrupt
    return summarize(second.session, timing)


def _note(text: str) -> None:
    print(f"momentum-lab: {text}", file=sys.stderr)


def _fitting(chosen: Run, make: Callable[[Run], Made]) -> Made:
    """What is made for a run, if its recording fits into memory."""
    try:
        return make(chosen)
    except MemoryError as error:
        raise InputError(
            "seconds", chosen.scenario.seconds, "a run whose recording fits into memory"
        ) from error


def _timed(session: Session, cue: Callable[[Session], None], ticks: int) -> tuple[Timing, bool]:
    """Play a session to the end of its run or to Ctrl+C; whether it was the latter.

    Raises:
        SimulationError: it broke down before its first sample.
    """
    with interruptible() as stopped, progress(session.scenario.name) as report:

        def proceed(fraction: float) -> bool:
            report(fraction)
            return not stopped.is_set()

        timing = run_headless(session, proceed, cue, ticks)
    if timing.error is not None and not len(session.recording):
        raise SimulationError(timing.error)
    return timing, stopped.is_set()


def _lines(summary: Summary) -> list[tuple[str, str]]:
    margin = (
        "never supported"
        if summary.min_cop_margin is None
        else f"{plain(1e3 * summary.min_cop_margin, '.1f')} mm"
    )
    return [
        ("result", _result(summary)),
        ("push", _push(summary)),
        ("CoM moved at most", f"{1e3 * summary.peak_com_excursion:.1f} mm"),
        ("angular momentum at most", f"{summary.peak_angular_momentum:.2f} kg m^2/s"),
        ("smallest CoP margin", margin),
        ("largest torque asked for", f"{summary.peak_torque_ratio:.2f} of its motor's limit"),
        ("solver failures", f"{summary.qp_failures} ticks"),
        ("equation residual", f"{summary.max_equation_residual:.1e} m g"),
        ("speed", f"{summary.real_time_factor:.2f} x real time"),
        ("tick", f"{summary.tick_us_p50:.0f} us (median), {summary.tick_us_p99:.0f} us (99 %)"),
    ]


def _result(summary: Summary) -> str:
    if summary.fell:
        return f"fell at {summary.fall_time:.3f} s: {summary.fall_reason}"
    state = "stands still" if summary.settled else "stands, still moving"
    return f"{state} after {summary.seconds:g} s"


def _push(summary: Summary) -> str:
    if summary.impulse == 0.0:
        return "none"
    return f"{summary.impulse:.1f} N s, {summary.impulse_ratio:.2f} of what a pendulum survives on its CoP"
