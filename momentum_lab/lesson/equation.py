"""An equation written as one readable line: evaluated on a recording, and drawn as MathML with its numbers."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np

from momentum_lab.errors import InputError
from momentum_lab.experiments.measured import times, upright
from momentum_lab.lesson.parsing import parsed
from momentum_lab.plain import plain
from momentum_lab.session import Session

_GREEK = {
    "alpha": "α",
    "delta": "δ",
    "omega": "ω",
    "Gamma": "Γ",
    "tau": "τ",
    "theta": "θ",
    "xi": "ξ",
    "zeta": "ζ",
}
_DOTS = {"": "", "d": "˙", "dd": "¨"}
_FUNCTIONS: dict[str, Callable[[np.ndarray], np.ndarray]] = {"sqrt": np.sqrt, "exp": np.exp, "abs": np.abs}
_SIGNS = {ast.Add: ("+", np.add), ast.Sub: ("−", np.subtract), ast.Mult: ("⋅", np.multiply)}
_RANK = {ast.Add: 1, ast.Sub: 1, ast.Mult: 2}
_ALLOWED = "one '=' between names, numbers, + - * / **, brackets, sqrt, exp, abs"


@dataclass(frozen=True, slots=True)
class Symbol:
    """A quantity of an equation.

    Attributes:
        values: the quantity over time (n,) or as one number, from a session that has run.
        unit: of the values.
        words: what it is.
        spec: how its number is written, a Python format.
    """

    values: Callable[[Session], np.ndarray | float]
    unit: str
    words: str
    spec: str = ".0f"


@dataclass(frozen=True, slots=True)
class Equation:
    """Two sides that a run has to make equal.

    A name is a letter or a Greek letter's name, after `_` its index; `d` or `dd` before it are time derivatives:
    `dk_y = f_z * (s_x - p_x)`.

    Attributes:
        text: the equation.
        symbols: name -> quantity.
        within: the largest difference of both sides.
        unit: of the difference.
        share: the part of the ticks on which it has to hold; the others may hold a jump.
        since: the time from which it has to hold, s.

    Raises:
        InputError: the text is no equation, or one of its names is no symbol.
    """

    text: str
    symbols: Mapping[str, Symbol]
    within: float
    unit: str
    share: float = 1.0
    since: float = 0.0

    def __post_init__(self) -> None:
        for name in _quantities(self.text):
            if name not in self.symbols:
                raise InputError("symbol", name, f"one of {', '.join(self.symbols)}")


def sides(text: str) -> tuple[ast.expr, ast.expr]:
    """Both sides of an equation as trees.

    Raises:
        InputError: the text holds something that an equation may not.
    """
    try:
        left, right = (parsed(side.strip(), mode="eval").body for side in text.split("="))
    except (SyntaxError, ValueError) as error:
        raise InputError("equation", text, _ALLOWED) from error
    for side in (left, right):
        _write(side, {}, text)
    return left, right


def course(equation: Equation, session: Session) -> dict[str, np.ndarray]:
    """What every symbol is over time (n,), or as one number ().

    Differences over a tick are one shorter than what they come from: all are cut to the shortest.
    """
    found = {name: np.asarray(symbol.values(session)) for name, symbol in equation.symbols.items()}
    length = min((len(value) for value in found.values() if value.ndim), default=1)
    return {name: value[:length] if value.ndim else value for name, value in found.items()}


def apart(equation: Equation, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """How far both sides differ over time (n,), in the equation's unit."""
    # A robot without a force under it divides by zero: those ticks do not count, or they spoil the claim.
    with np.errstate(all="ignore"):
        left, right = (np.asarray(_number(side, values)) for side in sides(equation.text))
    return np.atleast_1d(np.abs(left - right))


def residual(equation: Equation, session: Session) -> float:
    """Largest difference of both sides on the given share of the ticks, in the equation's unit; NaN without any."""
    difference = apart(equation, course(equation, session))
    counted = (upright(session) & (times(session) >= equation.since))[: len(difference)]
    difference = difference[counted] if len(difference) > 1 else difference
    return float(np.percentile(difference, 100.0 * equation.share)) if difference.size else float("nan")


def numbers(equation: Equation, session: Session, time: float) -> dict[str, float]:
    """What every symbol is at a time (s) of a run, or at its nearest end."""
    found = {}
    for name, value in course(equation, session).items():
        tick = min(round(time / session.scenario.timestep), np.size(value) - 1)
        found[name] = float(np.atleast_1d(value)[tick])
    return found


def mathml(equation: Equation, values: Mapping[str, float]) -> str:
    """The equation as one MathML element, each symbol over its number; without values, bare."""
    symbols = equation.symbols
    labels = {
        name: f"{plain(value, symbols[name].spec)} {symbols[name].unit}" for name, value in values.items()
    }
    return labelled(equation.text, labels)


def labelled(text: str, labels: Mapping[str, str]) -> str:
    """An equation as one MathML element, each symbol over its label."""
    left, right = sides(text)
    labels = {name: label.strip() for name, label in labels.items()}
    body = f"{_write(left, labels, text)}<mo>=</mo>{_write(right, labels, text)}"
    namespace = 'xmlns="http://www.w3.org/1998/Math/MathML"'
    return f'<math {namespace} display="block"><mrow>{body}</mrow></math>'


def _quantities(text: str) -> list[str]:
    """The names of an equation that stand for quantities."""
    names = [node.id for side in sides(text) for node in ast.walk(side) if isinstance(node, ast.Name)]
    return [name for name in names if name not in _FUNCTIONS]


def _number(node: ast.expr, values: Mapping[str, np.ndarray]) -> np.ndarray:
    match node:
        case ast.Name(id=name):
            return values[name]
        case ast.Constant(value=number):
            return np.asarray(number)
        case ast.UnaryOp(operand=operand):
            return -_number(operand, values)
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            return _FUNCTIONS[name](_number(argument, values))
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return _number(left, values) / _number(right, values)
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return _number(left, values) ** _number(right, values)
        case ast.BinOp(left=left, op=op, right=right):
            return _SIGNS[type(op)][1](_number(left, values), _number(right, values))
    raise InputError("equation", ast.unparse(node), _ALLOWED)


def _write(node: ast.expr, labels: Mapping[str, str], text: str) -> str:
    """A tree as MathML."""
    match node:
        case ast.Name(id=name):
            return _labelled(symbol_mathml(name), labels.get(name))
        case ast.Constant(value=int() | float() as number):
            return f"<mn>{number:g}</mn>"
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return f"<mrow><mo>−</mo>{_bracketed(operand, 2, labels, text)}</mrow>"
        case ast.Call(func=ast.Name(id="sqrt"), args=[argument]):
            return f"<msqrt>{_write(argument, labels, text)}</msqrt>"
        case ast.Call(func=ast.Name(id="abs"), args=[argument]):
            return f"<mrow><mo>|</mo>{_write(argument, labels, text)}<mo>|</mo></mrow>"
        case ast.Call(func=ast.Name(id="exp"), args=[argument]):
            return f"<msup><mi>e</mi>{_write(argument, labels, text)}</msup>"
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return f"<mfrac>{_write(left, labels, text)}{_write(right, labels, text)}</mfrac>"
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            return f"<msup>{_bracketed(left, 3, labels, text)}{_write(right, labels, text)}</msup>"
        case ast.BinOp(left=left, op=ast.Add() | ast.Sub() | ast.Mult() as op, right=right):
            rank = _RANK[type(op)]
            first = _bracketed(left, rank, labels, text)
            second = _bracketed(right, rank + isinstance(op, ast.Sub), labels, text)
            return f"<mrow>{first}<mo>{_SIGNS[type(op)][0]}</mo>{second}</mrow>"
    raise InputError("equation", text, _ALLOWED)


def _bracketed(node: ast.expr, rank: int, labels: Mapping[str, str], text: str) -> str:
    """A part of a tree, in brackets if it binds less than what it stands in."""
    written = _write(node, labels, text)
    loose = isinstance(node, ast.BinOp) and _RANK.get(type(node.op), 3) < rank
    return f"<mrow><mo>(</mo>{written}<mo>)</mo></mrow>" if loose else written


def symbol_mathml(name: str) -> str:
    """A name as MathML: dots for derivatives, a Greek letter, an index."""
    base, _, index = name.partition("_")
    letters = "|".join(("[A-Za-z]", *_GREEK))
    found = re.fullmatch(rf"(d{{0,2}})({letters})", base)
    dots, letter = (found[1], found[2]) if found and base not in _GREEK else ("", base)
    written = f"<mi>{escape(_GREEK.get(letter, letter))}</mi>"
    if dots:
        written = f"<mover><mrow>{written}</mrow><mo>{_DOTS[dots]}</mo></mover>"
    return f"<msub>{written}<mi>{escape(index)}</mi></msub>" if index else written


def _labelled(symbol: str, label: str | None) -> str:
    if label is None:
        return symbol
    # Figures under neighbours must not touch each other.
    gap = '<mspace width="0.15em"/>'
    return f"<mrow>{gap}<munder>{symbol}<mtext>{escape(label)}</mtext></munder>{gap}</mrow>"
