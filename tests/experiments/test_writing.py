from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from momentum_lab.errors import InputError
from momentum_lab.experiments.canvas import canvas
from momentum_lab.experiments.writing import paths, writable_folder, write

TABLE = {"time [s]": np.array([0.0, 0.25]), "who": ["a", "b"]}


def picture() -> object:
    return canvas("title", 1, 1, (2.0, 2.0))[0]


class Unpaintable:
    def savefig(self, path: Path, **_settings: object) -> None:
        path.write_bytes(b"half a pict")
        raise OSError(28, "No space left on device")


def test_all_three_files_are_written_and_nothing_else(tmp_path: Path) -> None:
    write(tmp_path, "x", picture(), TABLE, {"holds": True, "value": float("nan")})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.csv", "x.json", "x.png"]
    image, numbers, words = paths(tmp_path, "x")
    assert image.read_bytes().startswith(b"\x89PNG")
    with numbers.open(newline="") as file:
        assert list(csv.reader(file)) == [["time [s]", "who"], ["0", "a"], ["0.25", "b"]]
    assert json.loads(words.read_text()) == {"holds": True, "value": None}


def test_same_content_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write(tmp_path / name, "x", picture(), TABLE, {})
    for first, second in zip(paths(tmp_path / "a", "x"), paths(tmp_path / "b", "x"), strict=True):
        assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize(
    ("image", "table"),
    [(Unpaintable(), TABLE), (picture(), {"a": [1.0], "b": [1.0, 2.0]})],
    ids=["full disk", "ragged table"],
)
def test_what_was_there_stays_when_writing_fails(tmp_path: Path, image: object, table: dict) -> None:
    for path in paths(tmp_path, "x"):
        path.write_text("before")
    with pytest.raises((InputError, ValueError)):
        write(tmp_path, "x", image, table, {})
    assert sorted(path.name for path in tmp_path.iterdir()) == ["x.csv", "x.json", "x.png"]
    assert {path.read_text() for path in tmp_path.iterdir()} == {"before"}


def test_folder_is_made(tmp_path: Path) -> None:
    assert writable_folder(tmp_path / "a" / "b", "x").is_dir()


def test_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"out: got .*file; allowed: a folder that can be written"):
        writable_folder(tmp_path / "file", "x")
