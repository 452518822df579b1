"""A recording on disk: one .npz file with every tick, written whole or not at all."""

from __future__ import annotations

import json
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO
from uuid import uuid4
from zipfile import BadZipFile

import numpy as np

from momentum_lab.control.controller import SLACKS
from momentum_lab.errors import InputError
from momentum_lab.recording import Recording

SECOND = "second/"
"""What the names of the second robot's arrays, and of its columns in a table, begin with."""


@dataclass(frozen=True)
class Trace:
    """A recording that has been saved.

    Attributes:
        columns: name -> quantity over time (n, *shape).
        joint_names: the actuated joints.
        foot_names: the feet.
        meta: versions, scenario, gains, seed, robot description.
        second: the same quantities of a robot beside the first, over its own time; empty without one.
    """

    columns: dict[str, np.ndarray]
    joint_names: tuple[str, ...]
    foot_names: tuple[str, ...]
    meta: dict[str, Any]
    second: dict[str, np.ndarray] = field(default_factory=dict)


def writable_file(path: Path) -> Path:
    """The path, if a file can be written there; nothing is left behind by the question.

    Raises:
        InputError: its folder does not exist or cannot be written, or something that is no file is there.
    """
    try:
        if path.exists() and not path.is_file():
            raise InputError("out", path, "the path of a file")
        temporary = _beside(path)
        temporary.touch(exist_ok=False)
        temporary.unlink()
    except OSError as error:
        raise _not_writable(path, error) from error
    return path


def save_trace(
    recording: Recording, meta: dict[str, Any], path: Path, second: Recording | None = None
) -> None:
    """Write a recording as .npz, whole or not at all, under exactly the given name.

    Args:
        recording: what happened.
        meta: what the trace says about it.
        path: where.
        second: of the robot beside the first; None: there is none.

    Raises:
        InputError: the file cannot be written there.
    """
    temporary = _beside(writable_file(path))
    try:
        with temporary.open("xb") as file:
            write_trace(recording, meta, file, second)
        temporary.replace(path.resolve())
    except OSError as error:
        raise _not_writable(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)


def write_trace(
    recording: Recording, meta: dict[str, Any], file: BinaryIO, second: Recording | None = None
) -> None:
    """Write a recording as .npz into an open file; the arrays of a second robot are named `second/com` and so on."""
    arrays: dict[str, Any] = {name: recording.column(name) for name in recording.layout.shapes}
    arrays["joint_names"] = np.array(recording.layout.joint_names)
    arrays["foot_names"] = np.array(recording.layout.foot_names)
    arrays["slack_names"] = np.array(SLACKS)
    arrays["meta"] = np.array(json.dumps(meta, allow_nan=False))
    if second is not None:
        arrays |= {f"{SECOND}{name}": second.column(name) for name in second.layout.shapes}
    np.savez_compressed(file, **arrays)


def write_whole(path: Path, content: bytes) -> None:
    """Write a file, whole or not at all.

    Raises:
        InputError: it cannot be written there.
    """
    temporary = _beside(writable_file(path))
    try:
        temporary.write_bytes(content)
        temporary.replace(path.resolve())
    except OSError as error:
        raise _not_writable(path, error) from error
    finally:
        temporary.unlink(missing_ok=True)


def load_trace(path: Path | BinaryIO, name: str = "") -> Trace:
    """Read what `save_trace` has written.

    Args:
        path: where it is, or its content.
        name: of the file, when its content is given.

    Raises:
        InputError: the file is not a recording.
    """
    try:
        with _opened(path) as raw, np.load(raw, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        joint_names, foot_names = arrays.pop("joint_names"), arrays.pop("foot_names")
        arrays.pop("slack_names", None)
        meta = json.loads(str(arrays.pop("meta")))
        second = {
            name.removeprefix(SECOND): arrays.pop(name) for name in list(arrays) if name.startswith(SECOND)
        }
    except (FileNotFoundError, IsADirectoryError, PermissionError) as error:
        raise InputError(
            "recording", name or path, f"a .npz file that can be read ({error.strerror})"
        ) from error
    except (OSError, KeyError, ValueError, TypeError, EOFError, BadZipFile, zlib.error) as error:
        raise InputError(
            "recording", name or path, "a .npz file that this lab has written, whole and unchanged"
        ) from error
    return Trace(arrays, tuple(joint_names.tolist()), tuple(foot_names.tolist()), meta, second)


def _opened(path: Path | BinaryIO) -> BinaryIO:
    return path.open("rb") if isinstance(path, Path) else path


def _beside(path: Path) -> Path:
    """A name that nothing has yet, in the folder of the file that a path leads to."""
    return path.resolve().parent / f".{uuid4().hex}.part"


def _not_writable(path: Path, error: OSError) -> InputError:
    return InputError("out", path, f"a file in a folder that can be written ({error.strerror})")
