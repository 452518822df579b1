"""Every mark differs from every other by more than its colour."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest

from momentum_lab.app import marks
from momentum_lab.app.marks import PRESETS, START_PRESET, STYLES

OKABE_ITO = {
    (0, 0, 0),
    (230, 159, 0),
    (86, 180, 233),
    (0, 158, 115),
    (240, 228, 66),
    (0, 114, 178),
    (213, 94, 0),
    (204, 121, 167),
}


def test_no_two_marks_look_alike():
    looks = [(style.shape, style.color) for style in STYLES.values()]
    assert len(set(looks)) == len(looks)


def test_points_have_a_shape_each():
    solids = {"ball", "ring", "disc", "diamond", "triangle", "cross", "square", "hollow square"}
    shapes = [style.shape for style in STYLES.values() if style.shape in solids]
    assert len(set(shapes)) == len(shapes) == 8


def test_labels_are_different_and_short():
    labels = [style.label for style in STYLES.values()]
    assert len(set(labels)) == len(labels)
    assert max(map(len, labels)) <= 24


def test_colours_come_from_the_palette_or_are_grey():
    for style in STYLES.values():
        red, green, blue = style.color
        assert style.color in OKABE_ITO or red == green == blue


def test_every_mark_has_an_explanation():
    assert all(style.help.endswith(".") for style in STYLES.values())


def test_presets_grow():
    assert PRESETS["minimal"] < PRESETS["teaching"] < PRESETS["everything"] == set(STYLES)
    assert START_PRESET == "teaching"


def test_the_picture_that_teaches_is_complete():
    assert {"com", "cop", "cmp", "grf", "com_cmp", "gap", "cop_desired", "support", "push"} <= PRESETS[
        "teaching"
    ]


def test_css_colour():
    assert STYLES["cmp"].css == "#d55e00"


@pytest.mark.parametrize(("value", "intensity"), [(0, 0), (255, 255), (188, 128)])
def test_light_intensity_of_a_grey(value, intensity):
    # sRGB 188 is known as the middle grey of light.
    style = marks.MarkStyle("x", "x", "ball", (value, value, value), "X.")
    np.testing.assert_allclose(style.linear, intensity, atol=1)


def test_intensities_keep_the_hue_recognisable():
    for style in STYLES.values():
        if len(set(style.color)) > 1:
            before = colorsys.rgb_to_hsv(*(channel / 255 for channel in style.color))[0]
            after = colorsys.rgb_to_hsv(*(channel / 255 for channel in style.linear))[0]
            assert abs(before - after) < 0.08
