"""What remains of a run when its session is elsewhere or gone: enough for summaries, figures and reports."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.choices import Choices
from momentum_lab.events import LoggedEvent
from momentum_lab.fall import Fall
from momentum_lab.physics.push import Push
from momentum_lab.recording import Recording
from momentum_lab.robot.model import RobotModel
from momentum_lab.run_file import Run, run_of
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.start import stance_of


@dataclass(frozen=True, slots=True)
class FinishedRun:
    """A run that has been played, since its robot last stood up.

    Attributes:
        run: scenario and events; enough to play it again.
        robot: who was pushed.
        recording: what happened.
        time: how long it has lasted, s.
        choices: what was chosen in the end.
        pushes: all pushes, sized.
        fall: when and why the robot has fallen; None: it has not.
        solver_failures: ticks on which the fallback torque was used.
        com_speed: of the CoM against the ground under the feet at the last sample, m/s.
        beside: the robot beside this one, over the same time; None when there is none.
        since: when this robot came, s of the run; what fell before has not fallen by itself.
    """

    run: Run
    robot: RobotModel
    recording: Recording
    time: float
    choices: Choices
    pushes: tuple[Push, ...]
    fall: Fall | None
    solver_failures: int
    com_speed: float
    beside: FinishedRun | None = None
    since: float = 0.0

    @classmethod
    def of(cls, session: Session) -> FinishedRun:
        """What a session has done so far; it shares the session's recording."""
        return cls(
            run_of(session),
            session.robot,
            session.recording,
            session.time,
            session.choices,
            session.pushes,
            session.fall,
            session.solver_failures,
            com_speed(session),
        )

    @property
    def scenario(self) -> Scenario:
        """What was decided before the run."""
        return self.run.scenario

    @property
    def lay_there(self) -> bool:
        """Whether the robot had fallen already when it came."""
        return self.fall is not None and self.fall.time < self.since

    @property
    def ticks(self) -> int:
        """How long it has lasted since its session began."""
        return self.run.ticks

    @property
    def log(self) -> tuple[LoggedEvent, ...]:
        """What was done in it."""
        return self.run.events

    @property
    def stance(self) -> tuple[int, ...]:
        """The feet it stood on."""
        return stance_of(self.robot, self.run.scenario.stance)


def com_speed(session: Session) -> float:
    """Speed of the CoM against the ground under the feet at the last sample, m/s."""
    latest = session.recording.latest
    moving = session.ground.at(latest.number("time")).velocity[list(session.stance), :3].mean(axis=0)
    return float(np.linalg.norm(latest["com_velocity"] - moving))
