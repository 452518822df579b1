"""What changes in a thing while it runs, as values: a class declares it by its annotations, nothing else does."""

from __future__ import annotations

from typing import Any


def changing(thing: object) -> dict[str, Any]:
    """Name -> value of all that changes in a thing; none of these values is ever changed in place."""
    return {name: getattr(thing, name) for name in type(thing).__annotations__}


def put_back(thing: object, values: dict[str, Any]) -> None:
    """Let what changes in a thing be again what it was."""
    for name, value in values.items():
        setattr(thing, name, value)
