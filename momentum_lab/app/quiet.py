"""Viser announces itself on the console; the lab does that in its own words."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import rich


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """Nothing that viser has to say is printed for as long as the context lasts."""
    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before
