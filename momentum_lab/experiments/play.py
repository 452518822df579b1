"""Play the runs of a figure without a screen, and judge its claims."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import msgspec

from momentum_lab.errors import SimulationError
from momentum_lab.experiments.claims import Claim, Figure, Runs
from momentum_lab.headless import run_headless
from momentum_lab.provenance import versions
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session


@dataclass(frozen=True, slots=True)
class Played:
    """The runs of a figure, each to its end.

    Attributes:
        runs: the sessions by label.
        broken: label -> why a simulation ended before its time.
    """

    runs: Runs
    broken: dict[str, str]


def play(scenarios: dict[str, Scenario], proceed: Callable[[float], bool]) -> Played:
    """Run every scenario to its end.

    Args:
        scenarios: the runs by label.
        proceed: asked before every tick with the fraction of all runs that is done; False ends them.

    Raises:
        InputError: a scenario names something that does not exist.
        SimulationError: a simulation broke down before its first sample.
    """
    runs: dict[str, Session] = {}
    broken: dict[str, str] = {}
    for label, scenario in scenarios.items():
        session = Session(scenario)
        timing = run_headless(session, _part_of(len(runs), len(scenarios), proceed))
        if not len(session.recording):
            raise SimulationError(timing.error or f"the run {label} was stopped before its first tick")
        runs[label] = session
        if timing.error is not None:
            broken[label] = timing.error
    return Played(runs, broken)


def _part_of(done: int, count: int, proceed: Callable[[float], bool]) -> Callable[[float], bool]:
    """What one run asks, told as a fraction of all runs."""
    return lambda fraction: proceed((done + fraction) / count)


def judged(figure: Figure, played: Played) -> list[Claim]:
    """All claims of a figure; a simulation that broke down is a claim that fails."""
    ended = [
        Claim(f"the run {label} reaches its end", error, "finite to the end", holds=False)
        for label, error in played.broken.items()
    ]
    return ended + figure.claims(played.runs)


def report(figure: Figure, played: Played, claims: list[Claim]) -> dict[str, Any]:
    """What the JSON file of a figure says."""
    return {
        "figure": figure.name,
        "title": figure.title,
        "robot": next(iter(played.runs.values())).robot.spec.name,
        "holds": all(claim.holds for claim in claims),
        "claims": msgspec.to_builtins(claims),
        "scenarios": {label: msgspec.to_builtins(session.scenario) for label, session in played.runs.items()},
        "versions": versions(),
    }
