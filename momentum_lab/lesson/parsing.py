"""Python text as a tree, from any thread."""

from __future__ import annotations

import ast
import threading
from typing import Any

# CPython 3.11 counts the depth of all trees it builds in one place: two threads at once make it fail.
_ONE_AT_A_TIME = threading.Lock()


def parsed(text: str, name: str = "<text>", mode: str = "exec") -> Any:
    """What `ast.parse` makes of a text.

    Args:
        text: a script or an expression.
        name: of the file it comes from.
        mode: `exec` for a script, `eval` for an expression.

    Raises:
        SyntaxError: it is not Python.
        ValueError: it holds what no text holds.
    """
    with _ONE_AT_A_TIME:
        return ast.parse(text, name, mode)
