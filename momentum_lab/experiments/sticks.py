"""A robot as lines from joint to joint, seen from the side or from the front."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pinocchio as pin

from momentum_lab.experiments.canvas import CMP, COM, COP, FORCE, INK, MUTED, finish, label
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.session import Session

SIDE, FRONT = 0, 1
_NEWTONS_PER_WEIGHT_LENGTH = 0.75


def bones(session: Session, tick: int) -> np.ndarray:
    """Lines from every joint to its child (n, 2, 3), world, m."""
    model, data = session.robot.model, session.robot.model.createData()
    pin.forwardKinematics(model, data, session.recording.column("q")[tick])
    joints = range(2, model.njoints)
    return np.array(
        [[data.oMi[model.parents[joint]].translation, data.oMi[joint].translation] for joint in joints]
    )


def soles(session: Session, tick: int) -> list[np.ndarray]:
    """The rectangles of the soles (4, 3) each, world, m."""
    poses = session.recording.column("sole_pose")[tick]
    return [
        np.asarray(sole.corners) @ pin.Quaternion(pose[3:]).toRotationMatrix().T + pose[:3]
        for sole, pose in zip(session.robot.soles, poses, strict=True)
    ]


def draw_robot(axes: Any, session: Session, tick: int, view: int) -> None:
    """The robot at a tick with CoM, CoP, CMP and ground reaction force; `view` is the axis across the page."""
    column = session.recording.column
    for line in bones(session, tick):
        axes.plot(line[:, view], line[:, 2], "-", color=MUTED, lw=2.0, solid_capstyle="round")
    for corners in soles(session, tick):
        axes.plot(
            corners[[0, 1, 2, 3, 0], view], corners[[0, 1, 2, 3, 0], 2], color=INK, lw=3.5, label="sole"
        )
    _draw_ground(axes, session, tick, view)
    com = column("com")[tick]
    axes.plot(com[view], com[2], "o", color=COM, ms=9, mec=INK, label="CoM")
    axes.set_aspect("equal")


def _draw_ground(axes: Any, session: Session, tick: int, view: int) -> None:
    """What the ground does to the robot; in the air there is no CoP and no CMP."""
    column = session.recording.column
    axes.axhline(0.0, color="#cccccc", lw=1.0, zorder=0)
    com, cop, cmp = column("com")[tick], column("cop_measured")[tick, view], column("cmp")[tick, view]
    force = column("foot_wrench_measured")[tick, :, :3].sum(axis=0)
    if not np.isfinite(cop):
        return
    arrow = _NEWTONS_PER_WEIGHT_LENGTH * com[2] * force / (session.robot.mass * GRAVITY)
    axes.annotate(
        "",
        (cop + arrow[view], arrow[2]),
        (cop, 0.0),
        arrowprops={"arrowstyle": "-|>", "color": FORCE, "lw": 2.0, "shrinkA": 0.0, "shrinkB": 0.0},
    )
    axes.plot([], [], color=FORCE, lw=2.0, label="ground reaction force")
    axes.plot(
        [cmp, com[view]], [0.0, com[2]], "--", color=CMP, lw=1.0, label="parallel to it, through the CoM"
    )
    axes.plot(cop, 0.0, "D", color=COP, ms=8, mec="white", label="CoP")
    axes.plot(cmp, 0.0, "^", color=CMP, ms=8, mec="white", label="CMP")


def snapshot(axes: Any, session: Session, tick: int, view: int, title: str) -> None:
    """The robot at a tick, in a frame that it fills and that is the same at every tick."""
    draw_robot(axes, session, tick, view)
    label(axes, title, f"{'xy'[view]} [m]", "z [m]")
    start = session.recording.column("com")[0]
    lowest = float(session.recording.column("sole_pose")[0, :, 2].min())
    height = lowest + 1.9 * (float(start[2]) - lowest)
    axes.set_xlim(start[view] - 0.48 * height, start[view] + 0.48 * height)
    axes.set_ylim(-0.05 * height, height)


def from_above(axes: Any, session: Session, moments: Mapping[str, tuple[int, str]], title: str) -> None:
    """The robot seen from above at some ticks, by name with a colour each, x up the page and y to the left."""
    for name, (tick, color) in moments.items():
        for line in bones(session, tick):
            axes.plot(line[:, 1], line[:, 0], "-", color=color, lw=2.0, solid_capstyle="round")
        for corners in soles(session, tick):
            around = corners[[0, 1, 2, 3, 0]]
            axes.plot(around[:, 1], around[:, 0], color=color, lw=3.0, label=name)
    axes.set_aspect("equal")
    axes.invert_xaxis()
    finish(axes, title, "y [m]", "x [m]")
