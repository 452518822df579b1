"""Where moving plates are: their courses in time, and the pose, velocity and acceleration that follow."""

from __future__ import annotations

import math

import numpy as np

from momentum_lab.compiled import compiled
from momentum_lab.physics.plate import AXES, PlateMotion

_MATRIX, _VECTOR, _STACK = "f8[:, ::1]", "f8[::1]", "f8[:, :, ::1]"
_ROLL, _PITCH = AXES.index("roll"), AXES.index("pitch")


def course_row(foot: int, motion: PlateMotion) -> tuple[float, ...]:
    """A motion of the plate under a foot as numbers.

    Foot, axis, 1 for a step, amplitude (m or rad), period, start and stop (s, infinite if there is none).
    """
    turning = motion.axis in ("roll", "pitch")
    amplitude = math.radians(motion.amplitude) if turning else motion.amplitude
    step = float(motion.course == "step")
    stop = math.inf if motion.stop is None else motion.stop
    return float(foot), float(AXES.index(motion.axis)), step, amplitude, motion.period, motion.start, stop


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
        row: see `course_row` (7,).
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


@compiled(f"Tuple(({_MATRIX}, {_VECTOR}, {_VECTOR}))(f8, f8, f8, f8, f8, f8)")
def turned(
    roll: float, pitch: float, roll_rate: float, pitch_rate: float, roll_growth: float, pitch_growth: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """R_y(pitch) R_x(roll) (3, 3), its angular velocity (3,), rad/s, and angular acceleration (3,), rad/s^2.

    omega = pitch' e_y + roll' u with u = R_y(pitch) e_x, and alpha = pitch'' e_y + roll'' u + pitch' roll' e_y x u.

    Args:
        roll: rad.
        pitch: rad.
        roll_rate: rad/s.
        pitch_rate: rad/s.
        roll_growth: rad/s^2.
        pitch_growth: rad/s^2.
    """
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    rotation = np.array(((cp, sp * sr, sp * cr), (0.0, cr, -sr), (-sp, cp * sr, cp * cr)))
    both = pitch_rate * roll_rate
    return (
        rotation,
        np.array((roll_rate * cp, pitch_rate, -roll_rate * sp)),
        np.array((roll_growth * cp - both * sp, pitch_growth, -roll_growth * sp - both * cp)),
    )


@compiled(
    f"Tuple(({_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}))({_MATRIX}, {_STACK}, {_MATRIX}, {_MATRIX}, f8)"
)
def moved_plates(
    position: np.ndarray, rotation: np.ndarray, facing: np.ndarray, courses: np.ndarray, time: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Points, axes, velocities and accelerations of plates at a time, as in `FootGround`.

    o(t) = o_0 + F (x, y, z), R(t) = F R_y(pitch) R_x(roll) F^T R_0.

    Args:
        position: o_0, where the plates' points are before anything moves (F, 3), m.
        rotation: R_0, axes of the plates then (F, 3, 3).
        facing: F, axes in which the motions are given (3, 3).
        courses: one row per motion, see `course_row` (M, 7).
        time: of the run, s.
    """
    feet = len(position)
    place, speed, change = np.zeros((feet, 5)), np.zeros((feet, 5)), np.zeros((feet, 5))
    for i in range(len(courses)):
        foot, axis = int(courses[i, 0]), int(courses[i, 1])
        way, rate, growth = course(courses[i], time)
        place[foot, axis] += way
        speed[foot, axis] += rate
        change[foot, axis] += growth
    points, axes = position.copy(), np.empty_like(rotation)
    velocity, acceleration = np.zeros((feet, 6)), np.zeros((feet, 6))
    for foot in range(feet):
        points[foot] += facing @ place[foot, :3].copy()
        velocity[foot, :3] = facing @ speed[foot, :3].copy()
        acceleration[foot, :3] = facing @ change[foot, :3].copy()
        turn, spin, growth_of_spin = turned(
            place[foot, _ROLL],
            place[foot, _PITCH],
            speed[foot, _ROLL],
            speed[foot, _PITCH],
            change[foot, _ROLL],
            change[foot, _PITCH],
        )
        axes[foot] = facing @ turn @ facing.T @ rotation[foot]
        velocity[foot, 3:] = facing @ spin
        acceleration[foot, 3:] = facing @ growth_of_spin
    return points, axes, velocity, acceleration
