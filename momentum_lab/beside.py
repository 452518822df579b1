"""A second robot beside the first, as plain data: what it does differently; everything else is as with the first."""

from __future__ import annotations

from typing import Annotated

import msgspec


class Beside(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What differs; None is as with the first robot.

    Attributes:
        controller: a controller of the registry; its gains start at their defaults.
        priority: 0 keeps linear momentum, 1 keeps angular momentum.
        gains: values that differ from the first robot's.
    """

    controller: str | None = None
    priority: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] | None = None
    gains: dict[str, float] = {}
