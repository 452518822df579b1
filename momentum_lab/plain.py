"""Numbers for people: a zero has no sign."""

from __future__ import annotations


def plain(value: float, spec: str) -> str:
    """A number in a Python format, without the minus of one that is rounded to zero."""
    text = f"{value:{spec}}"
    # What is left of such a number before its exponent, if it has one, are signs, points and zeros.
    return text if text.partition("e")[0].strip("-0. ") else text.replace("-", "", 1)
