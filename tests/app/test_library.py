"""The list of lessons, and rehearsals in a process of their own."""

from __future__ import annotations

import os
import re
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from momentum_lab.app import apart, library
from momentum_lab.app.library import Library
from momentum_lab.errors import LabError
from momentum_lab.lesson.loader import lesson_files
from momentum_lab.lesson.record import rehearsed
from tests.test_lesson import line_of, written

SHORT = ('"seconds": 2.0', '"seconds": 0.45')


def test_every_lesson_is_in_the_list_with_its_question() -> None:
    entries = Library().entries()
    assert [entry.file for entry in entries] == lesson_files()
    assert all(entry.question.endswith("?") and not entry.error for entry in entries)


def test_lesson_that_is_no_python_is_in_the_list_with_its_error(tmp_path: Path) -> None:
    path = written(tmp_path, ("STEPS = (", "STEPS = = ("))
    (entry,) = Library(tmp_path).entries()
    assert entry.title == path.name
    assert entry.error.startswith(f"{path}:{line_of(path, 'STEPS = = (')}: got ")


def test_list_is_marked_once_the_scripts_have_been_loaded(tmp_path: Path) -> None:
    path = written(tmp_path, ("CLAIMS = (", "CLAIMED = ("))
    written(tmp_path).rename(tmp_path / "02_sound.py")
    written(tmp_path, ("RUNS =", "import os; os._exit(3)\nRUNS =")).rename(tmp_path / "03_ends.py")
    written(tmp_path, ("CLAIMS = (", "CLAIMED = ("))
    lessons = Library(tmp_path)
    assert not any(entry.error for entry in lessons.entries())
    first, sound, last = lessons.look_through()
    assert re.match(rf"{re.escape(str(path))}:\d+: got no CLAIMS", first.error)
    assert (first.title, sound.error) == ("Leaning in", "")
    assert "got exit code 3; allowed: a script that runs" in last.error
    assert lessons.entries() == [first, sound, last]


def test_script_that_has_been_mended_is_marked_no_more(tmp_path: Path) -> None:
    path = written(tmp_path, ("CLAIMS = (", "CLAIMED = ("))
    lessons = Library(tmp_path)
    assert lessons.look_through()[0].error
    os.utime(written(tmp_path), ns=(0, path.stat().st_mtime_ns + 1))
    assert [entry.error for entry in lessons.look_through()] == [""]


def test_rehearsal_shows_what_a_run_without_a_screen_shows(tmp_path: Path) -> None:
    path = written(tmp_path, SHORT)
    lessons = Library(tmp_path)
    found = lessons.rehearse(path, "g1")
    assert found == rehearsed(str(path), "g1")
    assert lessons.rehearse(path, "g1") is found
    assert [step.kind for step in found.steps] == ["choice", "play", "compare", "explain"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (('runs["push"].pushes[0]', 'runs["pusch"].pushes[0]'), "got KeyError: 'pusch'"),
        (("CLAIMS = (", "CLAIMED = ("), "got no CLAIMS"),
        (('"seconds": 2.0', '"gains": {"linear_dampng": 8.0}'), "got gain linear_dampng"),
        (("RUNS =", "import os; os._exit(3)\nRUNS ="), "got exit code 3; allowed: a script that runs"),
    ],
)
def test_whatever_is_wrong_is_told_with_file_and_line(tmp_path: Path, change: tuple, words: str) -> None:
    path = written(tmp_path, SHORT, change) if change[0] != SHORT[0] else written(tmp_path, change)
    with pytest.raises(LabError, match=rf"01_leaning_in\.py:\d+: {re.escape(words)}"):
        Library(tmp_path).rehearse(path, "g1")


def test_script_that_never_ends_is_given_up_and_keeps_nobody_from_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sound = written(tmp_path, SHORT).rename(tmp_path / "02_sound.py")
    path = written(tmp_path, ("RUNS =", "while True: pass\nRUNS ="))
    lessons = Library(tmp_path)
    record = lessons.rehearse(sound, "g1")
    begun, went_on = threading.Event(), []

    def rehearsed_meanwhile(file: Path, robot: str) -> object:
        begun.set()
        went_on.append(meanwhile.result(10.0) is record)
        return apart.rehearsed_apart(file, robot)

    monkeypatch.setattr(library, "rehearsed_apart", rehearsed_meanwhile)
    monkeypatch.setattr(apart, "_PATIENCE", 0.5)
    with ThreadPoolExecutor() as pool:
        meanwhile = pool.submit(lambda: begun.wait() and lessons.rehearse(sound, "g1"))
        with pytest.raises(LabError, match=r"01_leaning_in\.py:1: got no end within 0\.5 s"):
            lessons.rehearse(path, "g1")
    assert went_on == [True]


def test_script_that_has_gone_is_told(tmp_path: Path) -> None:
    with pytest.raises(LabError, match=r"02_gone\.py: got nothing"):
        Library(tmp_path).rehearse(tmp_path / "02_gone.py", "g1")
