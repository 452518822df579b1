"""Where the files live that ship with the package: robots, scenarios, lessons, images."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def _shipped(name: str) -> Path:
    """The folder inside an installed wheel, or the one beside the package in a source tree."""
    installed = _PACKAGE / f"_{name}"
    return installed if installed.is_dir() else _PACKAGE.parent / name


ASSETS = _shipped("assets")
LESSONS = _shipped("lessons")
