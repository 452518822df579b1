"""Runs that another was opened in place of: they wait where they were, and can be taken back."""

from __future__ import annotations

from momentum_lab.app.playback import Playback
from momentum_lab.errors import InputError
from momentum_lab.run_file import Run

# A minute of a robot's samples takes up to 150 MB.
_MOST = 2


class LeftRuns:
    """The last few of them."""

    def __init__(self) -> None:
        self._left: tuple[Playback, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """What they are, the last one last."""
        return tuple(f"{each.session.scenario.name} until {each.session.time:.2f} s" for each in self._left)

    def open(self, stage: Playback, run: Run) -> Playback:
        """A run to put on stage in place of what is there, which is kept if anything has been done in it.

        Raises:
            InputError: the run cannot be played; nothing has changed.
        """
        session = stage.session
        same = session.robot if session.scenario.robot == run.scenario.robot else None
        opened = Playback(run, same)
        opened.speed = stage.speed
        opened.run = stage.run + 1  # neighbours on stage must be told apart
        self._keep(stage)
        return opened

    def take_back(self, stage: Playback) -> Playback:
        """The last run that was left, as it was left; the one on stage can be taken back in turn.

        Raises:
            InputError: there is none.
        """
        if not self._left:
            raise InputError("take back", "no run", "one in whose place another has been opened")
        *left, last = self._left
        self._left = tuple(left)
        self._keep(stage)
        last.run = stage.run + 1
        return last

    def _keep(self, stage: Playback) -> None:
        if stage.session.log:
            self._left = (*self._left, stage)[-_MOST:]
