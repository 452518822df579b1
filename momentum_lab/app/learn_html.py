"""What the lessons' panel shows, as HTML. Every text of a lesson is escaped here."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from momentum_lab.app.learn_style import BLUE, GREEN, INK, LIST, MINE, PALE, RED, STYLE
from momentum_lab.lesson.equation import symbol_mathml
from momentum_lab.lesson.record import EquationRecord, StepRecord
from momentum_lab.plain import plain

LETTERS = "ABCDEFGH"
# A number that is no further from the measured one than this part of what could be predicted is close.
CLOSE = 0.1
# Whoever opens a step begins at its beginning, wherever the step before was left.
_TO_THE_TOP = (
    '<img alt="" src="data:," style="display:none" '
    "onerror=\"this.closest('.mantine-ScrollArea-viewport')?.scrollTo(0,0)\">"
)


def welcome(done: int, count: int, broken: int) -> str:
    """What stands above the list of lessons: how many are done, and how many cannot be opened."""
    faulty = f' <span style="color:{RED}">✖ {broken} cannot be opened.</span>' if broken else ""
    return f"{STYLE}{LIST}" + _box(
        "<h3>Learn</h3>Each lesson asks a question: say what you expect, then watch, then compare. "
        f'<span class="dim">{done} of {count} done.</span>{faulty}'
    )


def heading(number: int, title: str, question: str, place: int, count: int) -> str:
    """Title and question of the lesson, and where in it one is."""
    bar = f'<div class="bar"><div style="width:{100.0 * (place + 1) / count:.0f}%"></div></div>'
    where = f'<span class="dim">Lesson {number} · step {place + 1} of {count}</span>{bar}'
    return _box(f'{STYLE}{_TO_THE_TOP}{where}<h3>{escape(title)}</h3><div class="q">{escape(question)}</div>')


def waiting(title: str) -> str:
    """While a lesson is being prepared."""
    return _box(f"{STYLE}{_TO_THE_TOP}<h3>{escape(title)}</h3>The lesson's runs are being prepared …")


def error(words: str) -> str:
    """What is wrong with a lesson."""
    return _box(
        f'{STYLE}{_TO_THE_TOP}<div class="err" style="color:{RED}" role="alert">'
        f"<b>✖ This lesson has an error.</b><br>{escape(words)}</div>"
        '<span class="dim">The lab goes on without it.</span>'
    )


def text(words: str) -> str:
    """A paragraph."""
    return _box(escape(words))


def claims(failed: Sequence[str]) -> str:
    """Claims that do not hold on this robot."""
    items = "<br>".join(escape(words) for words in failed)
    return _box(f'<div class="err" style="color:{RED}"><b>✖ Not true here:</b><br>{items}</div>')


def said(step: StepRecord, mine: float | None) -> str:
    """A number that is asked for, and what was predicted."""
    answer = (
        "" if mine is None else f'<div class="o mine n"><span>{_number(mine, step)}{_yours()}</span></div>'
    )
    return _box(escape(step.text) + answer)


def compared(step: StepRecord, mine: float | None) -> str:
    """A prediction beside what was measured."""
    if step.options:
        return _box(_compared_choice(step, None if mine is None else int(mine)))
    return _box(_compared_number(step, mine))


def source(seen: bool) -> str:
    """Where the numbers come from."""
    words = (
        "Measured on the runs that you have just seen."
        if seen
        else "Measured on the same runs, played out of sight. Go back to see them."
    )
    return _box(f'<span class="dim">{words}</span>')


def runs(labels: Sequence[str], seen: Sequence[str], on_stage: str) -> str:
    """Which runs there are, which have been seen, and which is on stage."""
    if len(labels) < 2:
        return ""
    items = " &nbsp; ".join(
        f'<span style="white-space:nowrap;{"font-weight:650" if label == on_stage else ""}">'
        f"{'●' if label in seen else '○'} {escape(spoken(label))}</span>"
        for label in labels
    )
    return _box(f'Runs: {items} <span class="dim">(● seen)</span>')


def equation(record: EquationRecord, time: float) -> str:
    """An equation with the numbers of an instant, and how well it holds."""
    words = "".join(
        f'<tr><td><math xmlns="http://www.w3.org/1998/Math/MathML">{symbol_mathml(name)}</math></td>'
        f"<td>{escape(symbol.words)}</td></tr>"
        for name, symbol in record.symbols.items()
    )
    return _box(
        f'<div class="eq n">{record.mathml(time)}</div>'
        f'<div class="n">at <b>{time:.2f} s</b>: both sides differ by <b>{_short(record.difference(time))} '
        f'{escape(record.unit)}</b> <span class="dim">(in most of the run at most {_short(record.residual)}, '
        f'allowed {_short(record.within)})</span></div><table class="dim">{words}</table>'
    )


def spoken(label: str) -> str:
    """A run's label as it is read."""
    return label.replace("_", " ")


def _box(inner: str) -> str:
    return f'<div class="learn">{inner}</div>'


def _yours() -> str:
    return f' <span style="color:{MINE};white-space:nowrap">← your prediction</span>'


def _compared_choice(step: StepRecord, mine: int | None) -> str:
    right = " / ".join(f"{LETTERS[place]} {step.options[place]}" for place in step.right)
    if mine is None or not 0 <= mine < len(step.options):
        return _card(BLUE, step.text, f"Measured: <b>{escape(right)}</b>")
    if mine in step.right:
        return _card(GREEN, step.text, f"<b>✔ As you predicted:</b> {escape(right)}")
    yours = f"{LETTERS[mine]} {step.options[mine]}"
    lines = f"<b>✖ Otherwise.</b> You: {escape(yours)}<br>Measured: <b>{escape(right)}</b>"
    return _card(RED, step.text, lines)


def _compared_number(step: StepRecord, mine: float | None) -> str:
    found = f"Measured: <b>{_number(step.measured, step)}</b>"
    if mine is None:
        return _card(BLUE, step.text, found)
    off = abs(mine - step.measured)
    close = off <= CLOSE * (step.high - step.low)
    verdict = "<b>✔ Close.</b>" if close else f"<b>✖ Off by {_number(off, step)}.</b>"
    lines = f"{verdict} You: {_number(mine, step)} · {found}{_line(step, mine)}"
    return _card(GREEN if close else RED, step.text, lines)


def _line(step: StepRecord, mine: float) -> str:
    """Both numbers on a line from the lowest to the highest that could be predicted."""
    yours, found = (
        10.0 + 280.0 * (min(max(value, step.low), step.high) - step.low) / (step.high - step.low)
        for value in (mine, step.measured)
    )
    return (
        '<svg width="100%" viewBox="0 0 300 34" role="img" aria-label="prediction and measurement on a line">'
        '<path d="M10 14H290" stroke="#9aa3ab" stroke-width="2"/>'
        f'<circle cx="{yours:.0f}" cy="14" r="6" fill="#fff" stroke="{BLUE}" stroke-width="2.5"/>'
        f'<path d="M{found:.0f} 6l7 8-7 8-7-8z" style="fill:{INK}"/>'
        f'<text x="10" y="32" font-size="10" style="fill:{PALE}">{step.low:g}</text>'
        f'<text x="290" y="32" font-size="10" style="fill:{PALE}" text-anchor="end">{step.high:g}</text>'
        f'<text x="150" y="32" font-size="10" style="fill:{PALE}" text-anchor="middle">○ you · ◆ measured</text>'
        "</svg>"
    )


def _card(color: str, question: str, lines: str) -> str:
    return (
        f'<div class="card n" style="border-color:{color}"><span class="dim">{escape(question)}</span>'
        f"<br>{lines}</div>"
    )


def _number(value: float, step: StepRecord) -> str:
    return f"{_short(value)} {escape(step.unit)}".strip()


def _short(value: float) -> str:
    """A number with three figures, its power of ten written as people do."""
    figures, _, power = plain(value, ".3g").partition("e")
    written = f"{figures}\u202f·\u202f10<sup>{int(power)}</sup>" if power else figures
    return written.replace("-", "−")
