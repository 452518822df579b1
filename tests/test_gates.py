"""The same gates for every machine: style, formatting, types."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

GATES = {
    "style": ["ruff", "check", "momentum_lab", "tests"],
    "formatting": ["ruff", "format", "--check", "momentum_lab", "tests"],
    "types": ["mypy", "--no-error-summary"],
}


@pytest.mark.parametrize("gate", GATES)
def test_gate(gate: str) -> None:
    result = subprocess.run(
        [sys.executable, "-m", *GATES[gate]], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr
