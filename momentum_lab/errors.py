"""Every error this package raises on purpose.

LabError                 one clear line for a person; the command line prints it and exits with 2
├── InputError           something a person gave: what it was, what is allowed, what to do
│   ├── RobotError       unknown robot, unreadable URDF or TOML, missing mesh or frame
│   ├── ScenarioError    unknown or unreadable scenario, value out of range
│   ├── GainError        unknown gain, value out of range
│   ├── LessonError      a lesson's script has an error; the argument is its file and line
│   └── ServerError      the app cannot start: port in use, host not available
├── SolverError          a quadratic program has no certified answer; carries the reason
└── SimulationError      the state is not finite any more; the recording is kept
"""

from __future__ import annotations


class LabError(Exception):
    """An error with a message for people."""


class InputError(LabError):
    """A value that cannot be used.

    Args:
        argument: the option, key or field the value was given for.
        given: the value itself, printed as it was given.
        allowed: what would be accepted, in words.
    """

    def __init__(self, argument: str, given: object, allowed: str) -> None:
        self.argument = argument
        self.given = given
        self.allowed = allowed
        super().__init__(f"{argument}: got {_one_line(given)}; allowed: {_one_line(allowed)}")

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str]]:
        return type(self), (self.argument, str(self.given), self.allowed)


class RobotError(InputError):
    """A robot that is unknown, unreadable or incomplete."""


class ScenarioError(InputError):
    """A scenario that is unknown, unreadable or out of range."""


class GainError(InputError):
    """A gain that does not exist or is out of range."""


class LessonError(InputError):
    """A lesson's script with an error in it; the argument is its file and line."""


class ServerError(InputError):
    """The app cannot be served as asked."""


class SolverError(LabError):
    """A quadratic program without a certified answer."""


class SimulationError(LabError):
    """A simulation whose state is not finite any more."""


def _one_line(value: object) -> str:
    text = " ".join(str(value).split())
    return text if text else "nothing"
