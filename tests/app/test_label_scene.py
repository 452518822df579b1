"""Labels: one per place, never two names on top of each other."""

from __future__ import annotations

from momentum_lab.app.label_scene import arrange
from momentum_lab.app.overlays import Mark, Picture, overlays

HERE, NEAR, FAR = (0.0, 0.0, 0.0), (0.01, 0.0, 0.0), (0.2, 0.0, 0.0)


def texts(marks: list[Mark]) -> list[str]:
    return [label.text for label in arrange(marks, size=1.0)]


def test_points_near_each_other_share_a_label_that_claims_no_equality():
    assert texts([Mark("cmp", (NEAR,)), Mark("cop", (HERE,))]) == ["CoP · CMP"]


def test_points_apart_have_labels_of_their_own():
    labels = arrange([Mark("cop", (HERE,)), Mark("cmp", (FAR,))], size=1.0)
    assert [(label.key, label.text, label.at) for label in labels] == [
        ("cop", "CoP", HERE),
        ("cmp", "CMP", FAR),
    ]
    assert labels[0].anchor != labels[1].anchor


def test_small_robots_have_small_distances():
    marks = [Mark("cop", (HERE,)), Mark("cmp", (NEAR,))]
    assert len(arrange(marks, size=0.2)) == 2


def test_numbers_stand_beside_their_marks():
    marks = [
        Mark("grf", (HERE, FAR), text="886 N", at=NEAR),
        Mark("gap", (HERE, FAR), text="rate of angular momentum 40 N m", at=FAR),
    ]
    labels = arrange(marks, size=1.0)
    assert [(label.text, label.at) for label in labels] == [
        ("GRF 886 N", NEAR),
        ("rate of angular momentum 40 N m", FAR),
    ]


def test_lines_and_areas_have_no_label():
    assert texts([Mark("support", (HERE, NEAR, FAR)), Mark("com_cmp", (HERE, FAR))]) == []


def test_a_standing_robot_has_one_label_on_the_ground(standing, talos):
    labels = arrange(overlays(standing, Picture(talos)), size=0.88)
    on_ground = [label for label in labels if label.key in {"cop", "cmp", "com_ground", "cop_desired"}]
    assert len(on_ground) == 1
    assert on_ground[0].text.startswith("CoP · CMP · CoM on ground")
