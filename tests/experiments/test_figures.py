from __future__ import annotations

import pytest

from momentum_lab.errors import InputError
from momentum_lab.experiments.figures import FIGURES, figure_named
from momentum_lab.scenario import changed, load_scenario, sides
from tests.experiments.played import played


@pytest.mark.parametrize("name", FIGURES)
def test_the_app_opens_the_run_of_the_figure(name: str) -> None:
    """The scenario of that name is the first run, but for the controllers that Table 1 compares."""
    first = next(iter(figure_named(name).scenarios(None).values()))
    here, *_ = sides(load_scenario(name))
    assert first == changed(here, controller=first.controller, priority=first.priority)


@pytest.mark.parametrize("name", FIGURES)
@pytest.mark.parametrize("robot", ["talos", "g1"])
def test_every_picture_can_be_read(name: str, robot: str) -> None:
    """Titles, units on both axes, and a legend wherever there are curves."""
    picture = FIGURES[name].draw(played(name, robot).runs)
    assert picture.get_suptitle()
    for axes in picture.axes:
        if axes.axison and axes.get_lines():
            assert axes.get_title(loc="left")
            assert "[" in axes.get_ylabel()
    assert any(axes.get_legend() for axes in picture.axes) or picture.legends


@pytest.mark.parametrize("name", FIGURES)
def test_every_table_is_rectangular_and_says_its_units(name: str) -> None:
    table = FIGURES[name].table(played(name, "talos").runs)
    assert len({len(values) for values in table.values()}) == 1
    wordless = {"method", "result", "fallen, priority 0", "fallen, priority 1"}
    assert all("[" in column for column in table if column not in wordless)


def test_unknown_figure_lists_the_known_ones() -> None:
    with pytest.raises(InputError, match="figure: got fig99; allowed: one of arm-swing, fig1, "):
        figure_named("fig99")
