"""Figures whose runs several tests look at; each is played once."""

from __future__ import annotations

from functools import cache

from momentum_lab.experiments.claims import Claim, Figure
from momentum_lab.experiments.figures import FIGURES
from momentum_lab.experiments.play import Played, judged, play
from momentum_lab.scenario import Scenario


def always(_fraction: float) -> bool:
    return True


@cache
def played(name: str, robot: str) -> Played:
    """The runs of a figure; look, do not tick."""
    return play(FIGURES[name].scenarios(robot), always)


def claims(name: str, robot: str) -> list[Claim]:
    return judged(FIGURES[name], played(name, robot))


def failing(found: list[Claim]) -> list[str]:
    """The claims that do not hold, with what was measured."""
    return [f"{claim.text}: {claim.measured}, {claim.allowed}" for claim in found if not claim.holds]


def failing_with(figure: Figure, scenarios: dict[str, Scenario]) -> list[str]:
    """Which claims of a figure fail when other runs are put in."""
    return failing(judged(figure, play(scenarios, always)))


def any_starts(texts: list[str], start: str) -> bool:
    return any(text.startswith(start) for text in texts)
