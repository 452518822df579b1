"""Compiled functions: kept between runs, renewed with their sources, never compiled on the way."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from momentum_lab.compiled import version_of
from momentum_lab.momentum.wrench import cross

SCRIPT = "import momentum_lab.cholesky as c; print(sum(c.factorize.stats.cache_hits.values()))"


def run(cache: Path) -> str:
    """What a fresh process prints about the compiled code it has found."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(cache)}
    environment.pop("NUMBA_CACHE_DIR", None)
    result = subprocess.run(
        [sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True
    )
    return result.stdout.strip() + result.stderr


def test_compiled_code_is_kept_between_runs(tmp_path):
    assert run(tmp_path) == "0"
    assert run(tmp_path) == "1"


def test_without_a_place_to_keep_it_the_code_still_runs(tmp_path):
    (tmp_path / "file").touch()
    assert run(tmp_path / "file") == "0"


def test_any_change_of_a_source_is_another_version():
    sources = {"a.py": b"one", "b.py": b"two"}
    assert version_of(sources) == version_of(dict(sources))
    assert version_of(sources) != version_of({**sources, "b.py": b"three"})
    assert version_of(sources) != version_of({"a.py": b"one", "c.py": b"two"})


def test_other_types_are_refused_rather_than_compiled():
    with pytest.raises(TypeError, match="No matching definition"):
        cross(np.zeros(3, dtype=np.float32), np.zeros(3))
