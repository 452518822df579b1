"""Numbers that keep their width while they change: figures of one width, and blanks as wide as a figure."""

from __future__ import annotations

from momentum_lab.plain import plain

FIGURE_SPACE = "\u2007"


def blanks(value: float, decimals: int, whole: int) -> str:
    """What stands before a number so that it is as wide as others with the same decimals.

    Args:
        value: the number.
        decimals: how many figures come after its point.
        whole: for how many figures before its point, a minus sign included, there is room.
    """
    room = whole + decimals + bool(decimals)
    return FIGURE_SPACE * max(0, room - len(plain(value, f".{decimals}f")))


def steady(value: float, decimals: int, whole: int) -> str:
    """The number with the blanks before it; the arguments are those of `blanks`."""
    return blanks(value, decimals, whole) + plain(value, f".{decimals}f")
