"""What a browser keeps about a learner."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from momentum_lab.app.progress import Progress, ProgressStore


class Storage:
    """A browser's local storage."""

    def __init__(self, items: dict[str, str] | None = None, error: Exception | None = None) -> None:
        self.items, self._error = items or {}, error

    def get_item(self, key: str, timeout: float) -> str | None:
        if self._error is not None:
            raise self._error
        return self.items.get(key)

    def set_item(self, key: str, value: str) -> None:
        self.items[key] = value


def test_progress_is_there_after_a_reload() -> None:
    storage = Storage()
    before = ProgressStore(SimpleNamespace(local_storage=storage))
    before.set("07_a_larger_push", Progress(3, True, {1: 2.0, 2: -78.5}))
    after = ProgressStore(SimpleNamespace(local_storage=storage))
    after.load(["07_a_larger_push", "08_other"])
    assert after.get("07_a_larger_push") == Progress(3, True, {1: 2.0, 2: -78.5})
    assert after.get("08_other") == Progress()


@pytest.mark.parametrize("text", ["no json", '{"step": -1}', '{"step": 1e9}', '{"answers": 7}', "[]"])
def test_what_the_lab_has_not_written_counts_as_nothing(text: str) -> None:
    store = ProgressStore(SimpleNamespace(local_storage=Storage({"lesson a": text})))
    store.load(["a"])
    assert store.get("a") == Progress()


@pytest.mark.parametrize("error", [RuntimeError("blocked"), TimeoutError("silent")])
def test_browser_that_keeps_nothing_is_no_error(error: Exception) -> None:
    store = ProgressStore(SimpleNamespace(local_storage=Storage(error=error)))
    store.load(["a"])
    assert store.get("a") == Progress()


def test_what_a_silent_browser_keeps_is_not_replaced_by_nothing() -> None:
    storage = Storage({"lesson a": '{"step": 3}'}, TimeoutError("busy"))
    store = ProgressStore(SimpleNamespace(local_storage=storage))
    store.load(["a"])
    store.set("a", Progress())
    assert storage.items == {"lesson a": '{"step": 3}'}
    store.set("a", Progress(1))
    assert store.get("a") == Progress(1)
    assert storage.items != {"lesson a": '{"step": 3}'}
