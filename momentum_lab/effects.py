"""What an event does to the ground and to the pushes, as values: what was goes in, what will be comes out."""

from __future__ import annotations

import msgspec

from momentum_lab.errors import InputError
from momentum_lab.events import (
    ApplyPush,
    ApplyPushes,
    HoldPush,
    LetGo,
    MoveGround,
    Reset,
    SessionEvent,
    SetFriction,
    StopGround,
)
from momentum_lab.physics.ground import Ground, checked_friction
from momentum_lab.physics.held_push import Pushed
from momentum_lab.physics.push import Push, pushed_frame
from momentum_lab.robot.model import RobotModel


def ground_after(ground: Ground, event: SessionEvent, robot: RobotModel, time: float) -> Ground:
    """The ground after an event at a time of the run, s; the same one if it is about something else.

    Raises:
        InputError: the robot has no such foot, or a value is out of range.
    """
    match event:
        case SetFriction(value, foot):
            return ground.as_slippery_as(checked_friction(value), feet_named(foot, robot), time)
        case MoveGround(motion, foot):
            begun = msgspec.structs.replace(motion, start=time, stop=None)
            return ground.moving_too(feet_named(foot, robot), begun)
        case StopGround():
            return ground.coming_to_rest(time)
    return ground


def pushed_after(pushed: Pushed, event: SessionEvent, robot: RobotModel, time: float) -> Pushed:
    """All pushes after an event at a time of the run, s; the same ones if it is about something else.

    Raises:
        InputError: the robot has no such body, or the force is out of range.
    """
    match event:
        case ApplyPush(push):
            return pushed.with_push(_begun(sized(push, robot), time, 0.0))
        case ApplyPushes(later):
            for push in later:
                pushed = pushed.with_push(_begun(sized(push, robot), time, push.start))
        case HoldPush(push):
            return pushed.held_from(time, sized(push, robot))
        case LetGo():
            return pushed.let_go(time)
        case Reset():
            return Pushed()
    return pushed


def sized(push: Push, robot: RobotModel) -> Push:
    """A push with its force, if the robot has the body it names.

    Raises:
        InputError: it has none, or the force is out of range.
    """
    pushed_frame(robot, push)
    return push.sized_for(robot.mass)


def feet_named(name: str, robot: RobotModel) -> tuple[int, ...]:
    """Indices of the feet of that name; of all for an empty one.

    Raises:
        InputError: the robot has no such foot.
    """
    if name and name not in robot.foot_names:
        raise InputError("foot", name, f"one of {', '.join(robot.foot_names)}")
    return tuple(i for i, foot in enumerate(robot.foot_names) if name in ("", foot))


def _begun(push: Push, time: float, after: float) -> Push:
    """A push that begins so long after a time of the run, s."""
    return msgspec.structs.replace(push, start=time + after)
