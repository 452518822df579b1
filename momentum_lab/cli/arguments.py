"""What may be typed: commands, options, their ranges and their help."""

from __future__ import annotations

import argparse
from typing import Any

from momentum_lab import __version__
from momentum_lab.cli.parser import Parser, with_negative_numbers
from momentum_lab.cli.run_options import (
    choice_arguments,
    code_argument,
    duration_argument,
    scenario_arguments,
    tuning_arguments,
)
from momentum_lab.cli.values import (
    number,
    one_or_all,
    whole_number,
)
from momentum_lab.errors import InputError
from momentum_lab.patience import LEAST_PATIENCE, MOST_PATIENCE, PATIENCE

COMMANDS = (
    "app",
    "run",
    "limit",
    "report",
    "record",
    "replay",
    "lesson",
    "figure",
    "list",
    "equations",
    "robot-check",
    "bench",
)
KINDS = (
    "robots",
    "controllers",
    "planners",
    "motions",
    "scenarios",
    "lessons",
    "figures",
    "gains",
    "presets",
)
_MAX_PORT = 65535
_MAX_BENCH_SECONDS, _MAX_BENCH_MINUTES = 600.0, 60.0


def parsed(words: list[str]) -> argparse.Namespace:
    """The words of a command line as a namespace, with `command` as its first word.

    Raises:
        InputError: a word has no meaning, or a value is no number or out of range.
    """
    first = words[0] if words else ""
    if not first or (first.startswith("-") and first not in ("-h", "--help", "--version")):
        words = ["app", *words]
    elif not first.startswith("-") and first not in COMMANDS:
        raise InputError("command", first, ", ".join(COMMANDS))
    args, unknown = _parser().parse_known_args(with_negative_numbers(words))
    if unknown:
        options = ", ".join(args.options)
        raise InputError("argument", unknown[0], f"{args.usage}; options: {options}")
    return args


def _parser() -> Parser:
    parser = Parser(
        prog="momentum-lab",
        description="Push a humanoid and watch its momentum. Without a command: the app on 127.0.0.1:8080.",
    )
    parser.add_argument("--version", action="version", version=f"momentum-lab {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", title="commands")
    for name, help, add in (
        ("app", "open the lab in the browser", _app_arguments),
        ("run", "run a scenario without a screen", _run_arguments),
        ("limit", "the largest push that is survived, by bisection", _limit_arguments),
        ("report", "a run as one HTML file: figures, numbers, gains, checks, limits", _report_arguments),
        ("record", "a run as one file that plays in a browser without the lab", _record_arguments),
        (
            "replay",
            "play a run file or a trace again and say whether every bit is the same",
            _replay_arguments,
        ),
        (
            "lesson",
            "a guided lesson: a question, a prediction, an answer that is measured",
            _lesson_arguments,
        ),
        (
            "figure",
            "one of the chapter's figures: picture, numbers, and claims that are checked",
            _figure_arguments,
        ),
        (
            "list",
            "what there is: robots, controllers, planners, motions, scenarios, lessons, figures, gains, presets",
            _list_arguments,
        ),
        ("equations", "how exactly the chapter's equations hold on a robot", _equations_arguments),
        (
            "robot-check",
            "a robot's file from its URDF, and whether the robot stands and takes a push",
            _robot_check_arguments,
        ),
        ("bench", "how fast the lab is on this machine", _bench_arguments),
    ):
        command: Any = commands.add_parser(name, help=help, description=f"{help[0].upper()}{help[1:]}.")
        add(command)
        command.set_defaults(command=name, options=command.options, usage=_usage(name))
    return parser


def _usage(command: str) -> str:
    words = {
        "run": "run SCENARIO",
        "limit": "limit SCENARIO",
        "report": "report SCENARIO --out FILE",
        "record": "record SCENARIO --out FILE",
        "replay": "replay FILE",
        "lesson": "lesson NAME",
        "figure": "figure NAME --out DIR",
        "list": f"list {'|'.join(KINDS)}",
        "robot-check": "robot-check ROBOT",
    }
    return words.get(command, command)


def _app_arguments(parser: Parser) -> None:
    parser.add_argument("--scenario", metavar="S", help="what to start with; otherwise stand")
    choice_arguments(parser)
    code_argument(parser)
    parser.add_argument(
        "--demo",
        type=number("--demo", LEAST_PATIENCE, MOST_PATIENCE, "s"),
        nargs="?",
        const=PATIENCE,
        metavar="SECONDS",
        help=f"play by itself when nobody has touched a tab for so long ({PATIENCE:g} s)",
    )
    _serving_arguments(parser)


def _serving_arguments(parser: Parser) -> None:
    parser.add_argument("--host", default="127.0.0.1", metavar="H", help="address to serve on")
    parser.add_argument(
        "--port",
        type=whole_number("--port", 0, _MAX_PORT),
        default=8080,
        metavar="P",
        help="port to serve on; 0: any free one",
    )
    parser.add_argument("--no-browser", action="store_true", help="do not open a browser window")


def _run_arguments(parser: Parser) -> None:
    scenario_arguments(parser)
    parser.add_argument("--out", metavar="FILE", help="save the trace as .npz")
    parser.add_argument("--json", action="store_true", help="print the summary as one JSON object")


def _report_arguments(parser: Parser) -> None:
    scenario_arguments(parser)
    parser.add_argument("--out", metavar="FILE", help="where the report goes, an .html file")


def _record_arguments(parser: Parser) -> None:
    scenario_arguments(parser)
    parser.add_argument("--out", metavar="FILE", help="where the recording goes, an .html or .viser file")


def _replay_arguments(parser: Parser) -> None:
    parser.add_argument("file", nargs="?", default="", metavar="FILE", help="a run file, or a trace.npz")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def _limit_arguments(parser: Parser) -> None:
    parser.add_argument("scenario", nargs="?", default="stand", metavar="SCENARIO", help="otherwise stand")
    choice_arguments(parser)
    parser.add_argument(
        "--direction",
        type=one_or_all,
        default=0.0,
        metavar="D",
        help="forward, left, backward, right, degrees from forward to the left, or all: every 45 degrees",
    )
    duration_argument(parser)
    tuning_arguments(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def _lesson_arguments(parser: Parser) -> None:
    parser.add_argument(
        "name", nargs="?", default="", metavar="NAME", help="a lesson's number, file or title"
    )
    parser.add_argument("--headless", action="store_true", help="play it without a browser")
    parser.add_argument("--robot", metavar="R", help="a name, or a robot's .toml file")
    parser.add_argument("--json", action="store_true", help="play it and print one JSON object")
    _folder_argument(parser)
    _serving_arguments(parser)


def _folder_argument(parser: Parser) -> None:
    parser.add_argument("--lessons", metavar="DIR", help="a folder with lessons of your own")


def _figure_arguments(parser: Parser) -> None:
    parser.add_argument("name", nargs="?", default="", metavar="NAME", help="which figure, such as fig8")
    parser.add_argument("--robot", metavar="R", help="a name, or a robot's .toml file")
    parser.add_argument(
        "--out", metavar="DIR", help="folder for NAME.png, NAME.csv and NAME.json; has to be given"
    )


def _list_arguments(parser: Parser) -> None:
    parser.add_argument("kind", nargs="?", default="", metavar="|".join(KINDS), help="what to list")
    parser.add_argument("--controller", metavar="C", default="computed-torque", help="whose gains to list")
    _folder_argument(parser)
    parser.add_argument("--json", action="store_true", help="print a JSON array")


def _equations_arguments(parser: Parser) -> None:
    parser.add_argument("--robot", default="talos", metavar="R", help="a name, or a robot's .toml file")
    parser.add_argument("--json", action="store_true", help="print a JSON array")


def _robot_check_arguments(parser: Parser) -> None:
    parser.add_argument(
        "robot", nargs="?", default="", metavar="ROBOT", help="a .urdf, a robot's .toml, or the name of one"
    )
    parser.add_argument(
        "--soles",
        type=_two_frames,
        metavar="LEFT,RIGHT",
        help="sole frames of a .urdf, or the links of its feet",
    )
    parser.add_argument("--out", metavar="FILE", help="save the proposed robot as .toml")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def _two_frames(text: str) -> tuple[str, str]:
    names = [name.strip() for name in text.split(",")]
    if len(names) != 2 or not all(names) or names[0] == names[1]:
        raise InputError("--soles", text, "LEFT,RIGHT: two frames of the URDF, separated by a comma")
    return names[0], names[1]


def _bench_arguments(parser: Parser) -> None:
    parser.add_argument(
        "--seconds",
        type=number("--seconds", 1.0, _MAX_BENCH_SECONDS, "s"),
        metavar="S",
        help="how long to measure, s; otherwise 20",
    )
    parser.add_argument(
        "--minutes",
        type=number("--minutes", 0.1, _MAX_BENCH_MINUTES, "minutes"),
        metavar="M",
        help="how long to measure, minutes; memory and a late client need ten",
    )
    parser.add_argument("--app", action="store_true", help="measure the app with one client instead")
    parser.add_argument(
        "--profile", action="store_true", help="show where the time of a tick goes, call by call, instead"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
