"""Scripts without an end are given up, whatever they do against it, and the others are still listed."""

from __future__ import annotations

import json
import re
import signal
from pathlib import Path

import pytest

from momentum_lab.cli import listing, main
from momentum_lab.errors import LessonError
from momentum_lab.lesson.loader import load_lesson
from momentum_lab.lesson.reading import read_lesson
from tests.test_lesson import line_of, written

LOOPS = {
    "while True: pass": "while True",
    "import time\nwhile True:\n    try:\n        time.sleep(9)\n    except Exception:\n        pass": "sleep",
}


@pytest.mark.parametrize("loop", LOOPS)
def test_a_script_without_an_end_is_given_up_where_it_is(tmp_path: Path, loop: str) -> None:
    path = written(tmp_path, ("RUNS =", f"{loop}\nRUNS ="))
    line = line_of(path, LOOPS[loop])
    words = (
        rf"{re.escape(str(path))}:{line}: got no end within 0\.3 s; allowed: a script that comes to its end"
    )
    with pytest.raises(LessonError, match=words):
        read_lesson(path, 0.3)


def test_a_script_with_an_end_is_the_lesson_and_no_alarm_is_left(tmp_path: Path) -> None:
    path, before = written(tmp_path), signal.getsignal(signal.SIGALRM)
    assert read_lesson(path).title == load_lesson(path).title == "Leaning in"
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    assert signal.getsignal(signal.SIGALRM) is before


def test_the_list_goes_on_after_a_script_without_an_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    written(tmp_path, ("RUNS =", "while True: pass\nRUNS ="))
    written(tmp_path).rename(tmp_path / "02_sound.py")
    written(tmp_path, ("RUNS =", "while True: pass\nRUNS ="))
    monkeypatch.setattr(listing, "read_lesson", lambda path: read_lesson(path, 0.3))
    assert main(["list", "lessons", "--lessons", str(tmp_path), "--json"]) == 2
    said = capsys.readouterr()
    assert [lesson["name"] for lesson in json.loads(said.out)] == ["02_sound"]
    assert "01_leaning_in.py" in said.err
    assert "no end within 0.3 s" in said.err
