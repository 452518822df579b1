"""The runs of a lesson in a session's process: played in sight to their end, alone or two beside each other."""

from __future__ import annotations

import msgspec

from momentum_lab.app.companion import Companion
from momentum_lab.app.playback import Playback
from momentum_lab.app.wire import Truth
from momentum_lab.beside import Beside
from momentum_lab.events import LookBack
from momentum_lab.lesson.parts import Lesson, Run
from momentum_lab.lesson.staging import Staging, is_over
from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario, changed, sides
from momentum_lab.session import Session

# Ticks in a row while a run is played out of sight.
_AT_A_TIME = 100


class RunPlayback(Playback):
    """The playback of a lesson's run: its events come at their times, and it stops at its end.

    Args:
        run: the run.
        robot: who plays it.
        beside: another run, played and shown beside it; both go on until both are over.
        names: what to call the two robots.
    """

    beside: Companion | None

    def __init__(
        self,
        run: Run,
        robot: RobotModel,
        beside: RunPlayback | None = None,
        names: tuple[str, str] | None = None,
    ) -> None:
        self._staging: Staging | None = Staging(run)
        super().__init__(changed(run.for_robot(robot.spec.name), beside=None), robot)
        self._pair = None if beside is None else RunBeside(self.session, beside)
        self.beside, self.names = self._pair, names

    @property
    def over(self) -> bool:
        """Whether it has been played to its end."""
        return is_over(self.session)

    @property
    def going(self) -> bool:
        """Whether anything of it, or of the run beside it, is still to come."""
        own = self.stopped is None and not (self._staging and self.over)
        return own or (self._pair is not None and self._pair.run.going)

    @property
    def hand_over(self) -> Beside | None:
        """How a hand can go on with both robots; None: with the first one only."""
        return None if self._pair is None else difference(self.session.scenario, self._pair.session.scenario)

    def release(self) -> None:
        """Let it go on as a hand likes: nothing is to come any more, not even its end."""
        beside = self.hand_over
        if self._pair is not None:
            self.beside = None if beside is None else Companion(self._pair.session, beside)
        self._staging, self._pair, self.names, self.playing = None, None, None, True

    def tick(self, count: int) -> None:
        """Some ticks, fewer if the run comes to its end."""
        for _ in range(count):
            if self.stopped is None and (self._staging is None or self._staging.prepare(self.session)):
                super().tick(1)
            elif self._pair is not None and self._pair.run.going:
                self._pair.tick()
            else:
                self.playing = False
                return

    def finish(self) -> None:
        """Play what is still to come, out of sight."""
        while self.going:
            self.tick(_AT_A_TIME)

    def show(self, time: float) -> None:
        """Stop, and look at the instant of that time, s."""
        while self.going and self.session.time < time and not self.over:
            self.tick(_AT_A_TIME)
        self.take(LookBack(max(0.0, self.latest.number("time") - time)))

    def look_at(self, tick: int) -> None:
        """Show a tick, from 0, or the last one if that is still to come."""
        self._look_back(len(self.session.recording) - 1 - tick)

    @property
    def _difference(self) -> Beside | None:
        return self.hand_over if self._pair is not None else super()._difference


class RunBeside(Companion):
    """A run of a lesson beside another one: both are measured, and neither hears of the other.

    Args:
        first: the session beside which it is shown.
        run: its own playback.
    """

    def __init__(self, first: Session, run: RunPlayback) -> None:
        super().__init__(run.session, Beside())
        self.run, self._first = run, first

    def tick(self) -> None:
        """One tick, unless it has come to its end."""
        self.run.tick(1)

    def shown(self, behind: int) -> Sample:
        """Its sample at the instant of the first robot's so many ticks ago; while time runs, its last one."""
        newest = max(len(self._first.recording), len(self.session.recording)) - 1
        self.run.look_at(len(self._first.recording) - 1 - behind if behind else newest)
        return self.run.shown

    def truth(self, first: Truth, behind: int) -> Truth:
        """What is the case with this robot, at the instant that is shown."""
        self.shown(behind)
        return msgspec.structs.replace(
            self.run.truth(first.real_time_factor),
            run=first.run,
            playing=first.playing,
            speed=first.speed,
            behind=first.behind,
        )


def staged(lesson: Lesson, label: str, robot: RobotModel) -> dict[str, RunPlayback]:
    """A run of a lesson at its start, the one on stage, and with it the one beside it: label -> playback."""
    beside = lesson.beside(label)
    if beside is None:
        return {label: RunPlayback(lesson.runs[label], robot)}
    second = RunPlayback(lesson.runs[beside], robot)
    names = (label.replace("_", " "), beside.replace("_", " "))
    return {label: RunPlayback(lesson.runs[label], robot, second, names), beside: second}


def difference(first: Scenario, second: Scenario) -> Beside | None:
    """What a robot in the second scenario does differently, pushes and length aside; None: it cannot be said."""
    same = first.controller == second.controller
    gains = {} if same else second.gains
    if same:
        gains = {name: value for name, value in second.gains.items() if first.gains.get(name) != value}
    beside = Beside(
        None if same else second.controller,
        None if first.priority == second.priority else second.priority,
        gains,
    )
    target = msgspec.structs.replace(
        second, pushes=first.pushes, seconds=first.seconds, name=first.name, title=first.title, beside=None
    )
    return beside if sides(changed(first, beside=beside))[-1] == target else None
