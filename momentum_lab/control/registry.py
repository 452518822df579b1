"""All controllers by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from momentum_lab.control.computed_torque import ComputedTorque
from momentum_lab.control.computed_torque_gains import ComputedTorqueGains
from momentum_lab.control.controller import Controller
from momentum_lab.control.placo_wbc import PlacoWbc, PlacoWbcGains
from momentum_lab.control.planner import OWN, PLANNERS, planner_named
from momentum_lab.control.resolved_momentum import ResolvedMomentum, ResolvedMomentumGains
from momentum_lab.control.slack_qp import SlackGains, SlackQP
from momentum_lab.control.whole_body_qp import WholeBodyGains, WholeBodyQP
from momentum_lab.errors import InputError
from momentum_lab.robot.model import RobotModel


@dataclass(frozen=True, slots=True)
class ControllerEntry:
    """One controller of the registry.

    Attributes:
        title: the name on the screen.
        summary: what it is, in one sentence.
        make: builds it for a robot and a timestep (s).
        gains: its gains at their defaults.
        planners: the rows of Table 1 that may stand above it; those that are about momentum rates need a
            controller that takes rates.
    """

    title: str
    summary: str
    make: Callable[[RobotModel, float], Controller]
    gains: Any
    planners: tuple[str, ...] = (OWN,)


CONTROLLERS: dict[str, ControllerEntry] = {
    "computed-torque": ControllerEntry(
        title="Computed torque",
        summary="Admissible foot forces, then accelerations, then torques (sections 4.2 and 5.1).",
        make=ComputedTorque,
        gains=ComputedTorqueGains(),
        planners=tuple(PLANNERS),
    ),
    "resolved-momentum": ControllerEntry(
        title="Resolved momentum",
        summary="Momentum to joint rates to stiff joint servos; the CoP is nobody's business (section 4.1).",
        make=ResolvedMomentum,
        gains=ResolvedMomentumGains(),
    ),
    "placo-wbc": ControllerEntry(
        title="PlaCo whole-body",
        summary="The peer: soft tasks on CoM, pelvis and posture over planar contacts, in one program.",
        make=PlacoWbc,
        gains=PlacoWbcGains(),
    ),
    "slack-qp": ControllerEntry(
        title="Output tasks with slacks",
        summary="CoM, pelvis, swing foot and posture under CoP bounds, least slack first (section 5.2).",
        make=SlackQP,
        gains=SlackGains(),
    ),
    "whole-body-qp": ControllerEntry(
        title="Whole-body QP",
        summary="Accelerations, forces and torques in one quadratic program, momentum first.",
        make=WholeBodyQP,
        gains=WholeBodyGains(),
        planners=tuple(PLANNERS),
    ),
}


def controller_entry(name: str) -> ControllerEntry:
    """The controller of that name.

    Raises:
        InputError: there is none.
    """
    if name not in CONTROLLERS:
        raise InputError("controller", name, f"one of {', '.join(CONTROLLERS)}")
    return CONTROLLERS[name]


def planner_above(controller: str, wanted: str) -> str:
    """The wanted planner if it may stand above a controller, or else the controller's own way.

    Raises:
        InputError: there is no such controller.
    """
    return wanted if wanted in controller_entry(controller).planners else OWN


def check_planner(name: str, controller: str) -> str:
    """The name, if that planner may stand above that controller.

    Raises:
        InputError: there is no such planner or controller, or they do not go together.
    """
    planner_named(name)
    allowed = controller_entry(controller).planners
    if name not in allowed:
        raise InputError("planner", name, f"{', '.join(allowed)} above {controller}")
    return name
