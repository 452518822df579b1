from __future__ import annotations

import re

import numpy as np

from momentum_lab.experiments.giving_out import what_gave_out
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario
from tests.runs import played


def test_nothing_gives_out_under_a_small_push(robot):
    push = Push(velocity_change=0.05, start=0.2)
    session = played(robot, Scenario("tap", robot=robot.spec.name, seconds=1.0, pushes=(push,)))
    assert what_gave_out(session) == ()


def test_what_gave_out_is_told_in_order_and_once_per_kind(g1):
    session = played(g1, Scenario("blow", robot="g1", seconds=1.5, pushes=(Push(force=400.0, start=0.2),)))
    assert session.fall is not None
    signs = what_gave_out(session)
    times = [float(re.fullmatch(r".* at ([\d.]+) s", sign).group(1)) for sign in signs]
    assert times == sorted(times)
    assert times[0] >= 0.2
    assert times[-1] <= session.fall.time
    legs = [name for name in g1.joint_names if "hip" in name or "knee" in name or "ankle" in name]
    at_limit = [sign.split()[0] for sign in signs if "at its limit" in sign]
    assert len(at_limit) == 2
    assert sum(name in legs for name in at_limit) == 1
    (capture,) = (time for sign, time in zip(signs, times, strict=True) if sign.startswith("capture point"))
    column = session.recording.column
    toes = max(column("sole_pose")[0][:, 0]) + max(sole.upper[0] for sole in g1.soles)
    first = np.flatnonzero(column("capture_point")[:, 0] > toes)[0]
    assert abs(column("time")[first] - capture) < 0.006
