"""momentum-lab robot-check: a robot's file from its URDF, and whether the robot stands and takes a push."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
from rich.console import Console
from rich.table import Table

from momentum_lab.cli.progress import interruptible, progress
from momentum_lab.errors import InputError, RobotError
from momentum_lab.experiments.robot_check import RATIO, Trial, trials
from momentum_lab.robot.catalog import RobotSpec, load_spec, robot_names
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.proposal import Remark, propose
from momentum_lab.robot.urdf import robot_data_folder
from momentum_lab.robot.writing import robot_toml
from momentum_lab.trace import writable_file

_FALLS = 1


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A robot to check, what there is to say about it, and why it cannot be tried, if it cannot."""

    spec: RobotSpec
    remarks: tuple[Remark, ...] = ()
    fault: str = ""


def robot_check(args: Namespace) -> int:
    """Propose a robot's file or read one, stand the robot up, push it, and print the verdicts.

    Returns:
        0 when it stands after a push in each of four directions, 1 when it does not or cannot be tried.

    Raises:
        InputError: the file cannot be read, is no robot, or a frame is unknown.
        KeyboardInterrupt: Ctrl+C.
    """
    out = None if args.out is None else writable_file(Path(args.out))
    candidate = _candidate(args)
    if out is not None:
        remarks = [f"{remark.grade}: {remark.text}" for remark in candidate.remarks]
        out.write_text(robot_toml(candidate.spec, remarks))
    tried, fault = _tried(candidate)
    passed = len(tried) > 1 and all(trial.stands for trial in tried)
    if args.json:
        print(msgspec.json.encode(_report(candidate, tried, fault, passed)).decode())
    else:
        _show(candidate, tried, fault)
        if out is not None:
            print(f"robot: {out}")
    return 0 if passed else _FALLS


def _candidate(args: Namespace) -> _Candidate:
    """The robot that was named."""
    if not args.robot.lower().endswith(".urdf"):
        soles = None if args.soles is None else ",".join(args.soles)
        for option, value in (("--soles", soles), ("--out", args.out)):
            if value is not None:
                raise InputError(option, value, "together with a .urdf; a robot's .toml is only checked")
        if not args.robot:
            raise InputError(
                "robot", "nothing", f"a .urdf, a robot's .toml, or one of {', '.join(robot_names())}"
            )
        return _Candidate(load_spec(args.robot))
    urdf = _urdf(args.robot)
    proposal = propose(urdf, args.soles or ())
    return _Candidate(proposal.spec, proposal.remarks, proposal.fault)


def _urdf(text: str) -> Path:
    """A file here, or one in the robot-data package."""
    for path in (Path(text), robot_data_folder() / text):
        if path.is_file():
            return path
    raise RobotError("robot", text, "a .urdf that exists, here or in the robot-data package")


def _tried(candidate: _Candidate) -> tuple[list[Trial], str]:
    """The trials of a robot, and why there are none if it cannot stand."""
    if candidate.fault:
        return [], candidate.fault
    robot = RobotModel(candidate.spec)
    with interruptible() as stopped, progress(candidate.spec.name) as told:

        def proceed(fraction: float) -> bool:
            told(fraction)
            return not stopped.is_set()

        try:
            done = trials(robot, proceed)
        except RobotError as error:
            return [], f"{error.argument}: {error.given}"
    if stopped.is_set():
        raise KeyboardInterrupt
    return done, ""


def _report(candidate: _Candidate, tried: list[Trial], fault: str, passed: bool) -> dict[str, Any]:
    return {
        "robot": msgspec.to_builtins(candidate.spec),
        "remarks": msgspec.to_builtins(candidate.remarks),
        "fault": fault,
        "trials": msgspec.to_builtins(tried),
        "passed": passed,
    }


def _show(candidate: _Candidate, tried: list[Trial], fault: str) -> None:
    """Remarks and verdicts for people, on stdout."""
    console = Console(markup=False, highlight=False)
    if candidate.remarks:
        remarks = Table(
            "", "what to look at", title=f"{candidate.spec.title}: from the URDF", title_justify="left"
        )
        for remark in candidate.remarks:
            remarks.add_row(remark.grade, remark.text)
        console.print(remarks)
    if fault:
        console.print(f"{candidate.spec.title} cannot stand: {fault}")
        return
    title = f"{candidate.spec.title}: pushes of {RATIO:g} of what a pendulum survives on its CoP"
    verdicts = Table("push", "N", "verdict", "CoM moved", "torque", "why", title=title, title_justify="left")
    for trial in tried:
        verdicts.add_row(
            trial.direction,
            f"{trial.force:.0f}",
            _verdict(trial),
            f"{1e3 * trial.peak_com_excursion:.0f} mm",
            f"{trial.peak_torque_ratio:.0%}",
            trial.why,
        )
    console.print(verdicts)


def _verdict(trial: Trial) -> str:
    if not trial.stands:
        return "FALLS"
    return "stands still" if trial.settled else "stands"
