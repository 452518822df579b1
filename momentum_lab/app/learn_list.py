"""The pages of the lessons' panel outside a lesson: the list with its progress, the waiting, an error."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import viser

from momentum_lab.app import learn_html
from momentum_lab.app.library import Entry
from momentum_lab.app.progress import Progress, ProgressStore


def list_page(
    gui: viser.GuiApi, entries: Sequence[Entry], store: ProgressStore, choose: Callable[[Entry], None]
) -> None:
    """The list of lessons.

    Args:
        gui: where it goes.
        entries: the lessons.
        store: what has been done of them.
        choose: told the one that a person wants.
    """
    done = sum(store.get(entry.key).done for entry in entries)
    broken = sum(bool(entry.error) for entry in entries)
    gui.add_html(learn_html.welcome(done, len(entries), broken))
    for entry in entries:
        _add_entry(gui, entry, store.get(entry.key), choose)


def waiting_page(gui: viser.GuiApi, entry: Entry) -> None:
    """While a lesson is being prepared."""
    gui.add_html(learn_html.waiting(entry.title))
    gui.add_progress_bar(100.0, animated=True)


def error_page(
    gui: viser.GuiApi, words: str, again: Callable[[], None] | None, leave: Callable[[], None]
) -> None:
    """What is wrong with a lesson, and the ways on."""
    gui.add_html(learn_html.error(words))
    button = gui.add_button("Try again", color="gray", icon=viser.Icon.RELOAD)
    if again is not None:
        button.on_click(lambda _: again())
    gui.add_button("All lessons", color="gray", icon=viser.Icon.LIST).on_click(lambda _: leave())


def _add_entry(gui: viser.GuiApi, entry: Entry, progress: Progress, choose: Callable[[Entry], None]) -> None:
    icon = viser.Icon.CIRCLE
    if entry.error:
        icon = viser.Icon.ALERT_TRIANGLE
    elif progress.done:
        icon = viser.Icon.CIRCLE_CHECK
    elif progress.step or progress.answers:
        icon = viser.Icon.PROGRESS
    title = f"{entry.number}. {entry.title}" + (" · has an error" if entry.error else "")
    button = gui.add_button(title, color="gray", icon=icon, hint=entry.error or entry.question)
    button.on_click(lambda _: choose(entry))
