"""The report of a run: one HTML file with figures, numbers, gains, what was done, what was checked, and limits."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import msgspec
import numpy as np

from momentum_lab.control.gains import declared_gains
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import InputError
from momentum_lab.events import MoveGround, SessionEvent, SetFriction
from momentum_lab.experiments.both import both, different
from momentum_lab.experiments.claims import Claim, at_most
from momentum_lab.experiments.outcome import outcome
from momentum_lab.experiments.run_plots import on_the_ground, over_time, png
from momentum_lab.finished import FinishedRun
from momentum_lab.headless import Timing
from momentum_lab.physics.push import Push
from momentum_lab.plain import plain
from momentum_lab.provenance import versions
from momentum_lab.share_code import to_code
from momentum_lab.summary import Summary, summarize

# Residuals larger than these would be faults of the lab and not of a controller, parts of m g.
_EXACT = 1e-9
_MOST_EVENTS = 200
# A force may leave the friction cone by this part of the weight: the contact solver's own accuracy.
_CONE = 1e-6
_LIMITS = (
    "The robot is a chain of rigid bodies with ideal motors: no elasticity, no delay, no noise, full knowledge of "
    "the state. Contacts are rigid, with Coulomb friction under flat soles. It never takes a step.",
    "A fall is a CoM below 0.6 of its height or a touch by anything but a sole; what happens afterwards is not "
    "a prediction.",
    "Numbers are of this one run. They say nothing about other pushes, robots or gains.",
    "The same code gives the same bits with the versions below; other versions or machines may differ in the "
    "last digits.",
)
_STYLE = """
body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:60em;margin:2em auto;padding:0 1em}
h1{font-size:1.6em;margin-bottom:.1em}h2{font-size:1.15em;margin-top:1.8em;border-bottom:1px solid #ddd}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:.15em .9em .15em 0;text-align:left;
vertical-align:top}th{font-weight:600}img{max-width:100%}.dim{color:#6b6b6b}.yes{color:#007a59}.no{color:#c43d00}
.result{font-size:1.25em;font-weight:600}code{word-break:break-all;font-size:.85em;background:#f4f4f2;
padding:.4em;display:block}.changed{font-weight:600}
"""


def report(run: FinishedRun) -> bytes:
    """The report as one HTML file that needs nothing else.

    Raises:
        InputError: nothing has been recorded.
    """
    if not len(run.recording):
        raise InputError("report", "a run without samples", "a run of at least one tick")
    robots = tuple((name, each, summarize(each, Timing(np.zeros(0), math.inf))) for name, each in both(run))
    title = run.scenario.title or run.scenario.name
    parts = (
        f"<h1>{escape(title)}</h1>",
        f'<p class="dim">{escape(_setting(run))}</p>',
        *(
            f'<p class="result">{escape(_of(name, outcome(each, summary)))}</p>'
            for name, each, summary in robots
        ),
        _section("Numbers", _numbers(robots)),
        *([_section("What differs", _differences(run))] if len(robots) > 1 else []),
        _section("Over time", _image(png(over_time(run)), "points, momentum rates and momenta over time")),
        _section("On the ground", _image(png(on_the_ground(run)), "paths of CoM and CoP under the feet")),
        _section("Pushes", _pushes(run)),
        _section(_headed("Gains", robots[0][0]), _gains(run)),
        _section("What was done", _events(run)),
        *(
            _section(_headed("What was checked", name), _claims(checks(each, summary)))
            for name, each, summary in robots
        ),
        _section("Limits", "".join(f"<p>{escape(line)}</p>" for line in _LIMITS)),
        _section("Run it again", _again(run)),
    )
    page = (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f"<style>{_STYLE}</style></head><body>{''.join(parts)}</body></html>\n"
    )
    return page.encode()


def checks(run: FinishedRun, summary: Summary) -> list[Claim]:
    """What has to hold in any run, whatever the controller does."""
    claims = [
        at_most(
            "Momentum changes as the forces say (Eq. 20)", summary.max_equation_residual, _EXACT, "of m g"
        ),
        at_most("Solves without an answer", float(summary.qp_failures), 0.0, "ticks"),
    ]
    return claims + _contact_checks(run) if _on_the_floor(run) else claims


def _on_the_floor(run: FinishedRun) -> bool:
    """Whether the ground was level and as slippery as at first all the time: its normal is then the vertical."""
    changed = any(isinstance(entry.event, MoveGround | SetFriction) for entry in run.log)
    return not changed and not run.scenario.ground


def _contact_checks(run: FinishedRun) -> list[Claim]:
    forces = run.recording.column("foot_wrench_measured")[:, :, :3]
    weight = run.robot.mass * 9.81
    friction = run.robot.spec.friction if run.scenario.friction is None else run.scenario.friction
    beyond = np.hypot(forces[..., 0], forces[..., 1]) - friction * forces[..., 2]
    return [
        at_most("The ground only pushes", float(-forces[..., 2].min()) / weight, _CONE, "of m g"),
        at_most("Friction stays within its cone", float(beyond.max()) / weight, _CONE, "of m g"),
    ]


def _setting(run: FinishedRun) -> str:
    words = (
        run.robot.spec.title,
        CONTROLLERS[run.choices.controller].title,
        f"planner {run.choices.planner}",
        f"priority {run.choices.priority:g} (0 keeps linear momentum, 1 angular)",
        f"scenario {run.scenario.name}",
        f"seed {run.scenario.seed}",
    )
    return " · ".join(words)


def _of(name: str, words: str) -> str:
    """A sentence about one of two robots; about one that is alone without a name."""
    return f"{name}: {words[:1].lower()}{words[1:]}" if name else words


def _headed(words: str, name: str) -> str:
    """A heading about one of two robots."""
    return f"{words}: {name}" if name else words


def _numbers(robots: Sequence[tuple[str, FinishedRun, Summary]]) -> str:
    """A column for each robot."""
    columns = [_figures(summary) for _, _, summary in robots]
    rows = [(row[0][0], *(value for _, value in row)) for row in zip(*columns, strict=True)]
    alone = len(robots) == 1
    return _table(rows if alone else [("", *(name for name, _, _ in robots)), *rows], headed=not alone)


def _differences(run: FinishedRun) -> str:
    rows = [(name, *values) for name, values in different(run).items()]
    head = ("", *(name for name, _ in both(run)))
    return _table([head, *rows], headed=True) if rows else "<p>Nothing was chosen differently.</p>"


def _figures(summary: Summary) -> list[tuple[str, str]]:
    margin = (
        "never supported"
        if summary.min_cop_margin is None
        else f"{plain(1e3 * summary.min_cop_margin, '.1f')} mm"
    )
    return [
        ("impulse of all pushes", f"{summary.impulse:.2f} N s"),
        ("largest push against what a CoP alone can catch", f"{summary.impulse_ratio:.2f}"),
        ("CoM moved at most", f"{1e3 * summary.peak_com_excursion:.1f} mm"),
        ("angular momentum at most", f"{summary.peak_angular_momentum:.2f} kg m²/s"),
        ("smallest margin of the CoP", margin),
        ("largest torque asked for", f"{summary.peak_torque_ratio:.2f} of its motor's limit"),
    ]


def _pushes(run: FinishedRun) -> str:
    rows = [
        (
            f"{push.start:.3f} s",
            f"{push.force or 0.0:.1f} N",
            f"{1e3 * push.duration:.0f} ms",
            push.towards,
            _where(push),
            push.body or "trunk",
            f"{push.impulse:.2f} N s",
        )
        for push in run.pushes
    ]
    head = ("start", "force", "for", "direction", "where", "body", "impulse")
    return _table([head, *rows], headed=True) if rows else "<p>None.</p>"


def _where(push: Push) -> str:
    if push.point is not None:
        x, y, z = push.point
        return f"at ({x:g}, {y:g}, {z:g}) m of the body"
    return "through the CoM" if push.height is None else f"at {push.height:g} m"


def _gains(run: FinishedRun) -> str:
    rows: list[tuple[str, ...]] = [("gain", "value", "default", "what it does")]
    changed = set()
    for number, (name, gain) in enumerate(declared_gains(run.choices.gains).items()):
        value = float(getattr(run.choices.gains, name))
        if value != gain.default:
            changed.add(number + 1)
        unit = "" if gain.unit == "1" else f" {gain.unit}"
        rows.append((name.replace("_", " "), f"{value:g}{unit}", f"{gain.default:g}", gain.help))
    return _table(rows, headed=True, marked=changed)


def _events(run: FinishedRun) -> str:
    step = run.scenario.timestep
    rows = [(f"{step * entry.tick:.3f} s", _said(entry.event)) for entry in run.run.events]
    left = f"<p>and {len(rows) - _MOST_EVENTS} more.</p>" if len(rows) > _MOST_EVENTS else ""
    return _table(rows[:_MOST_EVENTS]) + left if rows else "<p>Nothing: the scenario ran as it is.</p>"


def _said(event: SessionEvent) -> str:
    """An event in words: its name in small letters, then what it holds."""
    data = msgspec.to_builtins(event)
    name = "".join(f" {letter.lower()}" if letter.isupper() else letter for letter in data.pop("type"))
    return f"{name.strip()}: {', '.join(_short(value) for value in data.values())}".removesuffix(": ")


def _short(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key} {_short(inner)}" for key, inner in value.items() if inner is not None)
    if isinstance(value, list | tuple):
        return "; ".join(_short(inner) for inner in value)
    return plain(value, "g") if isinstance(value, float) else str(value)


def _claims(claims: Iterable[Claim]) -> str:
    rows = "".join(
        f'<tr><td class="{"yes" if claim.holds else "no"}">{"holds" if claim.holds else "does not hold"}</td>'
        f"<td>{escape(claim.text)}</td><td>{_short(claim.measured)}</td><td>{escape(claim.allowed)}</td></tr>"
        for claim in claims
    )
    return f"<table>{rows}</table>"


def _again(run: FinishedRun) -> str:
    made = ", ".join(f"{name} {version}" for name, version in versions().items())
    try:
        code = to_code(run.run)
        words = (
            f"<p>momentum-lab app --code CODE, or momentum-lab run --code CODE, with</p><code>{code}</code>"
        )
    except InputError:
        words = "<p>This run is too long for a code: keep its run file.</p>"
    return f'{words}<p class="dim">Made with {escape(made)}.</p>'


def _section(title: str, content: str) -> str:
    return f"<h2>{escape(title)}</h2>{content}"


def _table(rows: Sequence[tuple[str, ...]], headed: bool = False, marked: Iterable[int] = ()) -> str:
    marked = set(marked)
    lines = []
    for number, row in enumerate(rows):
        cell = "th" if headed and number == 0 else "td"
        look = ' class="changed"' if number in marked else ""
        lines.append(f"<tr{look}>{''.join(f'<{cell}>{escape(text)}</{cell}>' for text in row)}</tr>")
    return f"<table>{''.join(lines)}</table>"


def _image(data: bytes, words: str) -> str:
    return f'<img alt="{escape(words)}" src="data:image/png;base64,{base64.b64encode(data).decode()}">'
