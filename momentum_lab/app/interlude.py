"""Scenes in a session's process that nobody has asked for: what was on stage waits, and comes back untouched."""

from __future__ import annotations

from momentum_lab.app.playback import Playback
from momentum_lab.scenario import Scenario


class Interlude:
    """What waits while scenes are played."""

    def __init__(self) -> None:
        self._waiting: Playback | None = None

    @property
    def on(self) -> bool:
        """Whether something waits."""
        return self._waiting is not None

    def scene(self, stage: Playback, scenario: Scenario) -> Playback:
        """A scene to put on stage in place of what is there.

        Raises:
            InputError: it cannot be played.
        """
        same = stage.session.robot if stage.session.scenario.robot == scenario.robot else None
        scene = Playback(scenario, same)
        scene.run = stage.run + 1  # neighbours on stage must be told apart
        self._waiting = self._waiting or stage
        return scene

    def end(self, stage: Playback) -> Playback:
        """What belongs on stage when somebody is there."""
        before, self._waiting = self._waiting or stage, None
        return before
