"""Codes: there and back, and what happens to damaged ones."""

from __future__ import annotations

import math
import re

import msgspec
import pytest

from momentum_lab.errors import InputError
from momentum_lab.events import LoggedEvent, SetGain
from momentum_lab.run_file import Run
from momentum_lab.scenario import changed, load_scenario, scenario_names
from momentum_lab.share_code import MOST_LETTERS, from_code, link, to_code
from tests.test_run_file import RUN

STAND = Run(load_scenario("stand"))


@pytest.mark.parametrize("name", scenario_names())
def test_there_and_back(name):
    scenario = changed(load_scenario(name), gains={"linear_damping": 7.123456789012345}, priority=1 / 3)
    code = to_code(Run(scenario))
    assert from_code(code) == Run(scenario)
    assert re.fullmatch(r"[A-Za-z0-9_-]{1,600}", code)


def test_events_come_too():
    assert from_code(to_code(RUN)) == RUN


def test_an_address_and_line_breaks_do_no_harm():
    code = to_code(RUN)
    assert from_code(link("http://127.0.0.1:8080", code)) == RUN
    assert from_code(f" {code[:30]}\n{code[30:]}\n") == RUN


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda c: c[:-3], "a whole code; in this one letters are missing or changed"),
        (lambda c: c[:20] + ("A" if c[20] != "A" else "B") + c[21:], "a whole code; in this one letters"),
        (lambda c: "lab1-", "a whole code; in this one letters are missing or changed"),
        (lambda c: "lab1-A", "a whole code; in this one letters are missing or changed"),
        (lambda c: c + "%", "a code that this lab has made"),
        (lambda c: "", "a code that this lab has made"),
        (lambda c: "é", "a code that this lab has made"),
        (lambda c: c.replace("lab1", "lab2"), "version 1, which this lab writes"),
        (lambda c: c + "A" * MOST_LETTERS, f"at most {MOST_LETTERS} letters"),
    ],
)
def test_a_damaged_code_is_refused_in_one_line(spoil, message):
    with pytest.raises(InputError, match=f"^code: got .*; allowed: {message}") as caught:
        from_code(spoil(to_code(STAND)))
    assert "\n" not in str(caught.value)


def test_every_single_changed_letter_is_found():
    code = to_code(STAND)
    for i in range(len("lab1-"), len(code)):
        other = code[:i] + ("x" if code[i] != "x" else "y") + code[i + 1 :]
        # The last letter may hold bits that mean nothing; then the run is the same.
        try:
            assert from_code(other) == STAND
            assert i == len(code) - 1
        except InputError:
            continue


@pytest.mark.parametrize("bad", [3.0, math.nan])
def test_a_code_with_a_value_out_of_range_is_refused(bad):
    scenario = msgspec.structs.replace(STAND.scenario, priority=bad)
    with pytest.raises(InputError, match=r"^priority in the code: got "):
        from_code(to_code(Run(scenario)))


def test_a_run_too_long_for_a_code_says_what_to_do():
    events = tuple(LoggedEvent(i, SetGain("linear_damping", math.sin(i) + 2.0)) for i in range(1500))
    with pytest.raises(
        InputError, match=r"^code: got a run of 1500 events, .*; save it as a run file instead"
    ):
        to_code(Run(STAND.scenario, events, ticks=1500))
