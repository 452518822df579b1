"""The words of a lesson: its numbers stand in braces and come from the runs."""

from __future__ import annotations

import re
from collections.abc import Mapping
from string import Formatter

from momentum_lab.errors import InputError
from momentum_lab.lesson.parts import Measure, Value, Values

# Numbers that are names: of equations, figures, lessons, a priority, an indexed symbol.
_NAMES = re.compile(r"(Eqs?\.|Figs?\.|Table|[Ll]esson|[Pp]riority) [\d, ]+(and \d+)?|[A-Za-z]+_\d+")


def check_words(text: str, measures: Mapping[str, Measure]) -> None:
    """Refuse a field without a measure, and a number that nothing has measured.

    Raises:
        InputError: its `given` is the offending part of the text.
    """
    try:
        pieces = list(Formatter().parse(text))
    except ValueError as error:
        raise InputError("text", text, f"fields such as {{name}} ({error})") from error
    for literal, field, *_ in pieces:
        if field is not None and field not in measures:
            raise InputError("text", f"{{{field}}}", f"a measure: {', '.join(measures) or 'there is none'}")
        loose = re.search(r"\d[\d.]*", _NAMES.sub("", literal))
        if loose:
            raise InputError("text", loose[0], "numbers from the runs: a measure in braces")


def spoken(text: str, measures: Mapping[str, Measure], values: Values) -> str:
    """A text with the value and unit of every measure in it."""
    return " ".join(
        text.format(**{name: with_unit(measures[name], values[name]) for name in measures}).split()
    )


def with_unit(measure: Measure, value: Value) -> str:
    """A value as it is read: 217 N."""
    return value if isinstance(value, str) else f"{value:{measure.spec}} {measure.unit}".strip()
