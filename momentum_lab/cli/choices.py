"""The scenario that a command line asks for."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

import msgspec

from momentum_lab.cli.values import as_number
from momentum_lab.control.gains import with_gains
from momentum_lab.control.presets import preset_named
from momentum_lab.control.registry import controller_entry
from momentum_lab.errors import GainError, InputError
from momentum_lab.physics.mismatch import Mismatch, with_error
from momentum_lab.physics.push import Push
from momentum_lab.run_file import Run
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.share_code import from_code

_FIELDS = (
    "robot",
    "controller",
    "controlled",
    "planner",
    "motion",
    "angular_goal",
    "ground_sense",
    "friction",
    "priority",
    "seconds",
    "engine",
    "seed",
)
_DEFAULT_START = 0.5


def chosen_run(args: Namespace) -> Run:
    """The run of a code, or the named scenario, with everything that the options change.

    Raises:
        InputError: something is unknown or out of range.
    """
    if args.code is None:
        return Run(chosen_scenario(args))
    if args.scenario:
        raise InputError("--code", args.code, "either a code or a scenario")
    run = from_code(args.code)
    scenario = _with_options(run.scenario, args)
    if scenario == run.scenario:
        return run
    ticks = run.ticks if args.__dict__.get("seconds") is None else 0
    return msgspec.structs.replace(run, scenario=scenario, ticks=ticks, end="")


def chosen_scenario(args: Namespace) -> Scenario:
    """The named scenario with everything that the options change.

    Raises:
        InputError: something is unknown or out of range.
    """
    return _with_options(load_scenario(args.scenario), args)


def _with_options(scenario: Scenario, args: Namespace) -> Scenario:
    given = vars(args)
    changes: dict[str, Any] = {name: given[name] for name in _FIELDS if given.get(name) is not None}
    changes["gains"] = _gains(given.get("set", []), args.controller, args.preset, scenario)
    changes["pushes"] = _pushes(given, scenario)
    changes["mismatch"] = _mismatch(given.get("mismatch", []), scenario.mismatch)
    return changed(scenario, **changes)


def _gains(
    settings: list[tuple[str, str]], controller: str | None, preset: str | None, scenario: Scenario
) -> dict[str, float]:
    """The preset's gains, or the scenario's if they are this controller's, and those that were set."""
    kept = scenario.gains if controller in (None, scenario.controller) else {}
    if preset is not None:
        kept = preset_named(preset, controller or scenario.controller).gains
    gains = controller_entry(controller or scenario.controller).gains
    values: dict[str, Any] = {}
    for name, text in settings:
        values[name] = as_number(text)
        try:
            with_gains(gains, {name: values[name]})
        except GainError as error:
            unknown = error.argument == "gain"
            argument, given = ("--set", name) if unknown else (f"--set {name}", text)
            raise GainError(argument, given, error.allowed) from error
    return {**kept, **values}


def _mismatch(settings: list[tuple[str, str]], mismatch: Mismatch) -> Mismatch:
    """The scenario's mismatch with what was set."""
    for name, text in settings:
        value = as_number(text)
        try:
            mismatch = with_error(mismatch, name, value)
        except InputError as error:
            unknown = error.argument == "mismatch"
            argument, given = ("--mismatch", name) if unknown else (f"--mismatch {name}", text)
            raise InputError(argument, given, error.allowed) from error
    return mismatch


def _pushes(given: dict[str, Any], scenario: Scenario) -> tuple[Push, ...]:
    """One rectangular push of the given force, or the scenario's own with what was given changed in each."""
    options = {"duration": "push_duration", "direction_deg": "push_direction", "height": "push_height"}
    details = {field: given[name] for field, name in options.items() if given.get(name) is not None}
    force = given.get("push")
    if force is not None:
        start = scenario.pushes[0].start if scenario.pushes else _DEFAULT_START
        return (Push(force=force, start=start, **details),) if force > 0.0 else ()
    if details and not scenario.pushes:
        field, value = next(iter(details.items()))
        option = f"--{options[field]}".replace("_", "-")
        raise InputError(option, f"{value:g}", f"together with --push N, because {scenario.name} has no push")
    return tuple(msgspec.structs.replace(push, **details) for push in scenario.pushes)
