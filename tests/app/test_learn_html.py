"""What the lessons' panel shows: escaped, in words and signs, never in colour alone."""

from __future__ import annotations

import re

import numpy as np
import pytest

from momentum_lab.app import learn_html
from momentum_lab.lesson.record import EquationRecord, StepRecord, SymbolRecord, written

CHOICE = StepRecord("choice", "Who <b>stands</b>?", options=("Both", "None & all"), right=(1,))
NUMBER = StepRecord("number", "How much?", low=-200.0, high=200.0, unit="N", measured=-78.5)


def test_texts_are_escaped() -> None:
    for shown in (learn_html.text("<script>"), learn_html.error("<script>"), learn_html.claims(["<script>"])):
        assert "<script>" not in shown
        assert "&lt;script&gt;" in shown
    assert "&lt;b&gt;stands" in learn_html.compared(CHOICE, 1.0)


@pytest.mark.parametrize(
    ("mine", "words"),
    [
        (1.0, "✔ As you predicted:</b> B None &amp; all"),
        (0.0, "✖ Otherwise.</b> You: A Both"),
        (None, "Measured: <b>B None"),
    ],
)
def test_choice_beside_what_was_measured(mine: float | None, words: str) -> None:
    assert words in learn_html.compared(CHOICE, mine)


@pytest.mark.parametrize(
    ("mine", "words"), [(-70.0, "✔ Close."), (100.0, "✖ Off by 178 N."), (None, "Measured: <b>−78.5 N")]
)
def test_number_beside_what_was_measured(mine: float | None, words: str) -> None:
    shown = learn_html.compared(NUMBER, mine)
    assert words in shown
    assert "−78.5 N" in shown


def test_equation_carries_the_numbers_of_the_instant() -> None:
    def symbol(values: list[float]) -> SymbolRecord:
        return SymbolRecord("N", "a force", ".1f", np.array(values).tobytes())

    record = EquationRecord(
        "a = b",
        {"a": symbol([1.0, 2.0, 3.0]), "b": symbol([1.5])},
        np.array([0.5, 0.5, 1.5]).tobytes(),
        "N",
        1.5,
        2.0,
        0.1,
        3,
    )
    labels = [
        re.findall("<mtext>(.*?)</mtext>", learn_html.equation(record, time)) for time in (0.0, 0.1, 9.0)
    ]
    assert labels == [["1.0 N", "1.5 N"], ["2.0 N", "1.5 N"], ["3.0 N", "1.5 N"]]
    assert "both sides differ by <b>1.5 N</b>" in learn_html.equation(record, 0.2)


def test_small_numbers_are_written_as_people_do() -> None:
    step = StepRecord("number", "?", low=0.0, high=1.0, measured=2.9e-7)
    assert "2.9\u202f·\u202f10<sup>−7</sup>" in learn_html.compared(step, None)


@pytest.mark.parametrize(("value", "text"), [(-0.01, "0.0"), (-0.06, "−0.1"), (12.34, "12.3"), (0.0, "0.0")])
def test_a_zero_has_no_minus(value: float, text: str) -> None:
    assert written(value, ".1f") == text
