"""Opening lessons one after the other: what one of them comes to is told while it is asked for, and not later."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

from momentum_lab.app.learn_panel import LearnPanel
from momentum_lab.app.library import Entry
from momentum_lab.errors import LabError
from tests.app.fakes import FakeClient, FakeHandle

SLOW, QUICK = (Entry(Path(f"{name}.py"), 1, name, "Why?") for name in ("slow", "quick"))


class TwoClicks:
    """A library in which both lessons have an error; while the first is rehearsed, the second is clicked on."""

    def rehearse(self, file: Path, robot: str) -> None:
        if file == SLOW.file:
            self.panel._open(QUICK)
        raise LabError(f"{file} is wrong")


def nothing(*_: object) -> None:
    return None


def test_an_error_of_a_lesson_that_was_left_does_not_take_the_place_of_another():
    client, library, truth = FakeClient(), TwoClicks(), SimpleNamespace(robot="g1")
    panel = LearnPanel(client, FakeHandle(), library, nothing, nothing, nothing, nothing, nothing, truth)
    library.panel = panel
    panel._open(SLOW)
    shown = [handle.content for handle in client.gui.html if "is wrong" in handle.content]
    assert len(shown) == 1
    assert "quick.py is wrong" in shown[0]
