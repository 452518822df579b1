"""The marks of the picture: what each one is called, looks like and means. Legend, scene and plots read them here.

Colours are the Okabe-Ito palette, which people with any kind of colour vision can tell apart; every mark also
has a shape and a label of its own, so that colour is never the only difference.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from momentum_lab import palette
from momentum_lab.palette import BLACK, CAPTURE, CMP, COM, COP, COP_WANTED, GREY, GRF, WHITE, YELLOW, Color

Theme = Literal["light", "dark"]
Shape = Literal[
    "ball",
    "ring",
    "disc",
    "diamond",
    "triangle",
    "cross",
    "square",
    "hollow square",
    "arrow",
    "thin arrow",
    "line",
    "bar",
    "area",
    "dashes",
]
Anchor = Literal["top-left", "top-right", "bottom-left", "bottom-right", "top-center"]


@dataclass(frozen=True, slots=True)
class MarkStyle:
    """How one kind of mark looks everywhere.

    Attributes:
        key: its name in the code.
        label: its name on the screen.
        shape: what is drawn.
        color: red, green, blue, 0 to 255.
        help: what it means, in one sentence.
        anchor: which corner of its label sits on the mark; labels of marks that meet do not cover each other.
    """

    key: str
    label: str
    shape: Shape
    color: Color
    help: str
    anchor: Anchor = "bottom-left"

    @property
    def linear(self) -> Color:
        """The colour as light intensities, which is how viser takes the colours of instances and arrows."""
        red, green, blue = (round(255.0 * _intensity(channel / 255.0)) for channel in self.color)
        return red, green, blue

    @property
    def css(self) -> str:
        """The colour as #rrggbb."""
        return palette.css(self.color)


def in_theme(style: MarkStyle, theme: Theme) -> MarkStyle:
    """How a mark looks on a light or a dark page: what is black on the one is white on the other."""
    return replace(style, color=WHITE) if theme == "dark" and style.color == BLACK else style


def _intensity(value: float) -> float:
    """Light intensity of one sRGB channel, both from 0 to 1."""
    return float(value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4)


_STYLES = (
    MarkStyle("com", "CoM", "ball", COM, "Centre of mass.", "bottom-left"),
    MarkStyle(
        "com_ground", "CoM on ground", "ring", COM, "The point straight below the CoM.", "bottom-right"
    ),
    MarkStyle("cop", "CoP", "diamond", COP, "Centre of pressure: where the ground pushes.", "top-right"),
    MarkStyle("foot_cop", "CoP of a foot", "disc", COP, "Where the ground pushes on one foot.", "top-right"),
    MarkStyle(
        "cop_desired",
        "desired CoP",
        "hollow square",
        COP_WANTED,
        "The CoP that both momentum goals together would need.",
        "bottom-left",
    ),
    MarkStyle(
        "cop_granted",
        "granted CoP",
        "square",
        COP_WANTED,
        "The nearest CoP that the safe support area allows.",
        "bottom-right",
    ),
    MarkStyle(
        "cmp",
        "CMP",
        "triangle",
        CMP,
        "Where the line through the CoM, parallel to the ground reaction force, meets the ground.",
        "top-left",
    ),
    MarkStyle(
        "capture",
        "capture point",
        "cross",
        CAPTURE,
        "Where the CMP has to be for the CoM to come to rest above it.",
        "bottom-left",
    ),
    MarkStyle("grf", "GRF", "arrow", GRF, "Net ground reaction force, drawn from the CoP.", "bottom-right"),
    MarkStyle(
        "foot_grf", "GRF of a foot", "thin arrow", GRF, "Ground reaction force on one foot.", "bottom-right"
    ),
    MarkStyle("push", "push", "arrow", BLACK, "The push, where it acts.", "bottom-right"),
    MarkStyle("com_cmp", "CoM to CMP", "line", CMP, "Parallel to the ground reaction force."),
    MarkStyle(
        "gap",
        "rate of angular momentum",
        "bar",
        CMP,
        "From the CoP to the CMP: the lever with which the ground reaction force turns the body.",
        "top-left",
    ),
    MarkStyle("support", "support polygon", "area", YELLOW, "The region that the CoP cannot leave."),
    MarkStyle(
        "safe_border",
        "safe border",
        "dashes",
        GREY,
        "How far the controller lets the CoP go; the number is the CoP's distance to the nearest edge.",
        "top-center",
    ),
)

STYLES: dict[str, MarkStyle] = {style.key: style for style in _STYLES}

PRESETS: dict[str, frozenset[str]] = {
    "minimal": frozenset({"com", "com_ground", "cop", "support", "push"}),
    "teaching": frozenset(STYLES) - {"foot_cop", "foot_grf", "cop_granted", "capture"},
    "everything": frozenset(STYLES),
}
START_PRESET = "teaching"
# A small picture has room for a few labels only: what moves the robot, and what it does to it.
ALL_LABELS = frozenset(STYLES)
FEW_LABELS = frozenset({"com", "push", "grf", "gap"})
