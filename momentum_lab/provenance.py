"""Where a trace comes from: everything that is needed to run it again."""

from __future__ import annotations

from importlib import metadata
from typing import Any

import msgspec

from momentum_lab import __version__
from momentum_lab.finished import FinishedRun
from momentum_lab.physics.engines import Engine
from momentum_lab.session import Session

_LIBRARIES = ("pin", "numpy", "placo", "daqp", "scipy", "example-robot-data")


def provenance(session: Session | FinishedRun) -> dict[str, Any]:
    """What the meta entry of a trace says, as plain data that goes to JSON.

    Versions; the scenario as it was run; controller, gains, priority and mismatch as they are now; how many ticks it
    has lasted, and the log of events;
    and the robot: its URDF as a path relative to the folder `robots` of the example-robot-data distribution
    (absolute if it lies elsewhere), mass (kg), and for each foot its sole frame and rectangle (m).
    """
    robot = session.robot
    return {
        "versions": {**versions(), **_engine_version(session.scenario.engine)},
        "scenario": msgspec.to_builtins(session.scenario),
        "controller": session.choices.controller,
        "gains": msgspec.to_builtins(session.choices.gains),
        "priority": session.choices.priority,
        "mismatch": msgspec.to_builtins(session.choices.mismatch),
        "seed": session.scenario.seed,
        "ticks": session.ticks,
        "events": msgspec.to_builtins(session.log),
        "urdf": robot.spec.urdf,
        "robot": {
            "name": robot.spec.name,
            "mass": robot.mass,
            "friction": robot.spec.friction,
            "feet": {
                name: {"frame": foot.frame, "x": foot.x, "y": foot.y}
                for name, foot in robot.spec.feet.items()
            },
        },
    }


def _engine_version(engine: Engine) -> dict[str, str]:
    """Of the physics, where it is not the lab's own."""
    return {} if engine == "pinocchio" else {engine: metadata.version(engine)}


def versions() -> dict[str, str]:
    """Versions of this package and of the libraries that its numbers depend on."""
    return {"momentum_lab": __version__, **{name: metadata.version(name) for name in _LIBRARIES}}
