"""Keys: each does one thing, and a key that is held down does it once."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from momentum_lab.app import keys
from momentum_lab.app.keys import add_keys
from momentum_lab.events import Reset, StepOnce
from tests.app.fakes import FakeClient, FakeHandle


class Desk:
    """A client that takes commands, and everything they do."""

    def __init__(self) -> None:
        self.client, self.done = FakeClient(), []
        self.commands: dict[str, tuple[str | None, Callable]] = {}
        self.client.gui.add_command = self._add_command
        note = self.done.append
        push = FakeHandle(
            apply=lambda: note("push"), apply_again=lambda: note("again"), ask=lambda: note("ask")
        )
        runs = FakeHandle(
            keep=lambda: note("keep"),
            run_again=lambda: note("same pushes"),
            toggle_ghost=lambda: note("ghost"),
        )
        status = FakeHandle(toggle=lambda: note("toggle"))
        tabs = FakeHandle(open=lambda index: note(f"tab {index}"))
        hand = FakeHandle(toggle=lambda: note("drag pushes"), give_up=lambda: note("give up"))
        colours = FakeHandle(toggle=lambda: note("dark or light"))
        add_keys(self.client, note, push.apply, push, status, tabs, runs, hand, colours)

    def _add_command(self, label: str, hotkey: str | None = None, modifier: str = "") -> FakeHandle:
        command = FakeHandle()
        key = hotkey and modifier + hotkey
        command.on_trigger = lambda act: self.commands.update({label: (key, act)})
        return command

    def press(self, key: str) -> None:
        next(act for hotkey, act in self.commands.values() if hotkey == key)(None)


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_what_each_key_does(desk):
    for key in (*"PKJLR12345FMNGTZC", "shiftZ"):
        desk.press(key)
    assert desk.done == [
        "push",
        "toggle",
        StepOnce(1),
        StepOnce(20),
        Reset(),
        *(f"tab {i}" for i in range(5)),
        "ask",
        "keep",
        "same pushes",
        "ghost",
        "drag pushes",
        "give up",
        "dark or light",
        "give up",
    ]


def test_no_key_is_used_twice_and_none_that_widgets_need(desk):
    hotkeys = [hotkey for hotkey, _ in desk.commands.values() if hotkey]
    assert len(set(hotkeys)) == len(hotkeys)
    assert not set(hotkeys) & set("WASDQE")
    assert set(hotkeys) == {*"PKJLRB12345FMNGHTZC", "shiftZ"}


def test_a_key_that_is_held_down_acts_once(desk, monkeypatch):
    now = 100.0
    monkeypatch.setattr(keys.time, "monotonic", lambda: now)
    for _ in range(50):
        desk.press("P")
        now += 0.033
    assert desk.done == ["push"]
    now += 0.5
    desk.press("P")
    assert desk.done == ["push", "push"]


def test_help_opens_once_and_its_key_closes_it(monkeypatch):
    opened: list[FakeHandle] = []

    def add_modal(_title: str) -> FakeHandle:
        modal = FakeHandle()
        modal.close = modal.remove
        opened.append(modal)
        return modal

    monkeypatch.setattr(keys, "_REPEATED", -1.0)
    desk = Desk()
    desk.client.gui.add_modal, desk.client.gui.add_markdown = add_modal, lambda text: FakeHandle(text=text)
    press = desk.commands["Help"][1]
    for shown in (True, False, True):
        press(None)
        assert [not modal.removed for modal in opened][-1] == shown
    desk.client.gui.widgets["Close  (H)"].set_by_person(True)
    assert all(modal.removed for modal in opened)
    assert len(opened) == 2
