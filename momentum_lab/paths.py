"""Where the files live that ship with the package: robots, scenarios, lessons, images."""

from __future__ import annotations

import os
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def _shipped(name: str) -> Path:
    """The folder inside an installed wheel, or the one beside the package in a source tree."""
    installed = _PACKAGE / f"_{name}"
    return installed if installed.is_dir() else _PACKAGE.parent / name


ASSETS = _shipped("assets")
LESSONS = _shipped("lessons")


def config_folder() -> Path:
    """Where a person's own settings live: $XDG_CONFIG_HOME/momentum_lab, or ~/.config/momentum_lab."""
    base = os.environ.get("XDG_CONFIG_HOME")
    return (Path(base) if base else Path.home() / ".config") / "momentum_lab"
