"""How far a learner has come, kept by the browser: it is still there when the page is loaded again."""

from __future__ import annotations

import contextlib
from typing import Annotated

import msgspec
import viser

# A browser that draws its first pictures in software answers late; one that has not answered by then will not, s.
_PATIENCE = 30.0
_PREFIX = "lesson "


class Progress(msgspec.Struct, frozen=True):
    """How far a learner has come in one lesson.

    Attributes:
        step: the step that was open, from 0.
        done: whether the lesson has been finished once.
        answers: step -> what was predicted: the place of an option, or a number.
    """

    step: Annotated[int, msgspec.Meta(ge=0, le=1000)] = 0
    done: bool = False
    answers: dict[int, float] = {}


class ProgressStore:
    """The progress of one browser, lesson by lesson.

    Args:
        client: the browser tab.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client
        self._known: dict[str, Progress] = {}

    def load(self, keys: list[str]) -> bool:
        """Ask the browser for the progress in some lessons; whether it knows of any."""
        with contextlib.suppress(
            RuntimeError, TimeoutError
        ):  # the tab has gone, or its browser keeps nothing
            for key in keys:
                text = self._client.local_storage.get_item(_PREFIX + key, timeout=_PATIENCE)
                self._known[key] = _progress(text)
        return any(progress != Progress() for progress in self._known.values())

    def get(self, key: str) -> Progress:
        """The progress in a lesson."""
        return self._known.get(key, Progress())

    def set(self, key: str, progress: Progress) -> None:
        """Keep the progress in a lesson; none at all never replaces what a browser has not told."""
        if progress != self.get(key):
            self._known[key] = progress
            self._client.local_storage.set_item(_PREFIX + key, msgspec.json.encode(progress).decode())


def _progress(text: str | None) -> Progress:
    """What the browser has kept; anything else than progress, whoever wrote it there, is none."""
    try:
        return msgspec.json.decode(text or "{}", type=Progress)
    except msgspec.DecodeError:
        return Progress()
