"""Numba for the small dense loops of a tick: compiled once per version of this package, then read from a cache.

Whole arrays of a hundred numbers are too short for numpy: a call costs more than its arithmetic. A compiled
function is the only implementation of what it computes, is called with the arrays it declares, and refuses any
other type, so that nothing is ever compiled while a simulation runs.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

_PACKAGE = Path(__file__).parent
_MARK = b"import compiled"
# Compiled code of other versions is thrown away when it is older than this, s.
_KEPT = 30 * 24 * 3600.0


def compiled(signature: str) -> Callable[[FunctionT], FunctionT]:
    """Compile a function for one signature, such as "f8[::1](f8[:, ::1], f8[::1])", when its module is loaded.

    Sums may be reordered into vector registers; NaN and infinity keep their meaning.
    """
    return numba.njit(signature, cache=_CACHED, error_model="numpy", fastmath={"reassoc", "contract"})


def version_of(sources: dict[str, bytes]) -> str:
    """A name for the compiled code of some files, by their names and contents.

    Numba looks at the file of a function only, not at those of the functions it calls; this looks at all.
    """
    parts = (numba.__version__, sys.version, *(f"{name}\0{hash_of(text)}" for name, text in sources.items()))
    return hash_of("\0".join(parts).encode())[:16]


def hash_of(text: bytes) -> str:
    """SHA-256 in hexadecimal digits."""
    return hashlib.sha256(text).hexdigest()


def _sources() -> dict[str, bytes]:
    """The files of this package that compile something, by name."""
    texts = {str(path.relative_to(_PACKAGE)): path.read_bytes() for path in sorted(_PACKAGE.rglob("*.py"))}
    return {name: text for name, text in texts.items() if _MARK in text or name == Path(__file__).name}


def _use_cache() -> bool:
    """Point numba to a folder that keeps compiled code between runs; whether there is one."""
    try:
        if not numba.config.CACHE_DIR:
            numba.config.CACHE_DIR = str(_own_folder())
        folder = Path(numba.config.CACHE_DIR)
        if not folder.exists():
            folder.mkdir(parents=True, exist_ok=True)
            _announce()
    except (OSError, RuntimeError):  # no place to write, or no home at all
        return False
    return os.access(folder, os.W_OK)


def _own_folder() -> Path:
    """The folder of this version, among those of others, the oldest of which go."""
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "momentum-lab"
    _forget_old_versions(home)
    return home / version_of(_sources())


def _announce() -> None:
    """Tell a person at a terminal what the first start of a version waits for."""
    if sys.stderr.isatty():
        print("momentum-lab compiles its numerical loops: once, for about half a minute", file=sys.stderr)


def _forget_old_versions(home: Path) -> None:
    """Remove folders that have the name of a version and are old; nothing else is ours."""
    for folder in home.glob("[0-9a-f]" * 16):
        if time.time() - folder.stat().st_mtime > _KEPT:
            shutil.rmtree(folder, ignore_errors=True)


_CACHED = _use_cache()
