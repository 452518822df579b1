"""Numba for the small dense loops of a tick: compiled once per version of this package, then read from a cache.

Whole arrays of a hundred numbers are too short for numpy: a call costs more than its arithmetic. A compiled
function is the only implementation of what it computes, is called with the arrays it declares, and refuses any
other type, so that nothing is ever compiled while a simulation runs.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

_HERE = Path(__file__).parent


def compiled(signature: str) -> Callable[[FunctionT], FunctionT]:
    """Compile a function for one signature, such as "f8[::1](f8[:, ::1], f8[::1])", when its module is loaded.

    Sums may be reordered into vector registers; NaN and infinity keep their meaning.
    """
    return numba.njit(signature, cache=_CACHED, error_model="numpy", fastmath={"reassoc", "contract"})


def _cache_folder() -> Path:
    """A folder that changes with any file of this package: numba does not see a change in what a function calls."""
    stamps = [
        (file.name, file.stat().st_mtime_ns, file.stat().st_size) for file in sorted(_HERE.rglob("*.py"))
    ]
    version = hashlib.sha256(repr((str(_HERE), numba.__version__, stamps)).encode()).hexdigest()[:16]
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(home) / "momentum-lab" / version


def _use_cache() -> bool:
    """Whether compiled code can be kept between runs."""
    if not numba.config.CACHE_DIR:
        numba.config.CACHE_DIR = str(_cache_folder())
    try:
        Path(numba.config.CACHE_DIR).mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(numba.config.CACHE_DIR, os.W_OK)


_CACHED = _use_cache()
