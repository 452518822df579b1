"""All figures by name."""

from __future__ import annotations

from momentum_lab.errors import InputError
from momentum_lab.experiments import arm_swing, fig1, fig4, fig5, fig7, fig8, fig9, flight, kick, table1
from momentum_lab.experiments.claims import Figure

FIGURES: dict[str, Figure] = {
    figure.name: figure
    for figure in (
        arm_swing.FIGURE,
        fig1.FIGURE,
        fig4.FIGURE,
        fig5.FIGURE,
        fig7.FIGURE,
        fig8.FIGURE,
        fig9.FIGURE,
        flight.FIGURE,
        kick.FIGURE,
        table1.FIGURE,
    )
}


def figure_named(name: str) -> Figure:
    """The figure of that name.

    Raises:
        InputError: there is none.
    """
    if name not in FIGURES:
        raise InputError("figure", name, f"one of {', '.join(FIGURES)}")
    return FIGURES[name]
