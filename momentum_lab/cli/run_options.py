"""Options that commands about runs share: what is run, who is pushed, how, and under which choices."""

from __future__ import annotations

from momentum_lab.cli.parser import Parser
from momentum_lab.cli.values import (
    ABOVE_ZERO,
    controlled_directions,
    gain_setting,
    mismatch_setting,
    number,
    whole_number,
)
from momentum_lab.physics.plate import MAX_FRICTION
from momentum_lab.physics.push import MAX_DURATION, MAX_FORCE, MAX_HEIGHT
from momentum_lab.scenario import MAX_SECONDS, MAX_SEED, MIN_SECONDS


def scenario_arguments(parser: Parser) -> None:
    """A scenario, or a shared run, and all that can be changed about it."""
    parser.add_argument("scenario", nargs="?", default="", metavar="SCENARIO", help="a name, or a .toml file")
    choice_arguments(parser)
    push_arguments(parser)
    tuning_arguments(parser)
    code_argument(parser)


def choice_arguments(parser: Parser) -> None:
    """Who stands there, and who keeps the balance, and how."""
    parser.add_argument("--robot", metavar="R", help="a name, or a robot's .toml file")
    parser.add_argument("--controller", metavar="C", help="who keeps the balance")
    parser.add_argument(
        "--controlled",
        metavar="D",
        type=controlled_directions,
        help="directions of momentum that are asked for: all, linear+kz, lx+ly, ...",
    )
    parser.add_argument("--planner", metavar="P", help="what makes the momentum rates that are asked for")
    parser.add_argument(
        "--motion", metavar="M", help="what the robot does: kick, reach, arm-swing, cat-left, ..."
    )
    parser.add_argument(
        "--angular-goal", metavar="G", help="angular momentum asked for: zero, or reference, the motion's own"
    )
    parser.add_argument(
        "--ground-sense", metavar="S", help="how the robot knows a moving ground: told, or felt by its soles"
    )
    parser.add_argument(
        "--friction",
        metavar="x",
        type=number("--friction", ABOVE_ZERO, MAX_FRICTION, "Coulomb coefficient of the floor"),
        help="Coulomb coefficient of the floor",
    )
    parser.add_argument(
        "--mismatch",
        type=mismatch_setting,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="let the real robot differ from its model: mass_error=0.1, torque_delay_ms=2; may be repeated",
    )
    parser.add_argument(
        "--preset",
        metavar="NAME",
        help="gains by name: soft, chapter-like, stiff, one kept in the Control tab, or the path of a .toml",
    )


def push_arguments(parser: Parser) -> None:
    """One push instead of those of the scenario."""
    parser.add_argument(
        "--push",
        type=number("--push", 0.0, MAX_FORCE, "N"),
        metavar="N",
        help="one push of this force instead of the scenario's, N",
    )
    duration_argument(parser)
    parser.add_argument(
        "--push-direction",
        type=number("--push-direction", -360.0, 360.0, "degrees"),
        metavar="DEG",
        help="where it points: 0 forward, 90 left, degrees",
    )
    parser.add_argument(
        "--push-height",
        type=number("--push-height", ABOVE_ZERO, MAX_HEIGHT, "m"),
        metavar="M",
        help="height of its line of action, m; otherwise through the CoM",
    )


def tuning_arguments(parser: Parser) -> None:
    """Everything about a run but who is pushed and how."""
    parser.add_argument(
        "--priority",
        type=number("--priority", 0.0, 1.0, "0 keeps linear momentum, 1 angular momentum"),
        metavar="X",
        help="which momentum to keep: 0 linear, as long as the body has room to turn; 1 angular",
    )
    parser.add_argument(
        "--set",
        type=gain_setting,
        action="append",
        default=[],
        metavar="GAIN=VALUE",
        help="change a gain; may be repeated",
    )
    parser.add_argument(
        "--seconds",
        type=number("--seconds", MIN_SECONDS, MAX_SECONDS, "s"),
        metavar="T",
        help="how long to simulate, s",
    )
    parser.add_argument("--engine", metavar="E", help="which physics: pinocchio, mujoco")
    parser.add_argument(
        "--seed", type=whole_number("--seed", 0, MAX_SEED), metavar="N", help="seed of random numbers"
    )


def duration_argument(parser: Parser) -> None:
    """How long that push lasts."""
    parser.add_argument(
        "--push-duration",
        type=number("--push-duration", ABOVE_ZERO, MAX_DURATION, "s"),
        metavar="S",
        help="how long it lasts, s; 0.1 unless the scenario says otherwise",
    )


def code_argument(parser: Parser) -> None:
    """A shared run, by its code."""
    parser.add_argument("--code", metavar="CODE", help="a shared run instead of a scenario")
