"""The files of a figure: picture, table and claims, all of them or none."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from momentum_lab.errors import InputError
from momentum_lab.experiments.claims import Columns
from momentum_lab.trace import writable_file

_DOTS_PER_INCH = 120


def writable_folder(folder: Path, name: str) -> Path:
    """The folder, made if it is not there, if the files of a figure can be written into it.

    Raises:
        InputError: they cannot.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError("out", folder, f"a folder that can be written ({error.strerror})") from error
    for path in paths(folder, name):
        writable_file(path)
    return folder


def paths(folder: Path, name: str) -> tuple[Path, Path, Path]:
    """Where picture, table and claims of a figure go."""
    return folder / f"{name}.png", folder / f"{name}.csv", folder / f"{name}.json"


def write(folder: Path, name: str, picture: Any, table: Columns, report: dict[str, Any]) -> None:
    """Write all three files under names that nothing has yet, then put them in their places.

    Raises:
        InputError: a file cannot be written; those that were there before are as they were.
    """
    writers: tuple[Callable[[Path], None], ...] = (
        lambda path: _write_picture(path, picture),
        lambda path: _write_table(path, table),
        lambda path: _write_report(path, report),
    )
    with ExitStack() as cleaning:
        try:
            made = []
            for target, writer in zip(paths(folder, name), writers, strict=True):
                temporary = folder / f".{uuid4().hex}.part"
                cleaning.callback(temporary.unlink, missing_ok=True)
                writer(temporary)
                made.append((temporary, target))
            for temporary, target in made:
                temporary.replace(target)
        except OSError as error:
            raise InputError("out", folder, f"a folder that can be written ({error.strerror})") from error


def _write_picture(path: Path, picture: Any) -> None:
    # Without the name of the software in it, the same run gives the same bytes.
    picture.savefig(path, format="png", dpi=_DOTS_PER_INCH, metadata={"Software": None})


def _write_table(path: Path, table: Columns) -> None:
    with path.open("x", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(table)
        for row in zip(*table.values(), strict=True):
            writer.writerow([_cell(value) for value in row])


def _cell(value: Any) -> str:
    return f"{value:.9g}" if isinstance(value, float | np.floating) else str(value)


def _write_report(path: Path, report: dict[str, Any]) -> None:
    path.write_text(json.dumps(_finite(report), indent=2, allow_nan=False) + "\n", encoding="utf-8")


def _finite(value: Any) -> Any:
    """The same data with null for numbers that JSON cannot say."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
