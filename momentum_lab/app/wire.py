"""What the server and a worker tell each other over the pipe: events and receipts in, frames out."""

from __future__ import annotations

import msgspec
import numpy as np

from momentum_lab import events
from momentum_lab.app.demo_wire import DemoEvent
from momentum_lab.app.lesson_wire import LessonEvent, LessonNews
from momentum_lab.beside import Beside
from momentum_lab.control.ground_sense import GroundSense
from momentum_lab.control.motion import AngularGoal
from momentum_lab.physics.mismatch import EXACT, Mismatch
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run


class FrameTaken(msgspec.Struct, frozen=True, tag=True):
    """The last frame has been drawn; the next one may be sent."""


class FrameWanted(msgspec.Struct, frozen=True, tag=True):
    """The picture has to be drawn again although nothing has happened in the session."""


class OpenRun(msgspec.Struct, frozen=True, tag=True):
    """Start a run that somebody has kept, and play its events as they were."""

    run: Run


class TakeBack(msgspec.Struct, frozen=True, tag=True):
    """Put the run on stage again that was there before another was opened."""


class RunWanted(msgspec.Struct, frozen=True, tag=True):
    """What has been done so far has to be told."""


class RecordingWanted(msgspec.Struct, frozen=True, tag=True):
    """What has been done so far has to be told, with all samples."""


class Fallen(msgspec.Struct, frozen=True):
    """When and why the robot has fallen."""

    time: float
    reason: str


class Opened(msgspec.Struct, frozen=True):
    """A run that has been opened and is being played.

    Attributes:
        seconds: how long it lasts, s; 0: it has no end.
        over: whether it has been played to its end.
        agrees: whether its last sample has the same bits; None: not known, or something else was done in it.
    """

    seconds: float
    over: bool = False
    agrees: bool | None = None


class Truth(msgspec.Struct, frozen=True):
    """What is the case in a session, next to its samples.

    Attributes:
        run: counts every new session and every standing up; what belongs to an older run is history.
        scenario: name of the scenario.
        robot: name of the robot, or the path of its file.
        controller: name of the controller.
        priority: from 0 to 1.
        controlled: the directions of momentum that are asked for, in the shortest words.
        planner: what makes the momentum rates that are asked for.
        motion: what the robot does besides standing; empty: nothing.
        angular_goal: the angular momentum that is asked for meanwhile.
        gains: all gains of the controller.
        playing: whether simulated time runs.
        speed: the fraction of real time it is asked to run at.
        real_time_factor: simulated seconds per second, measured over about a second.
        fall: when and why the robot has fallen; None while it stands.
        failure: why the last failed solve had no answer; None when none has failed.
        failures: how many solves have failed since the robot stood up.
        stopped: why the simulation cannot go on; None while it can.
        push: the latest push that has begun; None before the first.
        friction: Coulomb coefficient under each foot.
        uneven: whether the ground under the feet is anything but the floor.
        floor: height of the floor under everything else, m.
        ground_sense: whether the robot is told how the ground moves.
        mismatch: how the simulated robot differs from the one its controller believes in.
        behind: how long before the present end of the run the sample is that is looked at, s.
        first_push: the first push since the robot stood up; None before it has begun.
        beside: what a robot beside this one does differently; None when there is none.
        opened: the run that has been opened; None when it is no opened run that plays.
        pushed: when pushes have begun since the robot stood up, until the end of the run, s.
        forgotten: those of them that going on from what is looked at would not repeat, s.
        since: when this robot came beside another, s of the run; what fell before has not fallen by itself.
    """

    run: int
    scenario: str
    robot: str
    controller: str
    priority: float
    controlled: str
    planner: str
    motion: str
    angular_goal: AngularGoal
    gains: dict[str, float]
    playing: bool
    speed: float
    real_time_factor: float
    fall: Fallen | None
    failure: str | None
    failures: int
    stopped: str | None
    push: Push | None
    friction: tuple[float, ...] = ()
    uneven: bool = False
    floor: float = 0.0
    ground_sense: GroundSense = "told"
    mismatch: Mismatch = EXACT
    behind: float = 0.0
    first_push: Push | None = None
    beside: Beside | None = None
    opened: Opened | None = None
    pushed: tuple[float, ...] = ()
    forgotten: tuple[float, ...] = ()
    since: float = 0.0

    @property
    def lay_there(self) -> bool:
        """Whether the robot had fallen already when it came."""
        return self.fall is not None and self.fall.time < self.since


class Other(msgspec.Struct, frozen=True):
    """What is new with the robot beside the first.

    Attributes:
        truth: what is the case with it.
        row: its latest sample, float64.
        history: its samples at the pace of the plots since the last frame, float64, oldest first.
        names: what to call the two robots; None: by what differs.
    """

    truth: Truth
    row: bytes
    history: bytes
    names: tuple[str, str] | None = None


class Foreseen(msgspec.Struct, frozen=True):
    """What a push would do.

    Attributes:
        start: when it would begin, s.
        rows: samples at the pace of the plots from then on, float64.
        fall: when and why the robot would fall; None if it would stand for as long as was looked ahead.
    """

    start: float
    rows: bytes
    fall: Fallen | None


class Frame(msgspec.Struct, frozen=True, tag=True):
    """Everything new since the last frame.

    Attributes:
        truth: what is the case.
        row: the latest sample, float64.
        history: the samples at the pace of the plots since the last frame, float64, oldest first.
        notices: what has to be told to the person, once.
        late_ticks: how many ticks have begun late since the session's process started.
        lesson: how far the lesson has come, if that is new.
        other: the robot beside the first; None when there is none.
        foreseen: what a push would do, once for every robot and question.
        foreseeing: how much of what is being foreseen is done, from 0 to 1; None when nothing is.
        demo: whether this is a scene that the lab plays by itself.
        left: the runs that can be taken back, in words, the last one last.
    """

    truth: Truth
    row: bytes
    history: bytes
    notices: tuple[str, ...] = ()
    late_ticks: int = 0
    lesson: LessonNews | None = None
    other: Other | None = None
    foreseen: tuple[Foreseen, ...] = ()
    foreseeing: float | None = None
    demo: bool = False
    left: tuple[str, ...] = ()


class RunTaken(msgspec.Struct, frozen=True, tag=True):
    """A run as it is now, since its robot last stood up.

    Attributes:
        run: scenario, events, length.
        rows: all samples that are kept, float64, oldest first; empty if they were not wanted.
        time: of the session, s.
        pushes: all pushes, sized.
        fall: when and why the robot has fallen; None: it has not.
        failures: how many solves have failed.
        com_speed: of the CoM against the ground under the feet at the end, m/s.
        other: the robot beside the first; None when there is none, or no samples were wanted.
        since: when this robot came, s of the run.
    """

    run: Run
    rows: bytes
    time: float
    pushes: tuple[Push, ...]
    fall: Fallen | None
    failures: int
    com_speed: float
    other: RunTaken | None = None
    since: float = 0.0


Asked = FrameTaken | FrameWanted | OpenRun | TakeBack | RunWanted | RecordingWanted
Message = events.Event | LessonEvent | DemoEvent | Asked
Answer = Frame | RunTaken

_encoder = msgspec.msgpack.Encoder()
_message_decoder = msgspec.msgpack.Decoder(Message)
_answer_decoder = msgspec.msgpack.Decoder(Answer)


def packed(message: Message | Answer) -> bytes:
    """A message or an answer as bytes."""
    return _encoder.encode(message)


def unpacked_message(data: bytes) -> Message:
    """The message that `packed` has written."""
    return _message_decoder.decode(data)


def unpacked_answer(data: bytes) -> Answer:
    """The frame or the run that `packed` has written."""
    return _answer_decoder.decode(data)


def rows_of(data: bytes, width: int) -> np.ndarray:
    """Samples (n, width) out of a frame's bytes."""
    return np.frombuffer(data, dtype=np.float64).reshape(-1, width).copy()  # bytes are read-only
