"""A run as a short word that fits into a URL, and back.

A code is `lab1-` and base64url of a checksum and the packed run. What is at its default is left out: whoever
changes a default changes what old codes mean, and has to raise the version.
"""

from __future__ import annotations

import base64
import binascii
import re
import zlib
from typing import Any

import msgspec

from momentum_lab.errors import InputError
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run, run_from
from momentum_lab.scenario import Scenario

VERSION = 1
MOST_LETTERS = 6000
"""Servers and browsers take addresses of about 8000 letters."""

# A code that unpacks to more than this, in bytes, is no run.
_LARGEST = 500_000
_CHECKSUM = 4
_SCENARIO_DEFAULTS = msgspec.to_builtins(Scenario(""))
_PUSH_DEFAULTS = msgspec.to_builtins(Push())


def to_code(run: Run) -> str:
    """The run as letters, digits, '-' and '_'.

    Raises:
        InputError: so much has been done in it that no short code can hold it.
    """
    packed = _deflated(msgspec.msgpack.encode(_lean(run)))
    letters = base64.urlsafe_b64encode(_checksum(packed) + packed).decode().rstrip("=")
    code = f"lab{VERSION}-{letters}"
    if len(code) > MOST_LETTERS:
        given = f"a run of {len(run.events)} events, {len(code)} letters"
        raise InputError("code", given, f"at most {MOST_LETTERS} letters; save it as a run file instead")
    return code


def from_code(text: str) -> Run:
    """The run that `to_code` has packed; an address that ends in a code will do.

    Raises:
        InputError: the code is damaged, of another version, too long, or what is in it is no run.
    """
    code = "".join(text.split()).rpartition("run=")[2]
    if len(code) > MOST_LETTERS:
        raise InputError("code", f"{len(code)} letters", f"at most {MOST_LETTERS} letters")
    found = re.fullmatch(r"lab(\d{1,4})-([A-Za-z0-9_-]*)", code, re.ASCII)
    if found is None:
        raise InputError("code", code[:40], f"a code that this lab has made: lab{VERSION}-...")
    version, letters = found.groups()
    if int(version) != VERSION:
        raise InputError("code", f"version {version}", f"version {VERSION}, which this lab writes")
    try:
        packed = base64.b64decode(letters + "=" * (-len(letters) % 4), altchars=b"-_", validate=True)
    except binascii.Error as error:
        raise _damaged(code) from error
    if packed[:_CHECKSUM] != _checksum(packed[_CHECKSUM:]):
        raise _damaged(code)
    try:
        data = msgspec.msgpack.decode(_inflated(packed[_CHECKSUM:]))
    except (ValueError, zlib.error, msgspec.DecodeError, RecursionError) as error:
        raise InputError("code", code[:40], f"a code with a run in it ({error})") from error
    return run_from(data, " in the code")


def link(url: str, code: str) -> str:
    """The address that opens a code in the app that is served at `url`."""
    return f"{url}/?run={code}"


def _damaged(code: str) -> InputError:
    return InputError("code", f"{code[:40]}...", "a whole code; in this one letters are missing or changed")


def _lean(run: Run) -> dict[str, Any]:
    """The run as plain data without what is at its default."""
    data = msgspec.to_builtins(run)
    scenario = _without(data["scenario"], _SCENARIO_DEFAULTS)
    scenario["name"] = run.scenario.name
    scenario["pushes"] = [_without(push, _PUSH_DEFAULTS) for push in data["scenario"]["pushes"]]
    for entry in data["events"]:
        event = entry["event"]
        if "push" in event:
            event["push"] = _without(event["push"], _PUSH_DEFAULTS)
        if "pushes" in event:
            event["pushes"] = [_without(push, _PUSH_DEFAULTS) for push in event["pushes"]]
    return {**data, "scenario": _without(scenario, {"pushes": []})}


def _without(data: dict[str, Any], defaults: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in data.items() if name not in defaults or value != defaults[name]}


def _checksum(packed: bytes) -> bytes:
    return zlib.crc32(packed).to_bytes(_CHECKSUM, "big")


def _deflated(data: bytes) -> bytes:
    packer = zlib.compressobj(9, wbits=-zlib.MAX_WBITS)
    return packer.compress(data) + packer.flush()


def _inflated(packed: bytes) -> bytes:
    unpacker = zlib.decompressobj(wbits=-zlib.MAX_WBITS)
    data = unpacker.decompress(packed, _LARGEST)
    if not unpacker.eof:
        raise ValueError("it is too large, or has no end")
    return data
