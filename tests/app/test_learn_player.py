"""A step that says from where it wants to be looked at turns the camera, and no other step does."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from momentum_lab.app.learn_player import LessonPlayer
from momentum_lab.app.lesson_wire import OfferRun
from momentum_lab.app.progress import Progress
from momentum_lab.lesson.record import rehearsed
from tests.app.fakes import FakeGui
from tests.test_lesson import written


class Frame:
    """A frame that shows nothing."""

    @contextlib.contextmanager
    def fresh(self) -> Iterator[None]:
        yield

    def head(self, walk: Any) -> None:
        pass

    show = head


class Store(dict):
    """A browser that forgets nothing."""

    def get(self, key: str) -> Progress:
        return super().get(key, Progress())

    set = dict.__setitem__


def opened(path: Path, asked: list[object], looks: list[str], gui: FakeGui | None = None) -> LessonPlayer:
    record = rehearsed(str(path), "g1")

    def answer(place: int, read: Callable[[], float]) -> None:
        player.answer(place, read())

    desk = (gui or FakeGui(), asked.append, asked.append, looks.append, answer, lambda: None)
    player = LessonPlayer(record, "one", Store(), Frame(), *desk)
    player.start()
    return player


def test_the_camera_is_turned_where_a_step_says_so(tmp_path: Path) -> None:
    asked, looks = [], []
    front = written(tmp_path, ('fness")', 'fness"), view="Front"'), ('"seconds": 2.0', '"seconds": 0.4'))
    player = opened(front, asked, looks)
    assert player.turns
    assert looks == []
    player.answer(0, 0.0)
    player.forward()
    assert looks == ["Front"]
    assert asked == [OfferRun("push")]  # what is put on stage later is looked at from there, too
    player.forward()
    assert looks == ["Front"]


def test_a_lesson_without_a_view_leaves_the_camera_alone(tmp_path: Path) -> None:
    looks: list[str] = []
    player = opened(written(tmp_path, ('"seconds": 2.0', '"seconds": 0.4')), [], looks)
    player.answer(0, 0.0)
    player.forward()
    assert not player.turns
    assert looks == []


def test_a_number_that_nobody_has_heard_of_yet_is_the_prediction(tmp_path: Path) -> None:
    """Who types 63 and goes on at once: the key may be told before the number."""
    number = 'STEPS = (\n    lab.Number("How far does it go?", "way", 0, 100),'
    gui = FakeGui()
    player = opened(
        written(tmp_path, ("STEPS = (", number), ('"seconds": 2.0', '"seconds": 0.4')), [], [], gui
    )
    slider = gui.widgets["I predict (mm)"]
    player.forward()
    assert player._walk.place == 0  # nobody has predicted anything
    slider.set_by_person(6.0)
    slider.value = 63.0
    player.forward()
    assert player._walk.answers == {0: 63.0}
    assert player._walk.place == 1
