from __future__ import annotations

import json
import stat
import zipfile
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pinocchio as pin
import pytest

from momentum_lab import __version__
from momentum_lab.control.controller import SLACKS
from momentum_lab.errors import InputError
from momentum_lab.events import SetGain, SetPriority
from momentum_lab.provenance import provenance
from momentum_lab.recording import Layout, Recording, Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.urdf import robot_data_folder
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from momentum_lab.trace import Trace, load_trace, save_trace, writable_file
from tests.conftest import assert_close
from tests.runs import PUSH_END, PUSH_START, forward_push, play, played

SECONDS = 0.8
GRAVITY = 9.81
# A moment of the weight of G1 on 0.2 mm, N m.
MOMENT = 0.05
SMALL = Layout({"time": (), "point": (2,), "feet": (2, 3)}, ("hip", "knee"), ("left", "right"))


def filled(capacity: int, ticks: int) -> Recording:
    """A recording whose row i holds nothing but i."""
    recording = Recording(SMALL, capacity)
    for tick in range(ticks):
        recording.next_row()[:] = tick
    return recording


@pytest.fixture(scope="module")
def session(robot: RobotModel) -> Session:
    return played(robot, forward_push(robot, SECONDS))


@pytest.fixture(scope="module")
def path(session: Session, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("traces") / "push.npz"
    save_trace(session.recording, provenance(session), path)
    return path


@pytest.fixture(scope="module")
def trace(path: Path) -> Trace:
    return load_trace(path)


# The ring


def test_reserved_memory_is_there_and_changes_nothing(robot):
    """Every row has been written, none counts as a sample."""
    recording = Recording(Layout.of(robot), 5)
    recording.reserve(2)
    assert len(recording) == 0
    recording.next_row()[:] = 7.0
    recording.reserve(100)
    assert len(recording) == 1
    assert (recording.latest.row == 7.0).all()
    assert np.isnan([recording.next_row() for _ in range(4)]).all()


def test_what_is_forgotten_at_the_end_is_written_anew() -> None:
    recording = filled(5, 13)
    recording.forget_last(2)
    assert recording.column("time").tolist() == [8, 9, 10]
    assert recording.before_end(2).number("time") == 8
    with pytest.raises(InputError, match=r"^recording: got the sample 3 before the last; allowed: one of 3$"):
        recording.before_end(3)
    for time in (21, 22, 23):
        recording.next_row()[0] = time
    assert recording.column("time").tolist() == [9, 10, 21, 22, 23]
    recording.forget_last(99)
    assert len(recording) == 0
    assert recording.column("time").tolist() == []


def test_rows_come_back_oldest_first_before_and_after_the_ring_is_full() -> None:
    assert filled(5, 3).column("time").tolist() == [0, 1, 2]
    assert filled(5, 5).column("time").tolist() == [0, 1, 2, 3, 4]
    assert filled(5, 13).column("time").tolist() == [8, 9, 10, 11, 12]
    assert len(filled(5, 13)) == 5


def test_every_takes_the_first_of_each_group() -> None:
    assert filled(9, 9).column("time", every=4).tolist() == [0, 4, 8]
    assert filled(5, 13).column("time", every=2).tolist() == [8, 10, 12]


def test_columns_have_their_shapes_and_samples_their_names() -> None:
    recording = filled(5, 7)
    assert recording.column("point").shape == (5, 2)
    assert recording.column("feet").shape == (5, 2, 3)
    assert recording.latest.number("time") == 6
    assert recording.latest["feet"].shape == (2, 3)
    row = np.arange(9.0)
    assert Sample.of(SMALL, row)["feet"].tolist() == [[3, 4, 5], [6, 7, 8]]


def test_an_empty_recording_has_no_latest_sample() -> None:
    recording = filled(5, 2)
    recording.clear()
    assert len(recording) == 0
    assert recording.column("feet").shape == (0, 2, 3)
    with pytest.raises(
        InputError, match=r"^recording: got no samples; allowed: a recording of at least one tick$"
    ):
        _ = recording.latest


# The file


def contract(rows: int, nq: int, nv: int, na: int, feet: int) -> dict[str, tuple[int, ...]]:
    """What other programs read from a trace."""
    return {
        "time": (rows,),
        "q": (rows, nq),
        "v": (rows, nv),
        "torque": (rows, na),
        "com": (rows, 3),
        "com_velocity": (rows, 3),
        "momentum": (rows, 6),
        "momentum_rate_desired": (rows, 6),
        "momentum_rate_admissible": (rows, 6),
        "momentum_rate_measured": (rows, 6),
        "foot_wrench_measured": (rows, feet, 6),
        "foot_wrench_admissible": (rows, feet, 6),
        "sole_pose": (rows, feet, 7),
        "cop_measured": (rows, 2),
        "cop_admissible": (rows, 2),
        "cmp": (rows, 2),
        "capture_point": (rows, 2),
        "foot_cop_measured": (rows, feet, 2),
        "push_wrench": (rows, 6),
        "other_contact_wrench": (rows, 6),
        "joint_names": (na,),
        "foot_names": (feet,),
        "meta": (),
    }


def test_file_holds_what_the_contract_says(path: Path, robot: RobotModel) -> None:
    shapes = contract(round(SECONDS * 1000), robot.nq, robot.nv, robot.nv - 6, 2)
    with np.load(path, allow_pickle=False) as file:
        assert {name: file[name].shape for name in shapes} == shapes
        numbers = set(shapes) - {"joint_names", "foot_names", "meta"}
        assert {file[name].dtype for name in numbers} == {np.dtype(float)}
        assert all(np.isfinite(file[name]).all() for name in numbers)
        assert file["joint_names"].tolist() == list(robot.model.names)[2:]
        assert file["foot_names"].tolist() == ["left", "right"]
        assert isinstance(json.loads(file["meta"].item()), dict)
        assert file["slack_names"].tolist() == list(SLACKS)
        assert file["slack"].shape == (len(file["time"]), len(SLACKS))


def test_meta_says_how_to_run_it_again(trace: Trace, robot: RobotModel) -> None:
    meta = trace.meta
    assert meta["versions"].keys() >= {"momentum_lab", "pin", "numpy", "placo", "daqp"}
    assert meta["versions"]["momentum_lab"] == __version__
    assert meta["versions"]["numpy"] == np.__version__
    assert msgspec.convert(meta["scenario"], Scenario) == forward_push(robot, SECONDS)
    assert meta["gains"]["linear_damping"] == 8.0
    assert (meta["priority"], meta["seed"], meta["events"]) == (0.0, 0, [])
    assert meta["robot"]["mass"] == robot.mass


def test_meta_leads_to_the_urdf_and_q_is_pinocchios(trace: Trace) -> None:
    """A program that has only the file and Pinocchio finds the same CoM and momentum."""
    urdf = Path(trace.meta["urdf"])
    assert not urdf.is_absolute()
    model = pin.buildModelFromUrdf(str(robot_data_folder() / urdf), pin.JointModelFreeFlyer())
    data = model.createData()
    for row in (0, 250, 777):
        pin.ccrba(model, data, trace.columns["q"][row], trace.columns["v"][row])
        assert_close(trace.columns["com"][row], data.com[0], 1e-12)
        assert_close(trace.columns["momentum"][row], data.hg.vector, 1e-10)


def test_scenario_gains_and_events_of_the_meta_replay_the_same_bits(
    talos: RobotModel, tmp_path: Path
) -> None:
    session = Session(forward_push(talos, 0.3), talos)
    for tick in range(300):
        if tick == 100:
            session.post(SetGain("angular_damping", 9.0))
        if tick == 220:
            session.post(SetPriority(1.0))
        session.tick()
    save_trace(session.recording, provenance(session), tmp_path / "a.npz")
    first = load_trace(tmp_path / "a.npz")
    assert first.meta["gains"]["angular_damping"] == 9.0
    assert first.meta["priority"] == 1.0
    again = Session(msgspec.convert(first.meta["scenario"], Scenario), talos)
    events = {"SetGain": SetGain, "SetPriority": SetPriority}
    log = {entry["tick"]: entry["event"] for entry in first.meta["events"]}
    for tick in range(300):
        if tick in log:
            event = dict(log[tick])
            again.post(events[event.pop("type")](**event))
        again.tick()
    assert np.array_equal(again.recording.rows(), session.recording.rows(), equal_nan=True)


def test_two_runs_are_the_same_bits(robot: RobotModel) -> None:
    scenario = forward_push(robot, 0.4)
    assert np.array_equal(played(robot, scenario).recording.rows(), play(robot, scenario).recording.rows())


def test_file_is_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(file: Any, **_arrays: Any) -> None:
        file.write(b"half")
        raise OSError(28, "No space left on device")

    path = tmp_path / "trace.npz"
    path.write_text("what was there before")
    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.raises(InputError, match=r"^out: got .*trace\.npz; allowed: .*\(No space left on device\)$"):
        save_trace(filled(3, 3), {}, path)
    assert path.read_text() == "what was there before"
    assert list(tmp_path.iterdir()) == [path]


def test_name_is_taken_exactly_as_given(tmp_path: Path) -> None:
    save_trace(filled(3, 3), {"a": 1}, tmp_path / "trace")
    assert [path.name for path in tmp_path.iterdir()] == ["trace"]
    assert load_trace(tmp_path / "trace").meta == {"a": 1}


def test_a_second_robot_adds_arrays_and_changes_none(tmp_path: Path) -> None:
    save_trace(filled(3, 3), {"a": 1}, tmp_path / "alone.npz")
    save_trace(filled(3, 3), {"a": 1}, tmp_path / "pair.npz", filled(3, 2))
    with zipfile.ZipFile(tmp_path / "alone.npz") as alone, zipfile.ZipFile(tmp_path / "pair.npz") as pair:
        before = {name: alone.read(name) for name in alone.namelist()}
        after = {name: pair.read(name) for name in pair.namelist()}
    assert after | before == after
    assert {name for name in after if name not in before} == {
        f"second/{name}.npy" for name in filled(3, 3).layout.shapes
    }
    trace = load_trace(tmp_path / "pair.npz")
    assert (len(trace.columns["time"]), len(trace.second["time"])) == (3, 2)
    assert load_trace(tmp_path / "alone.npz").second == {}


def test_file_has_the_rights_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "plain").touch()
    save_trace(filled(3, 3), {}, tmp_path / "trace.npz")
    rights = {stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("plain", "trace.npz")}
    assert len(rights) == 1


def test_a_link_is_written_through(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "real")
    save_trace(filled(3, 3), {}, tmp_path / "link")
    assert (tmp_path / "link").is_symlink()
    assert len(load_trace(tmp_path / "real").columns["time"]) == 3


@pytest.mark.parametrize("name", [".", "nowhere/trace.npz", "x" * 300])
def test_place_that_cannot_be_written(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^out: got .*; allowed: "):
        writable_file(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_device_is_not_replaced_by_a_file() -> None:
    with pytest.raises(InputError, match=r"^out: got /dev/null; allowed: the path of a file$"):
        save_trace(filled(3, 3), {}, Path("/dev/null"))
    assert Path("/dev/null").is_char_device()


@pytest.mark.parametrize("content", [b"", b"hello", b"PK\x03\x04 half a zip", b"\x93NUMPY"])
def test_foreign_file_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "foreign.npz"
    path.write_bytes(content)
    with pytest.raises(
        InputError, match=r"^recording: got .*foreign\.npz; allowed: a \.npz file that this lab"
    ):
        load_trace(path)


def test_npz_of_someone_else_is_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "other.npz", x=np.zeros(3))
    np.save(tmp_path / "array.npy", np.zeros(3))
    for name in ("other.npz", "array.npy", "missing.npz"):
        with pytest.raises(InputError, match=r"^recording: got "):
            load_trace(tmp_path / name)


# What the columns have to do with each other, from the numbers of the file alone


def pushing(trace: Trace) -> np.ndarray:
    return (trace.columns["time"] > PUSH_START - 1e-9) & (trace.columns["time"] < PUSH_END - 1e-9)


def about(point: np.ndarray, wrench: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """A wrench [f; n] about `origin` as one about `point`."""
    moment = wrench[..., 3:] + np.cross(origin - point, wrench[..., :3])
    return np.concatenate([wrench[..., :3], moment], axis=-1)


def on_the_ground(points: np.ndarray) -> np.ndarray:
    """Points (n, 2) on the level ground at height 0 (n, 3)."""
    return np.column_stack([points, np.zeros(len(points))])


def test_clock_ticks_evenly_from_zero(trace: Trace) -> None:
    assert trace.columns["time"][0] == 0.0
    assert_close(np.diff(trace.columns["time"]), 1e-3, 1e-12)


def test_quaternions_are_unit(trace: Trace) -> None:
    assert_close(np.linalg.norm(trace.columns["q"][:, 3:7], axis=1), 1.0, 1e-9)
    assert_close(np.linalg.norm(trace.columns["sole_pose"][..., 3:], axis=-1), 1.0, 1e-9)


def test_linear_momentum_is_mass_times_com_velocity(trace: Trace) -> None:
    mass = trace.meta["robot"]["mass"]
    assert_close(trace.columns["momentum"][:, :3], mass * trace.columns["com_velocity"], 1e-9)


def test_measured_rate_is_gravity_feet_push_and_other_contacts(trace: Trace) -> None:
    columns, com = trace.columns, trace.columns["com"]
    total = np.zeros((len(com), 6))
    total[:, 2] = -trace.meta["robot"]["mass"] * GRAVITY
    for foot in range(2):
        total += about(com, columns["foot_wrench_measured"][:, foot], columns["sole_pose"][:, foot, :3])
    total += about(com, columns["push_wrench"] + columns["other_contact_wrench"], np.zeros(3))
    assert_close(columns["momentum_rate_measured"], total, 1e-8)


def test_integral_of_the_measured_rate_is_the_change_of_momentum(trace: Trace) -> None:
    """Up to the first-order error of the integration, measured as 1.9 % of the largest momentum at most."""
    rate, momentum = trace.columns["momentum_rate_measured"], trace.columns["momentum"]
    change = momentum[1:] - momentum[0]
    integral = 1e-3 * np.cumsum(rate[:-1], axis=0)
    assert np.abs(change - integral).max() < 0.03 * np.abs(momentum).max()


def test_push_wrench_is_the_push_through_the_com(trace: Trace) -> None:
    push, com = trace.columns["push_wrench"], trace.columns["com"]
    force = trace.meta["scenario"]["pushes"][0]["force"]
    on = pushing(trace)
    assert_close(push[on, :3], [[force, 0.0, 0.0]] * on.sum(), 1e-9)
    assert_close(about(com, push, np.zeros(3))[:, 3:], 0.0, 1e-9)
    assert not push[~on].any()


def test_cop_is_where_the_feet_press(trace: Trace) -> None:
    """About the CoP the ground reaction has no horizontal moment."""
    columns = trace.columns
    cop = on_the_ground(columns["cop_measured"])
    net = sum(
        about(cop, columns["foot_wrench_measured"][:, foot], columns["sole_pose"][:, foot, :3])
        for foot in range(2)
    )
    assert_close(net[:, 3:5], 0.0, MOMENT)


def test_gap_between_cmp_and_cop_is_the_rate_of_angular_momentum(trace: Trace) -> None:
    """s - p = (k_y, -k_x) / f_z, while nothing but the ground acts on the robot (Eq. 23)."""
    free = ~pushing(trace)
    rate = trace.columns["momentum_rate_measured"][free]
    normal = trace.columns["foot_wrench_measured"][free, :, 2].sum(1)
    gap = (trace.columns["cmp"] - trace.columns["cop_measured"])[free]
    assert_close(gap, np.column_stack([rate[:, 4], -rate[:, 3]]) / normal[:, None], 1e-9)


def test_cmp_is_on_the_line_of_the_ground_reaction_through_the_com(trace: Trace) -> None:
    columns = trace.columns
    force = columns["foot_wrench_measured"][..., :3].sum(1)
    assert_close(np.cross(on_the_ground(columns["cmp"]) - columns["com"], force), 0.0, MOMENT)


def test_capture_point_is_ahead_of_the_com(trace: Trace) -> None:
    com, velocity = trace.columns["com"], trace.columns["com_velocity"]
    ahead = velocity[:, :2] * np.sqrt(com[:, 2:] / GRAVITY)
    assert_close(trace.columns["capture_point"], com[:, :2] + ahead, 1e-4)


def test_foot_cop_is_in_the_sole_frame_and_inside_the_sole(trace: Trace) -> None:
    columns = trace.columns
    for foot, name in enumerate(trace.foot_names):
        pose, wrench = columns["sole_pose"][:, foot], columns["foot_wrench_measured"][:, foot]
        cop = columns["foot_cop_measured"][:, foot]
        for row in range(0, len(cop), 100):
            turn = pin.Quaternion(pose[row, 3:]).toRotationMatrix()
            force, moment = turn.T @ wrench[row, :3], turn.T @ wrench[row, 3:]
            assert_close(np.cross(np.append(cop[row], 0.0), force)[:2], moment[:2], 1e-8)
        sole = trace.meta["robot"]["feet"][name]
        low, high = np.array([sole["x"], sole["y"]]).T
        assert (cop > low - 1e-6).all()
        assert (cop < high + 1e-6).all()


def test_row_holds_what_acts_until_the_next(trace: Trace) -> None:
    """q of the next row is q moved by the next v, and its v comes from this row's wrenches (Eq. 20)."""
    urdf = robot_data_folder() / trace.meta["urdf"]
    model = pin.buildModelFromUrdf(str(urdf), pin.JointModelFreeFlyer())
    data = model.createData()
    q, v = trace.columns["q"], trace.columns["v"]
    for row in (10, 240, 500):
        assert_close(
            pin.difference(model, pin.integrate(model, q[row], 1e-3 * v[row + 1]), q[row + 1]), 0.0, 1e-12
        )
        acceleration = (v[row + 1] - v[row]) / 1e-3
        rate = pin.computeCentroidalMomentumTimeVariation(model, data, q[row], v[row], acceleration)
        assert_close(trace.columns["momentum_rate_measured"][row], rate.vector, 1e-7)
