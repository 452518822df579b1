"""Marks can be told apart by everybody: by their shapes alone, and by their colours under each colour blindness."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from momentum_lab.app.marks import STYLES, in_theme

# Machado, Oliveira, Fernandes (2009), severity 1: what is seen of linear red, green and blue.
SIGHTS = {
    "protanopia": (
        (0.152286, 1.052583, -0.204868),
        (0.114503, 0.786281, 0.099216),
        (-0.003882, -0.048116, 1.051998),
    ),
    "deuteranopia": (
        (0.367322, 0.860646, -0.227968),
        (0.280085, 0.672501, 0.047413),
        (-0.011820, 0.042940, 0.968881),
    ),
    "tritanopia": (
        (1.255528, -0.076749, -0.178779),
        (-0.078411, 0.930809, 0.147602),
        (0.004733, 0.691367, 0.303900),
    ),
    "no colour blindness": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
}
# CIE 1976: 2.3 is a difference that is just seen; five of them are seen at a glance.
APART = 5 * 2.3
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def lab_of(color: tuple[int, int, int], sight: str) -> np.ndarray:
    """CIE L*a*b* (D65) of a colour as somebody sees it."""
    channels = np.array(color) / 255.0
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    seen = np.clip(np.array(SIGHTS[sight]) @ linear, 0.0, 1.0)
    ratio = XYZ @ seen / XYZ.sum(axis=1)
    x, y, z = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def test_white_and_red_have_their_published_coordinates():
    np.testing.assert_allclose(lab_of((255, 255, 255), "no colour blindness"), (100, 0, 0), atol=0.02)
    np.testing.assert_allclose(lab_of((255, 0, 0), "no colour blindness"), (53.24, 80.09, 67.20), atol=0.05)


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_two_colours_of_marks_are_apart_for_every_eye(sight, theme):
    colors = {in_theme(style, theme).color for style in STYLES.values()}
    assert len(colors) >= 8
    pairs = combinations(sorted(colors), 2)
    distances = {
        pair: float(np.linalg.norm(lab_of(pair[0], sight) - lab_of(pair[1], sight))) for pair in pairs
    }
    nearest = min(distances, key=distances.__getitem__)
    assert distances[nearest] > APART, (nearest, distances[nearest])


def test_no_two_marks_share_shape_and_size_of_line():
    """An arrow is an arrow: only the push and the ground reaction force share one, and a label tells them apart."""
    shapes: dict[str, list[str]] = {}
    for key, style in STYLES.items():
        shapes.setdefault(style.shape, []).append(key)
    shared = {shape: keys for shape, keys in shapes.items() if len(keys) > 1}
    assert shared in ({}, {"arrow": ["grf", "push"]})
