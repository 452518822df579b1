from __future__ import annotations

import inspect
import re

import pytest

from momentum_lab import errors
from momentum_lab.errors import InputError, LabError


def test_input_error_says_what_was_given_and_what_is_allowed() -> None:
    error = InputError("--push", "217N", "a number of newtons")
    assert str(error) == "--push: got 217N; allowed: a number of newtons"
    assert (error.argument, error.given, error.allowed) == ("--push", "217N", "a number of newtons")


@pytest.mark.parametrize(
    ("given", "printed"),
    [("two\nlines", "two lines"), ("", "nothing"), (" \t\n", "nothing"), (None, "None"), (0.5, "0.5")],
)
def test_message_is_one_line_whatever_was_given(given: object, printed: str) -> None:
    message = str(InputError("x", given, "a\nb"))
    assert message == f"x: got {printed}; allowed: a b"


def test_tree_in_the_docstring_is_the_tree_of_classes() -> None:
    """Every class is drawn, under its base, at the depth of its place in the hierarchy."""
    drawn = {}
    for line in (errors.__doc__ or "").splitlines():
        match = re.match(r"^([│├└─ ]*)([A-Z]\w+Error)\b", line)
        if match:
            drawn[match[2]] = len(match[1]) // 4
    classes = {
        name: len(inspect.getmro(cls)) - len(inspect.getmro(LabError))
        for name, cls in vars(errors).items()
        if inspect.isclass(cls) and issubclass(cls, LabError)
    }
    assert drawn == classes


@pytest.mark.parametrize("name", ["RobotError", "ScenarioError", "GainError", "ServerError"])
def test_bad_input_of_every_kind_can_be_caught_as_one(name: str) -> None:
    kind = getattr(errors, name)
    with pytest.raises(InputError, match=r"^thing: got 1; allowed: 2$"):
        raise kind("thing", 1, 2)
