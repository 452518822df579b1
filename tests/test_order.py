"""The order in which tests begin: no name in it is out of date, and everything of the browser stays together."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.order import BROWSER, LONGEST, begin_first, file_of

ROOT = Path(__file__).resolve().parent.parent


@pytest.mark.parametrize("name", [BROWSER, *LONGEST])
def test_what_begins_early_is_there(name: str) -> None:
    assert (ROOT / name).exists()


def test_files_stay_whole_and_none_is_lost(request: pytest.FixtureRequest) -> None:
    items = list(request.session.items)
    begin_first(items)
    assert set(items) == set(request.session.items)
    files = [file_of(item) for item in items]
    begun = [name for name, before in zip(files, ["", *files], strict=False) if name != before]
    assert len(begun) == len(set(files))
