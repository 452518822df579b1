"""A scenario as a short word that fits into a URL, and back."""

from __future__ import annotations

import base64
import binascii
import zlib

import msgspec

from momentum_lab.errors import ScenarioError
from momentum_lab.scenario import Scenario, checked

# A code that unpacks to more than this, in bytes, is no scenario.
_LARGEST = 100_000


def to_code(scenario: Scenario) -> str:
    """The scenario as letters, digits, '-' and '_'."""
    packed = zlib.compress(msgspec.json.encode(scenario), 9)
    return base64.urlsafe_b64encode(packed).decode().rstrip("=")


def from_code(code: str) -> Scenario:
    """The scenario that `to_code` has packed.

    Raises:
        ScenarioError: the code is damaged, or what is in it is no scenario.
    """
    try:
        packed = base64.b64decode(code + "=" * (-len(code) % 4), altchars=b"-_", validate=True)
        unpacking = zlib.decompressobj()
        unpacked = unpacking.decompress(packed, _LARGEST)
        if not unpacking.eof:
            raise ValueError("something is missing at its end")
        return checked(msgspec.json.decode(unpacked, type=Scenario))
    except (binascii.Error, ValueError, zlib.error, msgspec.DecodeError) as error:
        raise ScenarioError("code", code[:40], f"a code that this lab has made ({error})") from error
