"""What a page has room for."""

from __future__ import annotations

import pytest

from momentum_lab.app.page_plan import BAR_HEIGHT, LEFT, RIGHT, PagePlan
from tests.app.fakes import FakeClient


@pytest.mark.parametrize(
    ("width", "height", "roomy", "bar"),
    [
        (1920, 1080, True, True),
        (1280, 800, True, True),
        (1170, 800, True, True),
        (1024, 768, True, False),  # 324 pixels are left between the panels
        (768, 1024, False, False),
        (390, 844, False, False),
    ],
)
def test_a_bar_stands_where_it_has_room(width: int, height: int, roomy: bool, bar: bool) -> None:
    client = FakeClient()
    client.camera.image_width, client.camera.image_height = width, height
    plan = PagePlan.of(client)
    assert (plan.roomy, plan.bar) == (roomy, bar)
    assert plan.picture == width - LEFT - RIGHT
    assert plan.covered == (BAR_HEIGHT if bar else 0.0)
