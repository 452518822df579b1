"""Robots on ground that is tilted, high, moving or slippery: in closed loop, with every controller."""

from __future__ import annotations

import json

import msgspec
import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.cli import main
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import InputError, RobotError, ScenarioError
from momentum_lab.events import MoveGround, SetFriction, SetGroundSense, StopGround
from momentum_lab.physics.plate import FrictionChange, Plate, PlateMotion
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario, changed, load_scenario
from momentum_lab.session import Session
from tests.conftest import assert_close
from tests.runs import play, played

SLOPES = (Plate(("left",), roll_deg=10.0), Plate(("right",), roll_deg=-10.0))
TWISTED = (Plate(("left",), pitch_deg=10.0), Plate(("right",), pitch_deg=-10.0))
HILL = (Plate(pitch_deg=10.0),)
STAIR = (Plate(("left",), height=0.08),)
SWAYS = {
    axis: (Plate(motions=(PlateMotion(axis, size),)),)
    for axis, size in (("x", 0.05), ("y", 0.05), ("pitch", 5.0), ("roll", 5.0))
}


def on(robot, ground, seconds=3.0, **changes) -> Scenario:
    return Scenario("ground", robot=robot.spec.name, ground=ground, seconds=seconds, **changes)


def riding(robot, axis: str) -> Scenario:
    return on(robot, SWAYS[axis], seconds=20.0 if robot.spec.name == "talos" else 6.0)


def com_over_feet(session: Session) -> np.ndarray:
    """How far the CoM has moved against the mean of the soles, tick by tick (N, 3), m."""
    column = session.recording.column
    over = column("com") - column("sole_pose")[..., :3].mean(axis=1)
    return over - over[0]


def in_plates(session: Session) -> np.ndarray:
    """Sole origins seen from their plates, tick by tick (N, F, 3), m."""
    soles, plates = (session.recording.column(name) for name in ("sole_pose", "ground_pose"))
    return np.array(
        [
            [pin.XYZQUATToSE3(plate).actInv(sole[:3]) for sole, plate in zip(*tick, strict=True)]
            for tick in zip(soles[::20], plates[::20], strict=True)
        ]
    )


@pytest.mark.parametrize("ground", [SLOPES, TWISTED, HILL, STAIR], ids=["slopes", "twisted", "hill", "stair"])
def test_it_stands_flat_on_every_plate(robot, ground):
    """CoM and soles stay within a tenth of a millimetre, and the soles lie on their plates."""
    session = play(robot, on(robot, ground))
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.abs(com_over_feet(session)).max() < 1e-4
    assert np.abs(in_plates(session)[..., 2]).max() < 1e-5
    assert session.recording.column("equation_residual").max() < 1e-10


def test_15_degrees_on_talos(talos):
    ground = (Plate(("left",), roll_deg=15.0), Plate(("right",), roll_deg=-15.0))
    assert play(talos, on(talos, ground, seconds=1.0)).fall is None


def test_out_of_reach_is_said(g1):
    with pytest.raises(RobotError, match="plates that the legs can reach"):
        Session(on(g1, (Plate(("left",), roll_deg=15.0), Plate(("right",), roll_deg=-15.0))), robot=g1)


def test_a_push_on_slopes_is_caught(robot):
    push = Push(velocity_change=0.15, duration=0.1, start=0.5)
    session = play(robot, on(robot, SLOPES, pushes=(push,)))
    assert session.fall is None
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.02
    wrench = session.recording.column("foot_wrench_measured")
    for foot, roll in enumerate((10.0, -10.0)):
        normal = pin.utils.rotate("x", np.radians(roll))[:, 2]
        pressed = wrench[:, foot, :3] @ normal
        along = np.linalg.norm(wrench[:, foot, :3] - pressed[:, None] * normal, axis=1)
        assert (along <= robot.spec.friction * pressed + 1e-3).all()


@pytest.mark.parametrize("axis", SWAYS)
def test_it_rides_on_a_moving_floor(robot, axis):
    """5 cm or 5 degrees every two seconds, TALOS for 20 s: told of it, the CoM stays over the feet within 4 mm."""
    session = played(robot, riding(robot, axis))
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.abs(com_over_feet(session)).max() < 4e-3
    ridden = in_plates(session)
    assert np.abs(ridden - ridden[0]).max() < 2e-4
    ground = session.recording.column("ground_pose")
    moved = np.ptp(ground[..., :3], axis=0).max() + np.ptp(2.0 * ground[..., 3:6], axis=0).max()
    assert moved > (0.099 if axis in "xy" else 1.99 * np.sin(np.radians(5.0)))


@pytest.mark.parametrize("axis", ["x", "roll"])
def test_it_rides_by_its_soles_alone(robot, axis):
    """Not told, it lags behind: by no more than 2 cm, and on x by at least three times what it is when told."""
    session = play(robot, on(robot, SWAYS[axis], seconds=4.0, ground_sense="felt"))
    assert session.fall is None
    lag = np.abs(com_over_feet(session)).max()
    assert lag < 0.02
    if axis == "x":
        assert lag > 3.0 * np.abs(com_over_feet(played(robot, riding(robot, axis)))).max()


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_every_controller_stands_and_rides(robot, controller):
    ground = (
        Plate(("left",), roll_deg=5.0, motions=(PlateMotion("x", 0.03, start=0.2),)),
        Plate(("right",), pitch_deg=-5.0, motions=(PlateMotion("x", 0.03, start=0.2),)),
    )
    session = play(robot, on(robot, ground, seconds=3.0, controller=controller))
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.abs(com_over_feet(session)).max() < 0.03


def test_ice_under_one_foot_during_a_push(robot):
    """Friction drops to 0.2 as a small push begins: the forces of that foot obey it, and the robot stands."""
    push = Push(velocity_change=0.11, duration=0.1, start=0.5)
    ground = (Plate(("left",), changes=(FrictionChange(0.2, 0.5),)),)
    session = play(robot, on(robot, ground, pushes=(push,)))
    assert session.fall is None
    wrench = session.recording.column("foot_wrench_measured")[501:, 0]
    assert (np.linalg.norm(wrench[:, :2], axis=1) <= 0.2 * wrench[:, 2] + 1e-3).all()


def test_a_slope_steeper_than_its_friction_lets_the_foot_slide(talos):
    """10 degrees and a coefficient of 0.1 < tan 10 under both feet: no law of control helps, and Coulomb's holds."""
    session = play(talos, on(talos, (Plate(roll_deg=10.0, friction=0.1),), seconds=0.2))
    normal = pin.utils.rotate("x", np.radians(10.0))[:, 2]
    force = session.recording.column("foot_wrench_measured")[..., :3].sum(axis=1)
    pressed = force @ normal
    along = np.linalg.norm(force - pressed[:, None] * normal, axis=1)
    assert np.abs(along / pressed - 0.1).max() < 1e-3
    slid = in_plates(session)[-1, :, 1] - in_plates(session)[0, :, 1]
    assert (slid < -0.01).all()


def test_a_scenario_means_the_same_anywhere(g1):
    """Moved by 100 m and turned by 137 degrees with its plates."""
    scenario = on(
        g1,
        (
            Plate(
                ("left",),
                roll_deg=5.0,
                motions=(PlateMotion("pitch", 4.0, start=0.1), PlateMotion("x", 0.03, start=0.1)),
            ),
        ),
        seconds=1.5,
    )
    here, there = play(g1, scenario), play(g1, changed(scenario, position=(100.0, -30.0), heading_deg=137.0))
    turn = pin.utils.rotate("z", np.radians(137.0))
    moved = here.recording.column("com") @ turn.T + [100.0, -30.0, 0.0]
    assert_close(there.recording.column("com"), moved, 1e-6)


def test_the_ground_can_be_moved_by_hand(g1):
    """Events: a step under one foot, then swaying that is stopped; the log replays the same bits."""

    def run(session: Session, posts: dict[int, object]) -> Session:
        for tick in range(4000):
            if tick in posts:
                session.post(posts[tick])
            session.tick()
        return session

    posts = {
        100: MoveGround(PlateMotion("z", 0.02, "step", period=0.5), "left"),
        800: MoveGround(PlateMotion("x", 0.03, period=1.0)),
        1200: SetGroundSense("felt"),
        1600: SetFriction(0.5, "right"),
        2500: StopGround(),
    }
    scenario = on(g1, (), seconds=4.0)
    session = run(Session(scenario, robot=g1), posts)
    assert session.fall is None
    pose = session.recording.column("ground_pose")
    assert_close(pose[-1, :, 2], [0.02, 0.0], 1e-12)
    assert np.ptp(pose[800:2500, :, 0]) > 0.055
    assert_close(pose[3600:, :, 0], np.zeros((400, 2)), 1e-12)
    again = run(Session(scenario, robot=g1), {entry.tick: entry.event for entry in session.log})
    assert again.recording.rows().tobytes() == session.recording.rows().tobytes()


def test_a_branch_on_moving_ground_repeats_the_bits(talos):
    scenario = on(talos, SWAYS["x"], seconds=2.0)
    session = Session(scenario, robot=talos)
    for _ in range(700):
        session.tick()
    session.post(SetFriction(0.3, "left"))
    snapshot = session.snapshot()
    for _ in range(300):
        session.tick()
    first = session.recording.rows()[-300:].copy()
    session.resume(snapshot)
    session.post(SetFriction(0.3, "left"))
    for _ in range(300):
        session.tick()
    assert session.recording.rows()[-300:].tobytes() == first.tobytes()


def test_a_reset_brings_the_ground_back(g1):
    from momentum_lab.events import Reset

    session = Session(on(g1, HILL, seconds=1.0), robot=g1)
    session.post(MoveGround(PlateMotion("x", 0.05, period=0.5)))
    for _ in range(400):
        session.tick()
    session.post(Reset())
    session.tick()
    for _ in range(200):
        assert_close(session.tick()["ground_pose"][:, 0], np.zeros(2), 1e-12)


@pytest.mark.parametrize("name", ["slopes", "bus", "boat", "board", "ice"])
def test_the_scenarios_of_the_ground_are_survived(robot, name):
    scenario = changed(load_scenario(name), robot=robot.spec.name)
    session = play(robot, msgspec.structs.replace(scenario, seconds=min(scenario.seconds, 5.0)))
    assert session.fall is None


@pytest.mark.parametrize(
    ("ground", "named"),
    [
        ([{"feet": ["third"]}], "feet among left, right"),
        ([{"feet": ["left"]}, {}], "one plate under each foot"),
    ],
)
def test_plates_under_no_foot_or_two_are_refused(g1, ground, named):
    with pytest.raises(ScenarioError, match=named):
        Session(changed(Scenario("bad", robot="g1"), ground=ground), robot=g1)


@pytest.mark.parametrize(
    ("ground", "named"),
    [
        ([{"roll_deg": 16.0}], "roll_deg"),
        ([{"roll": 1.0}], "the fields feet, roll_deg"),
        ([{"motions": [{"axis": "yaw", "amplitude": 1.0}]}], "one of x, y, z, roll, pitch"),
        ([{"motions": [{"axis": "x"}]}], "amplitude"),
        ([{"motions": [{"axis": "x", "amplitude": 0.1, "course": "saw"}]}], "one of sine, step"),
        ([{"changes": [{"friction": 0.0}]}], "friction"),
        ([{"motions": [{"axis": "x", "amplitude": float("nan")}]}], "finite"),
    ],
)
def test_bad_plates_are_named(ground, named):
    with pytest.raises(ScenarioError, match=named):
        changed(Scenario("bad"), ground=ground)


def test_the_command_line_chooses_sense_and_friction(capsys):
    bus = ["run", "bus", "--robot", "g1", "--seconds", "2.5", "--json"]
    assert main([*bus, "--ground-sense", "felt", "--friction", "0.6"]) == 0
    felt = json.loads(capsys.readouterr().out)
    assert main(bus) == 0
    told = json.loads(capsys.readouterr().out)
    assert not felt["fell"]
    assert felt["peak_com_excursion"] != told["peak_com_excursion"]
    for words, named in ((["--ground-sense", "seen"], "told, felt"), (["--friction", "0"], "--friction")):
        assert main(["run", "bus", *words]) == 2
        line = capsys.readouterr().err
        assert named in line
        assert line.count("\n") == 1


def test_events_for_feet_and_grounds_that_do_not_exist_are_refused(g1):
    session = Session(on(g1, ()), robot=g1)
    for event, named in (
        (SetFriction(0.5, "third"), "foot"),
        (SetFriction(float("nan")), "friction"),
        (MoveGround(PlateMotion("x", 5.0)), "amplitude"),
        (MoveGround(PlateMotion("x", 0.1), "third"), "foot"),
        (SetGroundSense("guessed"), "ground_sense"),
    ):
        with pytest.raises(InputError, match=named):
            session.post(event)
