"""Directions of momentum as text and as rows."""

from __future__ import annotations

import itertools

import pytest

from momentum_lab.errors import InputError
from momentum_lab.momentum.directions import ALL, NAMES, axes, directions, text_of


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("all", ALL),
        ("linear", (True, True, True, False, False, False)),
        ("linear+kz", (True, True, True, False, False, True)),
        ("ky+lx", (True, False, False, False, True, False)),
        ("linear+angular", ALL),
    ],
)
def test_text_names_directions(text, expected):
    assert directions(text) == expected


def test_the_shortest_text_names_the_same_directions():
    for chosen in itertools.product((True, False), repeat=6):
        assert directions(text_of(chosen)) == chosen
    assert text_of(ALL) == "all"
    assert text_of(directions("kz+lz+ly+lx")) == "linear+kz"
    assert text_of((False,) * 6) == "none"


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_one_direction(name):
    assert [NAMES[i] for i, wanted in enumerate(directions(name)) if wanted] == [name]


def test_axes_are_the_letters_of_each_block():
    assert axes(directions("linear+kz")) == ("xyz", "z")
    assert axes(directions("ly+kx+ky")) == ("y", "xy")
    assert axes((False,) * 6) == ("", "")


@pytest.mark.parametrize("text", ["", "linear+", "k", "LX"])
def test_other_text_is_refused_with_all_names(text):
    with pytest.raises(InputError, match=r"directions: got .*; allowed: all, linear, angular, none, lx"):
        directions(text)
