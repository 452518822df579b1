"""What a lesson asks of a session's process, and what is told back."""

from __future__ import annotations

import msgspec

from momentum_lab.lesson.record import LessonRecord


class OpenLesson(msgspec.Struct, frozen=True, tag=True):
    """Set a person's own session aside and let the robot of a lesson stand there, ready for its first run."""

    file: str
    robot: str


class PlayRun(msgspec.Struct, frozen=True, tag=True):
    """Play a run of the open lesson from its start, in sight."""

    label: str


class OfferRun(msgspec.Struct, frozen=True, tag=True):
    """Put a run of the open lesson on stage at its start; whatever it needs has been done, and Play plays it."""

    label: str


class ShowRun(msgspec.Struct, frozen=True, tag=True):
    """Show an instant of a run, s; a run that nobody has seen yet is played out of sight."""

    label: str
    time: float


class LeaveLesson(msgspec.Struct, frozen=True, tag=True):
    """Give the person's own session back as it was."""


LessonEvent = OpenLesson | PlayRun | OfferRun | ShowRun | LeaveLesson


class LessonNews(msgspec.Struct, frozen=True):
    """How far a lesson has come in a session's process.

    Attributes:
        file: its script; empty when none is open.
        seen: the runs that have been played to their end.
        on_stage: the run that is shown; empty for what a person tries out.
        record: what the runs that were seen have shown, once it is all of them.
        error: what is wrong with the lesson.
    """

    file: str = ""
    seen: tuple[str, ...] = ()
    on_stage: str = ""
    record: LessonRecord | None = None
    error: str = ""
