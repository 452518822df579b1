"""momentum-lab bench: how fast the lab is on this machine."""

from __future__ import annotations

import os
from argparse import Namespace
from typing import Any

import msgspec
from rich.console import Console
from rich.table import Table

from momentum_lab.bench.measure import ROBOTS, Percentiles, RobotBench, measure
from momentum_lab.bench.stages import STAGES
from momentum_lab.cli.progress import progress
from momentum_lab.provenance import versions

_LABELS = {
    "state_terms": "state terms",
    "controller": "controller",
    "physics": "physics",
    "recording": "recording",
    "tick": "whole tick",
    "placo_solve": "PlaCo solve()",
}


def bench(args: Namespace) -> int:
    """Print the speed of each part of a tick for TALOS and G1, or of the app with one client."""
    if args.app:
        return _bench_app(args)
    results = []
    for name in ROBOTS:
        with progress(f"measuring {name}") as report:
            results.append(measure(name, args.seconds / len(ROBOTS), report))
    if args.json:
        print(_as_json({"robots": results}))
    else:
        _show(results)
    return 0


def _bench_app(args: Namespace) -> int:
    from momentum_lab.app.bare_client import measure_app

    measured = msgspec.to_builtins(measure_app(args.seconds))
    if args.json:
        print(_as_json({"app": measured}))
        return 0
    table = Table(title="The app with one client", show_header=False)
    for name, value in measured.items():
        table.add_row(name.replace("_", " "), f"{value:.3g}" if isinstance(value, float) else str(value))
    Console(markup=False).print(table)
    return 0


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
    table.add_row(_LABELS["placo_solve"], *(_text(result.placo_solve) for result in results))
    table.caption = f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors"
    Console(markup=False).print(table)


def _text(times: Percentiles) -> str:
    return f"{times.p50:.0f}  {times.p99:.0f}"
