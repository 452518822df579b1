"""Robots, random states and comparisons shared by all tests."""

from __future__ import annotations

import fcntl
import tempfile
import warnings
from collections.abc import Generator
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg  # noqa: F401 - brings a BLAS of its own, to be limited like numpy's
import threadpoolctl

with warnings.catch_warnings():
    # Pinocchio 3.8 itself imports its collision library under the old name.
    warnings.filterwarnings("ignore", message=".*'hppfcl' imports.*", category=DeprecationWarning)
    import pinocchio  # noqa: F401

from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State
from tests.order import ByFile, begin_first, try_again

# Matrices of this size are done before a second thread has woken up; two of them only get in each other's way.
threadpoolctl.threadpool_limits(1, user_api="blas")

# Tests run in two processes; whoever measures time waits for the other one, and lets it wait.
_LOCKS = Path(tempfile.gettempdir())

ROBOTS = ("talos", "g1")
STATES_PER_ROBOT = 50


def pytest_addoption(parser: pytest.Parser) -> None:
    """The only way in which golden pictures change."""
    parser.addoption("--update-pictures", action="store_true", help="make the golden pictures anew")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    begin_first(items)
    try_again(items)


def pytest_xdist_make_scheduler(config: pytest.Config, log: object) -> ByFile:
    return ByFile(config, log)


def pytest_unconfigure(config: pytest.Config) -> None:
    """Close what the counting of second tries leaves open."""
    if "workerinput" in vars(config):
        config.failures_db.sock.close()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """The machine, shared with the tests of the other process; alone for a test that is marked `quiet`."""
    run = getattr(item.config, "workerinput", {}).get("testrunuid")
    if run is None:
        return (yield)
    alone = item.get_closest_marker("quiet") is not None
    gate, room = (_LOCKS / f"momentum-lab-{run}.{name}" for name in ("gate", "room"))
    with gate.open("w") as entering, room.open("w") as inside:
        fcntl.flock(entering, fcntl.LOCK_EX)  # nobody overtakes one that waits to be alone
        fcntl.flock(inside, fcntl.LOCK_EX if alone else fcntl.LOCK_SH)
        fcntl.flock(entering, fcntl.LOCK_UN)
        return (yield)


@pytest.fixture(scope="session")
def talos() -> RobotModel:
    return RobotModel.named("talos")


@pytest.fixture(scope="session")
def g1() -> RobotModel:
    return RobotModel.named("g1")


@pytest.fixture(scope="session", params=ROBOTS)
def robot(request: pytest.FixtureRequest) -> RobotModel:
    """Each of the complete robots in turn."""
    return request.getfixturevalue(request.param)


@pytest.fixture
def rng() -> np.random.Generator:
    """The same random numbers in every run of a test."""
    return np.random.default_rng(20190517)


@pytest.fixture(scope="session")
def random_states(robot: RobotModel) -> list[State]:
    """Postures within the joint limits, any orientation, bases within 1 m, speeds around 1."""
    rng = np.random.default_rng(1)
    return [random_state(robot, rng) for _ in range(STATES_PER_ROBOT)]


@pytest.fixture(scope="session")
def random_dynamics(robot: RobotModel, random_states: list[State]) -> list[Dynamics]:
    """The dynamics of the random states."""
    return [robot.at(state) for state in random_states]


def random_state(robot: RobotModel, rng: np.random.Generator) -> State:
    position = rng.uniform(-1.0, 1.0, 3)
    quaternion = rng.normal(size=4)
    joints = rng.uniform(robot.position_lower, robot.position_upper)
    q = np.concatenate((position, quaternion / np.linalg.norm(quaternion), joints))
    return State(q=q, v=rng.normal(size=robot.nv))


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    """Any rotation (3, 3), from the QR decomposition of a random matrix."""
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return rotation * np.sign(np.linalg.det(rotation))


def yaw_rotation(angle: float) -> np.ndarray:
    """Rotation about the vertical (3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def assert_close(actual: object, expected: object, tolerance: float) -> None:
    """Every number within an absolute tolerance; NaN equals nothing."""
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=tolerance, equal_nan=False)
