"""momentum-lab lesson: a guided lesson, in the browser or played without one."""

from __future__ import annotations

from argparse import Namespace

import msgspec
from rich.console import Console
from rich.table import Table

from momentum_lab.cli.progress import interruptible, progress
from momentum_lab.experiments.claims import Claim
from momentum_lab.lesson.loader import find_lesson, lesson_folder
from momentum_lab.lesson.parts import Choice, Explain, Lesson, Number, Step
from momentum_lab.lesson.playing import Played, play_lesson, report, told
from momentum_lab.lesson.reading import read_lesson
from momentum_lab.plain import plain
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import changed, load_scenario
from momentum_lab.session import Session

_CLAIM_FAILED = 1


def lesson(args: Namespace) -> int:
    """Open a lesson, or play it without a screen; exit code 1 if one of its claims does not hold.

    Raises:
        InputError: there is no such lesson or robot, or the lesson's script has an error in it.
        KeyboardInterrupt: Ctrl+C.
    """
    chosen = read_lesson(find_lesson(args.name, lesson_folder(args.lessons)))
    if args.headless or args.json:
        return _headless(chosen, args)
    return _in_browser(chosen, args)


def _headless(chosen: Lesson, args: Namespace) -> int:
    robot = RobotModel.named(args.robot or chosen.robots[0])
    with interruptible() as stopped, progress(chosen.title) as said:

        def proceed(fraction: float) -> bool:
            if stopped.is_set():
                # Measures of a run that was cut short mean nothing.
                raise KeyboardInterrupt
            said(fraction)
            return True

        played = play_lesson(chosen, robot, proceed)
    if args.json:
        print(msgspec.json.encode(report(played)).decode())
    else:
        _show(played)
    return 0 if played.holds else _CLAIM_FAILED


def _in_browser(chosen: Lesson, args: Namespace) -> int:
    scenario = changed(load_scenario("stand"), robot=args.robot or chosen.robots[0])
    Session(scenario, capacity=1)

    from momentum_lab.app.library import Library
    from momentum_lab.app.server import serve

    print(f"{chosen.number}. {chosen.title}\n{chosen.question}", flush=True)
    serve(
        scenario,
        host=args.host,
        port=args.port,
        open_browser=not args.no_browser,
        library=Library(chosen.file.parent),
        lesson=chosen.file,
    )
    return 0


def _show(played: Played) -> None:
    """The lesson as it is read, then its claims, on stdout."""
    console = Console(markup=False, highlight=False)
    robot = next(iter(played.runs.values())).robot.spec.title
    console.print(f"{played.lesson.number}. {played.lesson.title} ({robot})\n{played.lesson.question}\n")
    for step in played.lesson.steps:
        for line in _lines(step, played):
            console.print(line)
        console.print()
    _show_claims(console, played.claims)


def _lines(step: Step, played: Played) -> list[str]:
    record = told(step, played)
    text = str(record["text"])
    if isinstance(step, Choice):
        marks = ["->" if place in record["right"] else "  " for place in range(len(step.options))]
        return [text, *(f" {mark} {words}" for mark, words in zip(marks, record["options"], strict=True))]
    if isinstance(step, Number):
        return [text, f" -> {plain(record['measured'], '.4g')} {record['unit']}"]
    if isinstance(step, Explain):
        symbols = (
            f"   {name} = {plain(value, step.equation.symbols[name].spec)} {step.equation.symbols[name].unit}"
            f"  {step.equation.symbols[name].words}"
            for name, value in record["symbols"].items()
        )
        left = f"   at {record['time']:g} s; residual in most of the run {record['residual']:.2g} {record['unit']}"
        return [text, f"   {record['equation']}", *symbols, left]
    return [text]


def _show_claims(console: Console, claims: tuple[Claim, ...]) -> None:
    table = Table("", "claim", "measured", "allowed")
    for claim in claims:
        value = plain(claim.measured, ".4g") if isinstance(claim.measured, float) else claim.measured
        table.add_row("holds" if claim.holds else "FAILS", claim.text, value, claim.allowed)
    console.print(table)
