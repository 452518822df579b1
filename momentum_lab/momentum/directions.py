"""Which of the six directions of momentum a controller is asked for (section 5.3.1)."""

from __future__ import annotations

from momentum_lab.errors import InputError

Directions = tuple[bool, bool, bool, bool, bool, bool]
"""Whether l_x, l_y, l_z, k_x, k_y, k_z are asked for, in this order."""

NAMES = ("lx", "ly", "lz", "kx", "ky", "kz")
"""What the directions are called in text."""

ALL: Directions = (True, True, True, True, True, True)
"""All six."""

_GROUPS = {"all": frozenset(NAMES), "linear": frozenset(NAMES[:3]), "angular": frozenset(NAMES[3:])} | {
    "none": frozenset()
}


def directions(text: str) -> Directions:
    """The directions that a text such as `all`, `linear+kz` or `lx+ly+ky` names.

    Raises:
        InputError: a part of the text is no direction.
    """
    wanted: frozenset[str] = frozenset()
    for part in text.split("+"):
        if part not in _GROUPS and part not in NAMES:
            raise InputError("directions", text, f"{', '.join((*_GROUPS, *NAMES))}, several joined by +")
        wanted |= _GROUPS.get(part, frozenset((part,)))
    lx, ly, lz, kx, ky, kz = (name in wanted for name in NAMES)
    return lx, ly, lz, kx, ky, kz


def text_of(controlled: Directions) -> str:
    """The shortest text that names some directions; `none` for none at all."""
    words = [
        [group] if all(chosen) else [name for name, wanted in zip(names, chosen, strict=True) if wanted]
        for group, names, chosen in (
            ("linear", NAMES[:3], controlled[:3]),
            ("angular", NAMES[3:], controlled[3:]),
        )
    ]
    return "all" if all(controlled) else "+".join(words[0] + words[1]) or "none"


def axes(controlled: Directions) -> tuple[str, str]:
    """The controlled axes of linear and of angular momentum, each as letters out of xyz."""
    letters = ["".join("xyz"[i % 3] for i in block if controlled[i]) for block in (range(3), range(3, 6))]
    return letters[0], letters[1]
