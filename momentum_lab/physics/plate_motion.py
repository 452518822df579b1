"""Where moving plates are: their courses in time, and the pose, velocity and acceleration that follow."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.momentum.wrench import cross
from momentum_lab.physics.plate import AXES, PlateMotion

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"


def course_row(foot: int, motion: PlateMotion, pivot: np.ndarray) -> tuple[float, ...]:
    """A motion of the plate under a foot as numbers.

    Foot, axis, 1 for a step, amplitude (m or rad), period, start and stop (s, infinite if there is none), and the
    pivot (3,), m, that a turn leaves where it is.
    """
    amplitude = math.radians(motion.amplitude) if motion.turns else motion.amplitude
    return (
        float(foot),
        float(AXES.index(motion.axis)),
        float(motion.course == "step"),
        amplitude,
        motion.period,
        motion.start,
        math.inf if motion.stop is None else motion.stop,
        *pivot.tolist(),
    )


@compiled("UniTuple(f8, 3)(f8)")
def eased(part: float) -> tuple[float, float, float]:
    """A way from 0 to 1 without a jump of its acceleration, and its first two derivatives.

    s = u^3 (10 - 15 u + 6 u^2) for u from 0 to 1.

    Args:
        part: u; before 0 nothing has begun, after 1 all is done.
    """
    if part <= 0.0:
        return 0.0, 0.0, 0.0
    if part >= 1.0:
        return 1.0, 0.0, 0.0
    rest = 1.0 - part
    way = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
    return way, 30.0 * part**2 * rest**2, 60.0 * part * rest * (1.0 - 2.0 * part)


@compiled(f"UniTuple(f8, 3)({_VECTOR}, f8)")
def course(row: np.ndarray, time: float) -> tuple[float, float, float]:
    """How far a motion is, and its first two derivatives, m or rad, per s and s^2.

    A s(t / T) (1 - s(1 - (t_end - t) / T)) sin(w t) with w = 2 pi / T and the ease s; A s(t / T) for a step.

    Args:
        row: see `course_row` (10,).
        time: of the run, s.
    """
    step, amplitude, period, start = row[2], row[3], row[4], row[5]
    since = time - start
    way, speed, change = eased(since / period)
    speed, change = speed / period, change / period**2
    if step > 0.5:
        return amplitude * way, amplitude * speed, amplitude * change
    gone, fading, faded = eased(1.0 - (row[6] - time) / period)
    fading, faded = fading / period, faded / period**2
    change = change * (1.0 - gone) - 2.0 * speed * fading - way * faded
    speed = speed * (1.0 - gone) - way * fading
    way *= 1.0 - gone
    w = 2.0 * math.pi / period
    s, c = math.sin(w * since), math.cos(w * since)
    return (
        amplitude * way * s,
        amplitude * (speed * s + way * w * c),
        amplitude * (change * s + 2.0 * speed * w * c - way * w * w * s),
    )


@compiled(f"{_MATRIX}({_VECTOR}, f8)")
def turn_about(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rotation (3, 3) about a unit vector (3,) by an angle, rad: 1 + sin S(a) + (1 - cos) S(a)^2."""
    x, y, z = axis
    skew = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
    return np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * (skew @ skew)


@compiled(
    f"Tuple(({_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}))({_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, f8)"
)
def moved_plates(
    position: np.ndarray, rotation: np.ndarray, facing: np.ndarray, courses: np.ndarray, time: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points, axes, velocities and accelerations of plates at a time, as in `FootGround`.

    One motion after the other carries the plate on: a way d along an axis adds d, d', d''; a turn A by an angle
    theta about an axis a through a pivot c, with w = theta' a and r = A (o - c), makes

        o = c + r,  v = A v + w x r,  dv = A dv + theta'' a x r + w x (w x r) + 2 w x A v,
        R = A R,  omega = A omega + w,  domega = A domega + theta'' a + w x A omega.

    Args:
        position: where the plates' points are before anything moves (F, 3), m.
        rotation: axes of the plates then (F, 3, 3).
        facing: axes x, y, z of the motions as columns (3, 3).
        courses: one row per motion, turns before ways, so that pivots ride along; see `course_row` (M, 10).
        time: of the run, s.
    """
    points, axes = position.copy(), rotation.copy()
    velocity, acceleration = np.zeros((len(points), 6)), np.zeros((len(points), 6))
    for i in range(len(courses)):
        foot, kind = int(courses[i, 0]), int(courses[i, 1])
        way, rate, growth = course(courses[i], time)
        if kind < 3:
            points[foot] += way * facing[:, kind]
            velocity[foot, :3] += rate * facing[:, kind]
            acceleration[foot, :3] += growth * facing[:, kind]
            continue
        axis, pivot = facing[:, kind - 3].copy(), courses[i, 7:]
        turn, spin, gain = turn_about(axis, way), rate * axis, growth * axis
        arm = turn @ (points[foot] - pivot)
        speed, turning = turn @ velocity[foot, :3].copy(), turn @ velocity[foot, 3:].copy()
        changes = turn @ acceleration[foot, :3].copy(), turn @ acceleration[foot, 3:].copy()
        points[foot] = pivot + arm
        axes[foot] = turn @ axes[foot]
        velocity[foot, :3] = speed + cross(spin, arm)
        velocity[foot, 3:] = turning + spin
        acceleration[foot, :3] = (
            changes[0] + cross(gain, arm) + cross(spin, cross(spin, arm)) + 2.0 * cross(spin, speed)
        )
        acceleration[foot, 3:] = changes[1] + gain + cross(spin, turning)
    return points, axes, velocity, acceleration
