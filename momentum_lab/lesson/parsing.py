"""Python text as a tree, from any thread."""

from __future__ import annotations

import ast
import contextlib
import threading
from typing import Any

# CPython 3.11 counts the depth of all trees it builds in one place: two threads at once make it fail.
# The lock keeps our threads apart; whoever prints a traceback builds trees without asking for it.
_ONE_AT_A_TIME = threading.Lock()
_TRIES = 20


def parsed(text: str, name: str = "<text>", mode: str = "exec") -> Any:
    """What `ast.parse` makes of a text.

    Args:
        text: a script or an expression.
        name: of the file it comes from.
        mode: `exec` for a script, `eval` for an expression.

    Raises:
        SyntaxError: it is not Python.
        ValueError: it holds what no text holds.
        SystemError: other threads disturbed it time and again.
    """
    for _ in range(_TRIES - 1):
        with contextlib.suppress(SystemError):
            return _parsed_alone(text, name, mode)
    return _parsed_alone(text, name, mode)


def _parsed_alone(text: str, name: str, mode: str) -> Any:
    with _ONE_AT_A_TIME:
        return ast.parse(text, name, mode)
