"""momentum-lab figure: a figure as picture, table and claims."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from rich.console import Console
from rich.table import Table

from momentum_lab.cli.progress import interruptible, progress
from momentum_lab.errors import InputError
from momentum_lab.experiments.claims import Claim, Figure
from momentum_lab.experiments.figures import figure_named
from momentum_lab.experiments.play import Played, judged, play, report
from momentum_lab.experiments.writing import paths, writable_folder, write
from momentum_lab.plain import plain
from momentum_lab.robot.catalog import load_spec
from momentum_lab.scenario import Scenario

_CLAIM_FAILED = 1


def figure(args: Namespace) -> int:
    """Play a figure's runs, write its three files, print its claims; exit code 1 if one does not hold.

    Ctrl+C writes nothing.

    Raises:
        InputError: there is no such figure or robot, or the folder cannot be written.
        KeyboardInterrupt: Ctrl+C.
    """
    chosen = figure_named(args.name)
    scenarios = chosen.scenarios(args.robot)
    for scenario in scenarios.values():
        # An unknown robot is told before a folder is asked for or made for it.
        load_spec(scenario.robot)
    if not args.out:
        raise InputError("--out", "nothing", "a folder for the three files")
    folder = writable_folder(Path(args.out), chosen.name)
    played = _played(chosen, scenarios)
    claims = judged(chosen, played)
    picture, table = chosen.draw(played.runs), chosen.table(played.runs)
    write(folder, chosen.name, picture, table, report(chosen, played, claims))
    _show(chosen, claims)
    for path in paths(folder, chosen.name):
        print(path)
    return 0 if all(claim.holds for claim in claims) else _CLAIM_FAILED


def _played(chosen: Figure, scenarios: dict[str, Scenario]) -> Played:
    with interruptible() as stopped, progress(chosen.name) as told:

        def proceed(fraction: float) -> bool:
            told(fraction)
            return not stopped.is_set()

        played = play(scenarios, proceed)
    if stopped.is_set():
        raise KeyboardInterrupt
    return played


def _show(chosen: Figure, claims: list[Claim]) -> None:
    table = Table("", "claim", "measured", "allowed", title=f"{chosen.name}: {chosen.title}")
    for claim in claims:
        value = plain(claim.measured, ".4g") if isinstance(claim.measured, float) else claim.measured
        table.add_row("holds" if claim.holds else "FAILS", claim.text, value, claim.allowed)
    Console(markup=False).print(table)
