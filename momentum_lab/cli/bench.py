"""momentum-lab bench: how fast the lab is on this machine."""

from __future__ import annotations

import os
from argparse import Namespace
from typing import Any

import msgspec
from rich.box import SIMPLE
from rich.console import Console
from rich.table import Table

from momentum_lab.app.figures import Figure, figures
from momentum_lab.bench.measure import ROBOTS, Percentiles, RobotBench, measure
from momentum_lab.bench.profile import ProfileRow, profile, stages_of
from momentum_lab.bench.stages import STAGES
from momentum_lab.cli.progress import progress
from momentum_lab.errors import InputError
from momentum_lab.provenance import versions
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

_SECONDS = 20.0
_REACHED = {True: "yes", False: "NO", None: ""}
_LABELS = {
    "state_terms": "state terms",
    "controller": "controller",
    "physics": "physics",
    "recording": "recording",
    "tick": "whole tick",
    "placo_solve": "PlaCo solve()",
    "peer_tick": "PlaCo + MuJoCo tick",
    "peer_placo": "  PlaCo",
    "peer_mujoco": "  MuJoCo",
}
_BAR = 20


def bench(args: Namespace) -> int:
    """Print the speed of each part of a tick for TALOS and G1, or of the app with one client.

    Raises:
        InputError: the time is given twice.
    """
    seconds = _seconds(args)
    if args.app:
        return _bench_app(seconds, args.json)
    if args.profile:
        return _profile(args)
    results = []
    for name in ROBOTS:
        with progress(f"measuring {name}") as report:
            results.append(measure(name, seconds / len(ROBOTS), report))
    if args.json:
        print(_as_json({"robots": results}))
    else:
        _show(results)
    return 0


def _seconds(args: Namespace) -> float:
    if args.minutes is None:
        return _SECONDS if args.seconds is None else float(args.seconds)
    if args.seconds is not None:
        raise InputError("minutes", f"{args.minutes:g}", "either --minutes or --seconds")
    return 60.0 * float(args.minutes)


def _bench_app(seconds: float, as_json: bool) -> int:
    from momentum_lab.app.measure import measure_app

    with progress("measuring the app") as report:
        measured = measure_app(seconds, report=report)
    if as_json:
        print(_as_json({"app": measured, "figures": figures(measured)}))
    else:
        _show_app(seconds, figures(measured))
    return 0


def _show_app(seconds: float, lines: list[Figure]) -> None:
    table = Table(title=f"The app with one client, {seconds:g} s", box=SIMPLE)
    for heading, justify in (("", "left"), ("measured", "right"), ("to reach", "left"), ("reached", "left")):
        table.add_column(heading, justify=justify)  # type: ignore[arg-type]
    for line in lines:
        table.add_row(line.name, line.value, line.bound, _REACHED[line.reached])
    table.caption = f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors"
    Console(markup=False).print(table)


def _as_json(results: dict[str, Any]) -> str:
    machine = {"cpus": os.cpu_count(), "load_average": os.getloadavg()[0]}
    return msgspec.json.encode({"versions": versions(), "machine": machine, **results}).decode()


def _show(results: list[RobotBench]) -> None:
    table = Table(title="Standing on both feet, 1 kHz")
    table.add_column("us: median, 99 %")
    for result in results:
        table.add_column(result.robot, justify="right")
    for field in (*STAGES, "tick"):
        table.add_row(_LABELS[field], *(_text(getattr(result, field)) for result in results))
    table.add_row("real-time factor", *(f"{result.real_time_factor:.2f}" for result in results))
    table.add_section()
    for field in ("peer_tick", "peer_placo", "peer_mujoco", "placo_solve"):
        table.add_row(_LABELS[field], *(_text(getattr(result, field)) for result in results))
    table.add_row("tick / PlaCo + MuJoCo tick", *(_ratio(result.tick_to_peer) for result in results))
    table.add_section()
    table.add_row("calls per tick", *(f"{result.calls_per_tick:.0f}" for result in results))
    missing = next((f"{result.missing}\n" for result in results if result.missing), "")
    table.caption = f"{missing}load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors"
    Console(markup=False).print(table)


def _text(times: Percentiles | None) -> str:
    return "-" if times is None else f"{times.p50:.0f}  {times.p99:.0f}"


def _ratio(ratio: float | None) -> str:
    return "-" if ratio is None else f"{ratio:.2f}"


def _profile(args: Namespace) -> int:
    """Print where the time of a tick goes, call by call."""
    trees = {name: profile(Session(Scenario("profile", robot=name))) for name in ROBOTS}
    if args.json:
        print(_as_json({"profile": msgspec.to_builtins(trees)}))
        return 0
    for name, rows in trees.items():
        _show_profile(name, rows)
    return 0


def _stages(name: str, rows: list[ProfileRow]) -> Table:
    table = Table(title=f"A tick of {name}, stage by stage", box=None)
    table.add_column("stage", min_width=30)
    table.add_column("us", justify="right", min_width=6)
    table.add_column("share of the tick", min_width=_BAR)
    for stage, total in stages_of(rows).items():
        table.add_row(stage, f"{total:.1f}", _bar(total / rows[0].total))
    return table


def _bar(share: float) -> str:
    return "\u2588" * round(_BAR * share)


def _show_profile(name: str, rows: list[ProfileRow]) -> None:
    console = Console(markup=False)
    console.print(_stages(name, rows))
    table = Table(title=f"A tick of {name}, call by call", box=None)
    width = max(30, console.width - _BAR - 30)  # the numbers are worth more than the ends of names
    table.add_column("function", overflow="ellipsis", no_wrap=True, max_width=width)
    for heading in ("calls", "own us", "us"):
        table.add_column(heading, justify="right", no_wrap=True, min_width=6)
    table.add_column("share of the tick", min_width=_BAR)
    for row in rows:
        bar = _bar(row.total / rows[0].total)
        numbers = (f"{row.calls:.1f}", f"{row.own:.1f}", f"{row.total:.1f}")
        table.add_row(f"{'  ' * row.depth}{row.name}", *numbers, bar)
    table.caption = "being watched makes every call about a microsecond slower"
    console.print(table)
