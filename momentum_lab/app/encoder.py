"""Pictures into a film by ffmpeg, the program that does this everywhere; the lab does without where there is none."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

import numpy as np

from momentum_lab.errors import InputError

Write = Callable[[np.ndarray], None]

# How long it may take to finish a file after the last picture, s.
_PATIENCE = 120.0


def ffmpeg() -> str:
    """The path of ffmpeg.

    Raises:
        InputError: there is none on the PATH.
    """
    program = shutil.which("ffmpeg")
    if program is None:
        raise InputError(
            "film",
            "no ffmpeg on the lab's machine",
            "one on its PATH: apt install ffmpeg, brew install ffmpeg",
        )
    return program


@contextmanager
def encoder(path: Path, size: tuple[int, int], rate: float) -> Iterator[Write]:
    """A function that takes the film's pictures (h, w, 3), uint8, one after the other; then the film is complete.

    Args:
        path: where the .mp4 goes.
        size: width and height of every picture, both even.
        rate: pictures per second.

    Raises:
        InputError: there is no ffmpeg, or it could not make the film.
    """
    with tempfile.TemporaryFile() as complaints:
        process = subprocess.Popen(
            [ffmpeg(), *_arguments(path, size, rate)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=complaints,
        )
        assert process.stdin is not None
        # A pipe that breaks is no news: what ffmpeg has to say about that is read below.
        try:
            with suppress(BrokenPipeError, subprocess.TimeoutExpired):
                yield lambda picture: _write(process, picture)
                process.stdin.close()
                process.wait(_PATIENCE)
        finally:
            process.kill()
            with suppress(BrokenPipeError):
                process.stdin.close()
            code = process.wait()
        if code != 0:
            raise InputError(
                "film", f"an ffmpeg that failed: {_last_line(complaints)}", "one that writes .mp4"
            )


def _write(process: subprocess.Popen[bytes], picture: np.ndarray) -> None:
    assert process.stdin is not None
    process.stdin.write(np.ascontiguousarray(picture, dtype=np.uint8).tobytes())


def _arguments(path: Path, size: tuple[int, int], rate: float) -> list[str]:
    """Raw pictures in; a film out that every player shows and that begins before all of it has been loaded."""
    width, height = size
    pictures = [
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-s",
        f"{width}x{height}",
        "-r",
        f"{rate:g}",
        "-i",
        "-",
    ]
    return [
        "-loglevel",
        "error",
        "-y",
        *pictures,
        "-pix_fmt",
        "yuv420p",
        "-movflags",
        "+faststart",
        str(path),
    ]


def _last_line(file: IO[bytes]) -> str:
    file.seek(0)
    lines = file.read().decode(errors="replace").split("\n")
    return next((line.strip() for line in reversed(lines) if line.strip()), "it said nothing")
