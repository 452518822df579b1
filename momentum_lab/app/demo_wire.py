"""What the demonstration asks of a session's process."""

from __future__ import annotations

import msgspec

from momentum_lab.scenario import Scenario


class ShowScene(msgspec.Struct, frozen=True, tag=True):
    """Play a scenario in sight; what was on stage waits as it is."""

    scenario: Scenario


class LeaveScenes(msgspec.Struct, frozen=True, tag=True):
    """Give back what was on stage before the first scene; so does anything that a hand does."""


DemoEvent = ShowScene | LeaveScenes
