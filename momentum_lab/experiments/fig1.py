"""Fig. 1: forces on the ground and rates of momentum are one thing, read in two ways."""

from __future__ import annotations

from typing import Any

import numpy as np

from momentum_lab.experiments.canvas import CMP, COP, FORCE, INK, SPIN, band, canvas, finish, heading
from momentum_lab.experiments.choice import chosen
from momentum_lab.experiments.claims import Claim, Columns, Figure, Runs, at_least, at_most, largest, stands
from momentum_lab.experiments.measured import ground_force, momentum_slope, push_end, times
from momentum_lab.momentum.ground import GRAVITY
from momentum_lab.plain import plain
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session

_MM = 1e3
# Parts of the weight for forces; m for levers of moments and for the CoP.
_TICK_ERROR = {"m g": 5e-3, "m": 1e-3}


def scenarios(robot: str | None) -> dict[str, Scenario]:
    """A push from behind and to the left, so that every component is in use."""
    return {"push": chosen("fig1", robot)}


def from_ground(session: Session) -> tuple[np.ndarray, np.ndarray]:
    """Rates of momentum (n, 3) each, N and N m, from f, p and tau_n alone.

    dl = m g + f (Eq. 2) and dk = (p - r_G) x f + tau_n (Eq. 1), to which a push adds its force and moment.
    """
    column, force = session.recording.column, ground_force(session)
    com, push = column("com"), column("push_wrench")
    linear = force + push[:, :3] + np.array([0.0, 0.0, -session.robot.mass * GRAVITY])
    angular = np.cross(_cop(session) - com, force) + push[:, 3:] - np.cross(com, push[:, :3])
    angular[:, 2] += normal_torque(session)
    return linear, angular


def normal_torque(session: Session) -> np.ndarray:
    """tau_n, the ground's moment about the vertical through the CoP (n,), N m."""
    column = session.recording.column
    wrench, arm = column("foot_wrench_measured"), column("sole_pose")[..., :3] - _cop(session)[:, None]
    return (wrench[..., 5] + np.cross(arm, wrench[..., :3])[..., 2]).sum(axis=1)


def _cop(session: Session) -> np.ndarray:
    cop = session.recording.column("cop_measured")
    return np.column_stack([cop, np.zeros(len(cop))])


def from_motion(session: Session) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ground's force (n - 1, 3), CoP (n - 1, 2) and tau_n (n - 1,), from the moving links alone.

    f = dl - m g - F (Eq. 2), p of Eq. 21 and tau_n of Eq. 1, with rates that are differences of the momentum
    over a tick; of the forces only the push is known.
    """
    column, rate = session.recording.column, momentum_slope(session)
    com, push = column("com")[:-1], column("push_wrench")[:-1]
    force = rate[:, :3] - push[:, :3] + np.array([0.0, 0.0, session.robot.mass * GRAVITY])
    spin = rate[:, 3:] - push[:, 3:] + np.cross(com, push[:, :3])
    x = com[:, 0] - (force[:, 0] * com[:, 2] + spin[:, 1]) / force[:, 2]
    y = com[:, 1] - (force[:, 1] * com[:, 2] - spin[:, 0]) / force[:, 2]
    arm = np.column_stack([x, y, np.zeros(len(x))]) - com
    return force, np.column_stack([x, y]), spin[:, 2] - np.cross(arm, force)[:, 2]


def claims(runs: Runs) -> list[Claim]:
    """Six numbers of the ground give six rates, and the six rates give them back.

    The motion's rates are differences over a tick: what is left between both ways halves with half the tick. It is
    largest in the force, where the G1 loses 0.34 % of its weight at 1 ms, hence the wider bound there; 95 % of the
    ticks leaves out those on which a push or a sole's landing jumps.
    """
    session = runs["push"]
    linear, angular = from_ground(session)
    slope, weight = momentum_slope(session), session.robot.mass * GRAVITY
    force, cop, torque = from_motion(session)
    measured = session.recording.column("cop_measured")[:-1]
    cross_talk = np.abs(session.recording.column("cop_measured")[:, 0] - _point_mass_cop(session))
    return [
        stands("the robot", session),
        _close("f gives the rate of linear momentum", linear[:-1] - slope[:, :3], 1.0 / weight, "m g"),
        _close(
            "f, p and tau_n give the rate of angular momentum", angular[:-1] - slope[:, 3:], 1.0 / weight, "m"
        ),
        _close(
            "the rate of linear momentum gives f back",
            force - ground_force(session)[:-1],
            1.0 / weight,
            "m g",
        ),
        _close("both rates give p back", cop - measured, 1.0, "m"),
        _close("and tau_n", torque - normal_torque(session)[:-1], 1.0 / weight, "m"),
        at_least(
            "p needs both: without the rate of angular momentum it is wrong by",
            _MM * largest(cross_talk[times(session) > push_end(session)]),
            10.0,
            "mm",
        ),
    ]


def _point_mass_cop(session: Session) -> np.ndarray:
    """Where p would be along x without angular momentum: Eq. 21 with dk = 0 (n,), m."""
    force, com = ground_force(session), session.recording.column("com")
    return com[:, 0] - force[:, 0] / force[:, 2] * com[:, 2]


def _close(text: str, difference: np.ndarray, scale: float, unit: str) -> Claim:
    size = np.abs(difference).max(axis=-1) if difference.ndim > 1 else np.abs(difference)
    value = scale * float(np.percentile(size, 95)) if size.size else float("nan")
    return at_most(f"{text}, within (95 % of the ticks)", value, _TICK_ERROR[unit], unit)


def table(runs: Runs) -> Columns:
    """Both readings of every quantity."""
    session = runs["push"]
    linear, angular = from_ground(session)
    slope = momentum_slope(session)
    force, cop, torque = from_motion(session)
    columns: dict[str, Any] = {"time [s]": times(session)[:-1]}
    for axis, name in enumerate("xyz"):
        columns[f"dl_{name} of f [N]"] = linear[:-1, axis]
        columns[f"dl_{name} of the motion [N]"] = slope[:, axis]
        columns[f"dk_{name} of f, p, tau_n [N m]"] = angular[:-1, axis]
        columns[f"dk_{name} of the motion [N m]"] = slope[:, 3 + axis]
        columns[f"f_{name} measured [N]"] = ground_force(session)[:-1, axis]
        columns[f"f_{name} of the motion [N]"] = force[:, axis]
    for axis, name in enumerate("xy"):
        columns[f"p_{name} measured [m]"] = session.recording.column("cop_measured")[:-1, axis]
        columns[f"p_{name} of the motion [m]"] = cop[:, axis]
    columns["tau_n measured [N m]"] = normal_torque(session)[:-1]
    columns["tau_n of the motion [N m]"] = torque
    return columns


def draw(runs: Runs) -> Any:
    """Four panels, one for each arrow of the chapter's Fig. 1, with the numbers of one tick."""
    session = runs["push"]
    picture, axes = canvas(
        heading("Fig. 1: forces and momentum rates, both ways", session), 2, 2, (13.0, 8.5)
    )
    data, tick = table(runs), _tick(session)
    sides = (
        (axes[0, 0], r"(c) f $\rightarrow \dot l$", "N", ("dl_x of f [N]", "dl_y of f [N]"), "dl", 1.0),
        (
            axes[0, 1],
            r"(c) $\dot l \rightarrow$ f",
            "N",
            ("f_x of the motion [N]", "f_y of the motion [N]"),
            "f",
            1.0,
        ),
        (
            axes[1, 0],
            r"(d) f, p, $\tau_n \rightarrow \dot k$",
            "N m",
            ("dk_x of f, p, tau_n [N m]", "dk_y of f, p, tau_n [N m]"),
            "dk",
            1.0,
        ),
        (
            axes[1, 1],
            r"(e) $\dot l, \dot k \rightarrow$ p",
            "mm",
            ("p_x of the motion [m]", "p_y of the motion [m]"),
            "p",
            _MM,
        ),
    )
    colors = {"dl": (FORCE, COP), "f": (FORCE, COP), "dk": (SPIN, CMP), "p": (COP, FORCE)}
    for panel, title, unit, keys, symbol, scale in sides:
        numbers, curves = [], []
        for key, color in zip(keys, colors[symbol], strict=True):
            name = key.split(" ")[0]
            other = next(k for k in data if k.startswith(f"{name} ") and k != key)
            worked, seen = scale * np.asarray(data[key]), scale * np.asarray(data[other])
            panel.plot(data["time [s]"], seen, color=color, lw=3.0, alpha=0.4, label=_said(other))
            panel.plot(data["time [s]"], worked, ":", color=INK, lw=1.2)
            numbers.append(
                f"{name} = {plain(worked[tick], '.1f')} {unit}, against {plain(seen[tick], '.1f')} {unit}"
            )
            curves.append(seen)
        panel.plot([], [], ":", color=INK, lw=1.2, label="computed along the arrow")
        _frame(panel, curves)
        band(panel, session)
        panel.set_xlim(0.0, 1.0)
        stamp = f"at {times(session)[tick]:.2f} s:\n" + "\n".join(numbers)
        box = {"fc": "white", "ec": "#cccccc"}
        panel.text(0.98, 0.04, stamp, transform=panel.transAxes, ha="right", fontsize=8, bbox=box)
        finish(panel, title, "time [s]", f"[{unit}]", loc="upper right")
    return picture


def _tick(session: Session) -> int:
    """A tick shortly after the push."""
    return min(round((push_end(session) + 0.02) / session.scenario.timestep), len(session.recording) - 2)


def _said(key: str) -> str:
    return key.rpartition(" [")[0].replace("tau_n", r"$\tau_n$")


def _frame(axes: Any, curves: list[np.ndarray]) -> None:
    """Room for curves and, below them, for the numbers; spikes of a tick run out of the picture."""
    low, high = np.percentile(np.concatenate(curves), [0.3, 99.7])
    axes.set_ylim(low - 0.55 * (high - low), high + 0.4 * (high - low))


FIGURE = Figure("fig1", "Forces and momentum rates, both ways", scenarios, draw, table, claims)
