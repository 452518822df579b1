"""Everything a person, a lesson or a test can do to a running lab, as plain data.

A session takes events at the start of a tick, in their order, and keeps a log of them: the scenario and the
log together replay the run bit for bit.
"""

from __future__ import annotations

from typing import Literal

import msgspec

from momentum_lab.beside import Beside
from momentum_lab.physics.plate import PlateMotion
from momentum_lab.physics.push import Push


class SetGain(msgspec.Struct, frozen=True, tag=True):
    """Change one gain of the current controller."""

    name: str
    value: float


class SetGains(msgspec.Struct, frozen=True, tag=True):
    """Change several gains of the current controller in the same tick: a preset, a step back or forth."""

    values: dict[str, float]


class SetPriority(msgspec.Struct, frozen=True, tag=True):
    """Change which momentum is kept: 0 linear, 1 angular."""

    value: float


class SetDirections(msgspec.Struct, frozen=True, tag=True):
    """Ask for some directions of momentum and leave the others free: `all`, `linear+kz`, `lx+ly` and so on."""

    controlled: str


class SelectPlanner(msgspec.Struct, frozen=True, tag=True):
    """Change what makes the momentum rates that are asked for."""

    name: str


class SetMotion(msgspec.Struct, frozen=True, tag=True):
    """Begin a motion on top of standing, from its start; an empty name ends it."""

    name: str


class SetAngularGoal(msgspec.Struct, frozen=True, tag=True):
    """Ask for no angular momentum, or for that of the motion by kinematics alone."""

    goal: Literal["zero", "reference"]


class SetFriction(msgspec.Struct, frozen=True, tag=True):
    """Make the ground under a foot more or less slippery from now on; an empty name means all feet."""

    value: float
    foot: str = ""


class MoveGround(msgspec.Struct, frozen=True, tag=True):
    """Let the plate under a foot begin a motion now; an empty name means all feet, as if on one plate.

    The motion's own start and stop are ignored.
    """

    motion: PlateMotion
    foot: str = ""


class StopGround(msgspec.Struct, frozen=True, tag=True):
    """Let all swaying plates come to rest within a period of theirs."""


class SetGroundSense(msgspec.Struct, frozen=True, tag=True):
    """Tell the robot how the ground moves, or let it feel it through its soles."""

    sense: Literal["told", "felt"]


class SetMismatch(msgspec.Struct, frozen=True, tag=True):
    """Let the real robot differ from what its controller believes, in one of the entries of a `Mismatch`."""

    name: str
    value: float


class SelectController(msgspec.Struct, frozen=True, tag=True):
    """Change the controller; its gains start at their defaults, and so does a planner that it cannot take."""

    name: str


class ApplyPush(msgspec.Struct, frozen=True, tag=True):
    """Push the robot now; the push's own start is ignored."""

    push: Push


class ApplyPushes(msgspec.Struct, frozen=True, tag=True):
    """Push the robot several times; each push's start counts from now, s."""

    pushes: tuple[Push, ...]


class HoldPush(msgspec.Struct, frozen=True, tag=True):
    """Push the robot from now until the next `HoldPush` or `LetGo`, for ten seconds at most.

    The push's own start, duration and shape are ignored: its force is constant, and a hand that moves is a chain
    of such pushes, each of which ends at the tick at which the next begins.
    """

    push: Push


class LetGo(msgspec.Struct, frozen=True, tag=True):
    """End the push that is held now, if there is one."""


class Reset(msgspec.Struct, frozen=True, tag=True):
    """Stand the robot up again where it started and set the clock to zero.

    Gains and priority stay; the scenario's own pushes are not repeated.
    """


class Play(msgspec.Struct, frozen=True, tag=True):
    """Let simulated time run."""


class Pause(msgspec.Struct, frozen=True, tag=True):
    """Stop simulated time."""


class StepOnce(msgspec.Struct, frozen=True, tag=True):
    """Advance a paused simulation by some ticks."""

    ticks: int = 1


class SetSpeed(msgspec.Struct, frozen=True, tag=True):
    """Run at this fraction of real time."""

    value: float


class SelectRobot(msgspec.Struct, frozen=True, tag=True):
    """Start the scenario again with another robot."""

    name: str


class LoadScenario(msgspec.Struct, frozen=True, tag=True):
    """Start another scenario."""

    name: str


class LookBack(msgspec.Struct, frozen=True, tag=True):
    """Stop simulated time and show what was so many seconds before its present end; 0 is the end itself."""

    seconds: float


class Branch(msgspec.Struct, frozen=True, tag=True):
    """Go on from the instant that is looked at, with the gains, priority and controller of now."""


class SetBeside(msgspec.Struct, frozen=True, tag=True):
    """Put a second robot beside the first, or change what it does differently; None: take it away."""

    beside: Beside | None


class RunAgain(msgspec.Struct, frozen=True, tag=True):
    """Stand the robot up and push it again as it was pushed before, with the choices of now."""


class Foresee(msgspec.Struct, frozen=True, tag=True):
    """Try a push ahead of time on a copy of the session; the session itself is not pushed."""

    push: Push


SessionEvent = (
    SetGain
    | SetGains
    | SetPriority
    | SetDirections
    | SelectPlanner
    | SetMotion
    | SetAngularGoal
    | SetFriction
    | MoveGround
    | StopGround
    | SetGroundSense
    | SetMismatch
    | SelectController
    | ApplyPush
    | ApplyPushes
    | HoldPush
    | LetGo
    | Reset
)
PlaybackEvent = (
    Play
    | Pause
    | StepOnce
    | SetSpeed
    | SelectRobot
    | LoadScenario
    | LookBack
    | Branch
    | SetBeside
    | RunAgain
    | Foresee
)
Event = SessionEvent | PlaybackEvent


class LoggedEvent(msgspec.Struct, frozen=True):
    """An event and the tick at whose start it was taken."""

    tick: int
    event: SessionEvent
