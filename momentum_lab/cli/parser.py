"""The parser of the command line: its complaints have the form of every other error."""

from __future__ import annotations

import argparse
import re
from typing import Any, NoReturn

from momentum_lab.errors import InputError


class Parser(argparse.ArgumentParser):
    """A parser whose complaints have the form of every other error, and which knows its options."""

    def __init__(self, **settings: Any) -> None:
        self.options: list[str] = []
        super().__init__(allow_abbrev=False, **settings)

    def add_argument(self, *names: Any, **settings: Any) -> argparse.Action:
        """Add an argument, and remember its name if it is an option."""
        action = super().add_argument(*names, **settings)
        self.options += [name for name in action.option_strings if name.startswith("--")]
        return action

    def error(self, message: str) -> NoReturn:
        """Only missing and superfluous values come here; all other checks are in the types."""
        argument, _, rule = message.removeprefix("argument ").partition(": ")
        if "'" in rule:
            raise InputError(argument, rule.split("'")[1], "the option alone, without a value")
        raise InputError(argument, "nothing", "a value after it")


def with_negative_numbers(words: list[str]) -> list[str]:
    """`--push -inf` as `--push=-inf`: argparse takes most negative numbers for options."""
    joined: list[str] = []
    for word in words:
        if joined and re.fullmatch(r"--[a-z-]+", joined[-1]) and re.match(r"-(\.?\d|inf|nan)", word, re.I):
            joined[-1] += f"={word}"
        else:
            joined.append(word)
    return joined
