"""The order in which tests begin: no name in it is out of date, and everything of the browser stays together."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.order import BROWSER, FIGURES, LONGEST, begin_first, file_of, scope_of

ROOT = Path(__file__).resolve().parent.parent


@pytest.mark.parametrize("name", [BROWSER, *LONGEST])
def test_what_begins_early_is_there(name: str) -> None:
    assert (ROOT / name).exists()


def test_files_that_share_their_runs_share_a_process() -> None:
    folder = ROOT / "tests" / "experiments"
    sharing = {path.name for path in folder.glob("test_*.py") if "experiments.played" in path.read_text()}
    assert {Path(name).name for name in FIGURES} == sharing
    assert len({scope_of(f"{name}::test_it") for name in FIGURES}) == 1
    assert (
        scope_of("tests/browser/test_lab.py::test_it")
        == scope_of("tests/browser/test_runs.py::test_it")
        == BROWSER
    )
    assert scope_of("tests/test_order.py::test_it") == "tests/test_order.py"


def test_none_is_lost_and_long_files_begin_before_short_ones(request: pytest.FixtureRequest) -> None:
    items = list(request.session.items)[::-1]
    begin_first(items)
    assert set(items) == set(request.session.items)
    begun = list(dict.fromkeys(file_of(item) for item in items))
    quiet = {file_of(item) for item in items if item.get_closest_marker("quiet")}
    browser = [name for name in begun if name.startswith(BROWSER) and name not in quiet]
    long = [name for name in LONGEST if name in begun and name not in quiet]
    first = len(quiet) + len(browser) + len(long)
    assert set(begun[: len(quiet)]) == quiet
    assert begun[len(quiet) : first] == [*browser, *long]


def test_only_what_happens_in_real_time_has_a_second_try(request: pytest.FixtureRequest) -> None:
    again = {file_of(item) for item in request.session.items if item.get_closest_marker("flaky")}
    assert all(name.startswith(("tests/browser/", "tests/app/")) for name in again)
    assert "tests/test_order.py" not in again
