"""The command line: momentum-lab COMMAND ...

COMMAND: app | run | limit | report | record | replay | lesson | figure | list | equations | robot-check | bench.

Exit codes: 0 the command did what was asked (a robot that falls is a result, not an error), 1 something broke
down on the way, a figure's or lesson's claim or an equation does not hold, or a checked robot falls, 2 bad
input, 130 stopped by Ctrl+C. Bad input is one line on stderr and nothing on stdout:
`momentum-lab: ARGUMENT: got GIVEN; allowed: ALLOWED`. Only `list lessons` lists what is sound beside a line for each
lesson that is not.
"""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Callable, Sequence
from typing import Any

from threadpoolctl import threadpool_limits

from momentum_lab.cli.arguments import parsed
from momentum_lab.errors import InputError, LabError

BROKEN, BAD_INPUT, STOPPED = 1, 2, 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code.

    Args:
        argv: the words after `momentum-lab`; None: those of this process.
    """
    try:
        return _run(list(sys.argv[1:] if argv is None else argv))
    except InputError as error:
        return _complain(error, BAD_INPUT)
    except LabError as error:
        return _complain(error, BROKEN)
    except KeyboardInterrupt:
        return _complain("stopped", STOPPED)
    except BrokenPipeError:
        # Whoever read the output has gone; Python would complain once more when it closes stdout.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return BROKEN
    except OSError as error:
        if error.filename is None:
            raise
        return _complain(InputError(error.filename, error.strerror, "a file that can be read"), BAD_INPUT)


def _run(words: list[str]) -> int:
    args = parsed(words)
    command = _imported(args.command)
    # Matrices of this size gain nothing from threads, and threads of several libraries fight for the cores.
    # The limit holds for the libraries that are loaded, hence after the command has been imported.
    with threadpool_limits(limits=1, user_api="blas"):
        try:
            code = command(args)
        except InputError as error:
            raise _as_typed(error, vars(args)) from error
    sys.stdout.flush()
    return code


def _imported(name: str) -> Callable[[Namespace], int]:
    """A command, imported only when it is asked for, so that a headless run never loads the app."""
    if name == "app":
        from momentum_lab.cli.app import app

        return app
    if name == "run":
        from momentum_lab.cli.run import run

        return run
    if name == "limit":
        from momentum_lab.cli.limit import limit

        return limit
    if name == "report":
        from momentum_lab.cli.report import report

        return report
    if name == "record":
        from momentum_lab.cli.record import record

        return record
    if name == "replay":
        from momentum_lab.cli.replay import replay

        return replay
    if name == "lesson":
        from momentum_lab.cli.lesson import lesson

        return lesson
    if name == "figure":
        from momentum_lab.cli.figure import figure

        return figure
    if name == "list":
        from momentum_lab.cli.listing import list_things

        return list_things
    if name == "equations":
        from momentum_lab.cli.equations import equations

        return equations
    if name == "robot-check":
        from momentum_lab.cli.robot_check import robot_check

        return robot_check
    from momentum_lab.cli.bench import bench

    return bench


def _as_typed(error: InputError, args: dict[str, Any]) -> InputError:
    """The error with its argument spelled as the option it was given by, if it was."""
    option = f"--{error.argument}"
    if args.get(error.argument) is None or option not in args["options"]:
        return error
    return InputError(option, error.given, error.allowed)


def _complain(problem: object, code: int) -> int:
    print(f"momentum-lab: {problem}", file=sys.stderr)
    return code
