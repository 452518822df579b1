"""A minute of standing still."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from momentum_lab.scenario import Scenario
from momentum_lab.session import Session


def corners(robot, poses: np.ndarray) -> np.ndarray:
    """Corners of the soles in the world (F, 4, 3), m, from poses (F, 7)."""
    return np.array(
        [
            pose[:3] + sole.corners @ pin.Quaternion(pose[3:]).toRotationMatrix().T
            for sole, pose in zip(robot.soles, poses, strict=True)
        ]
    )


def test_feet_neither_sink_nor_creep_in_a_minute(talos):
    """Less than half a millimetre down and one along the ground, every corner, at every moment."""
    session = Session(Scenario("minute", robot="talos", seconds=60.0), robot=talos, capacity=1)
    start = corners(talos, session.tick()["sole_pose"])
    lowest, farthest = 0.0, 0.0
    for _ in range(59_999):
        now = corners(talos, session.tick()["sole_pose"])
        lowest = min(lowest, now[..., 2].min())
        farthest = max(farthest, np.linalg.norm((now - start)[..., :2], axis=-1).max())
    assert session.fall is None
    assert session.solver_failures == 0
    assert lowest > -0.5e-3
    assert farthest < 1e-3
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 1e-3
