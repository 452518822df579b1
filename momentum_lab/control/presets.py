"""Named sets of gains: those that ship with the lab, and those that a person keeps in their own folder."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path
from uuid import uuid4

import msgspec

from momentum_lab.control.gains import declared_gains, with_gains
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import GainError, InputError
from momentum_lab.paths import ASSETS, config_folder

STANDARD = "chapter-like"
"""The preset of all defaults."""

SHIPPED = ("soft", STANDARD, "stiff")
MOST_PRESETS = 100
"""Of one's own, for one controller."""

_NAME = r"[a-z0-9][a-z0-9-]{0,39}"


class Preset(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A set of gains for one controller.

    Attributes:
        gains: values that differ from the controller's defaults.
        summary: what it does, in one sentence.
    """

    gains: dict[str, float]
    summary: str = ""

    def values(self, controller: str) -> dict[str, float]:
        """All gains of the controller under this preset, by name."""
        declared = declared_gains(controller_entry(controller).gains)
        return {name: self.gains.get(name, gain.default) for name, gain in declared.items()}


def presets(controller: str) -> dict[str, Preset]:
    """All presets of a controller by name: shipped ones first, then one's own; unreadable files are left out.

    Raises:
        InputError: there is no such controller.
    """
    controller_entry(controller)
    found = {name: _read(_shipped(controller, name), controller) for name in SHIPPED}
    for path in sorted(_own_folder(controller).glob("*.toml"))[:MOST_PRESETS]:
        if path.stem not in found and re.fullmatch(_NAME, path.stem):
            try:
                found[path.stem] = _read(path, controller)
            except InputError:
                continue
    return found


def preset_named(name: str, controller: str) -> Preset:
    """The preset of that name, or in that file.

    Args:
        name: a shipped one, one's own, or the path of a .toml file.
        controller: whose gains they are.

    Raises:
        InputError: the controller has none, or its file is no preset.
    """
    controller_entry(controller)
    if name.endswith(".toml"):
        return _read(Path(name), controller)
    own = _own_folder(controller) / f"{name}.toml"
    if name in SHIPPED:
        return _read(_shipped(controller, name), controller)
    if not re.fullmatch(_NAME, name) or not own.is_file():
        known = ", ".join(presets(controller))
        raise InputError("preset", name, f"one of {known} for {controller}, or the path of a .toml file")
    return _read(own, controller)


def save_preset(name: str, controller: str, values: dict[str, float]) -> Path:
    """Keep gains under a name of one's own; the file is written whole or not at all.

    Args:
        name: small letters, digits and hyphens.
        controller: whose gains they are.
        values: gains by name; those at their defaults are left out.

    Returns:
        Where it has been written.

    Raises:
        InputError: the name is taken or not allowed, a gain is out of range, or nothing can be written.
    """
    if name in SHIPPED or not re.fullmatch(_NAME, name):
        taken = ", ".join(SHIPPED)
        raise InputError("preset", name, f"1 to 40 small letters, digits and hyphens, and not {taken}")
    entry, folder = controller_entry(controller), _own_folder(controller)
    with_gains(entry.gains, values)
    declared = declared_gains(entry.gains)
    changed = {name: float(value) for name, value in values.items() if value != declared[name].default}
    lines = [f"{gain} = {value!r}" for gain, value in changed.items()]
    target = folder / f"{name}.toml"
    if not target.exists() and len(list(folder.glob("*.toml"))) >= MOST_PRESETS:
        raise InputError(
            "preset", f"{MOST_PRESETS + 1} presets", f"at most {MOST_PRESETS}: delete some of {folder}"
        )
    _write(target, "\n".join(['summary = "Saved from the lab."', "", "[gains]", *lines, ""]))
    return target


def _write(path: Path, text: str) -> None:
    temporary = path.parent / f".{uuid4().hex}.part"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(path)
    except OSError as error:
        raise InputError("preset", path, f"a file that can be written ({error.strerror})") from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


def _read(path: Path, controller: str) -> Preset:
    try:
        preset = msgspec.toml.decode(path.read_bytes(), type=Preset)
        with_gains(controller_entry(controller).gains, preset.gains)
    except (OSError, ValueError, GainError) as error:
        raise InputError("preset", path, f"a TOML file with gains of {controller} ({error})") from error
    return preset


def _shipped(controller: str, name: str) -> Path:
    return ASSETS / "presets" / controller / f"{name}.toml"


def _own_folder(controller: str) -> Path:
    return config_folder() / "presets" / controller
