from __future__ import annotations

import pytest

from momentum_lab.experiments import fig8
from momentum_lab.physics.push import Push
from momentum_lab.scenario import changed
from tests.experiments.played import any_starts, claims, failing, failing_with, played


@pytest.mark.parametrize("name", ["talos", "g1", "romeo", "icub"])
def test_claims_hold(name: str) -> None:
    assert failing(claims("fig8", name)) == []


def test_the_other_priority_gives_up_the_other_momentum() -> None:
    other = {"push": changed(fig8.scenarios("talos")["push"], priority=1.0, seconds=1.5)}
    failed = failing_with(fig8.FIGURE, other)
    assert any_starts(failed, "the rate of linear momentum is kept")
    assert any_starts(failed, "the rate of angular momentum about y gives way")


def test_a_small_push_stays_admissible() -> None:
    small = {
        "push": changed(fig8.scenarios("talos")["push"], pushes=(Push(velocity_change=0.05),), seconds=1.5)
    }
    assert any_starts(failing_with(fig8.FIGURE, small), "in between it is not")


def test_a_push_too_large_is_a_fall() -> None:
    large = {"push": changed(fig8.scenarios("g1")["push"], pushes=(Push(velocity_change=0.6),), seconds=2.0)}
    assert any_starts(failing_with(fig8.FIGURE, large), "the robot does not fall")


def test_the_picture_has_the_eight_panels() -> None:
    picture = fig8.draw(played("fig8", "talos").runs)
    titles = sorted(axes.get_title(loc="left")[:3] for axes in picture.axes)
    assert titles == [f"({letter})" for letter in "abcdefgh"]
