"""Robots on ground that is tilted, high, moving or slippery: in closed loop, with every controller."""

from __future__ import annotations

import json

import msgspec
import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.cli import main
from momentum_lab.control.ground_sense import GROUND_SENSES
from momentum_lab.control.planner import OWN, PLANNERS
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


# Told of the motion, the laws that plan accelerations ride along; resolved momentum plans velocities, and its
# servos lag by about half of a sway.
LAG = {name: 0.02 if name == "resolved-momentum" else 0.002 for name in CONTROLLERS}


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_every_controller_stands_and_rides(robot, controller):
    sway = PlateMotion("x", 0.03, start=0.2)
    ground = (
        Plate(("left",), roll_deg=5.0, motions=(sway,)),
        Plate(("right",), pitch_deg=-5.0, motions=(sway,)),
    )
    session = play(robot, on(robot, ground, seconds=3.2, controller=controller))
    assert session.fall is None
    assert session.solver_failures == 0
    assert np.ptp(session.recording.column("com")[2200:, 0]) > 0.03
    assert np.abs(com_over_feet(session)).max() < LAG[controller]


@pytest.mark.parametrize("planner", [name for name in PLANNERS if name != OWN])
def test_every_planner_rides(robot, planner):
    session = play(robot, on(robot, SWAYS["x"], seconds=5.0, planner=planner))
    assert session.fall is None
    assert np.abs(com_over_feet(session)[..., :2]).max() < 2e-3


def test_the_regulator_rides(robot):
    changes = {"controller": "whole-body-qp", "gains": {"lqr_share": 1.0}}
    session = play(robot, on(robot, SWAYS["x"], seconds=4.0, **changes))
    assert session.fall is None
    assert np.abs(com_over_feet(session)[..., :2]).max() < 2e-3


@pytest.mark.parametrize("sense", GROUND_SENSES)
def test_a_dropped_robot_lands_in_either_sense(robot, sense):
    """Feet in the air feel nothing: nothing is asked of the ground until one of them is pressed."""
    session = play(robot, on(robot, (), seconds=1.5, drop_height=0.05, ground_sense=sense))
    asked = session.recording.column("foot_wrench_admissible")
    assert not asked[:80].any()
    assert session.fall is None


def test_a_plate_may_be_lowered(robot):
    """15 cm down: the floor gives way, and nothing but the soles touches anything."""
    session = Session(on(robot, (), seconds=3.0), robot=robot)
    session.post(MoveGround(PlateMotion("z", -0.15, "step", 2.0)))
    for _ in range(3000):
        session.tick()
    assert session.fall is None
    assert_close(session.recording.latest["ground_pose"][:, 2], [-0.15, -0.15], 1e-12)


def test_one_foot_turns_about_itself_and_all_feet_about_their_middle(g1):
    roll = PlateMotion("roll", 5.0, "step", 1.0)
    for ground in ((), (Plate(("left",), height=0.02), Plate(("right",), height=0.02))):
        moved = {}
        for foot in ("left", ""):
            session = Session(on(g1, ground, seconds=2.0), robot=g1)
            session.post(MoveGround(roll, foot))
            session.tick()
            plates = session.ground.at(9.0)
            moved[foot] = plates.position[:, 2] - session.ground.at(0.0).position[:, 2]
        assert_close(moved["left"], [0.0, 0.0], 1e-12)
        half = 0.5 * g1.spec.home.foot_distance * np.sin(np.radians(5.0))
        assert_close(moved[""], [half, -half], 1e-12)


@pytest.mark.parametrize("seconds", ["5.0", "5.5"])
def test_the_summary_is_told_against_the_ground(seconds, capsys):
    """On a bus the CoM moves with the ground: settled at any phase, and hardly any excursion."""
    assert main(["run", "bus", "--seconds", seconds, "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["settled"]
    assert summary["peak_com_excursion"] < 1e-3


def slip_ratio(session: Session) -> np.ndarray:
    """Force along the ground over force into it, of the left foot from the push on (N,)."""
    wrench = session.recording.column("foot_wrench_measured")[501:, 0]
    return np.linalg.norm(wrench[:, :2], axis=1) / wrench[:, 2]


@pytest.mark.parametrize("friction", [0.2, 0.04])
def test_ice_under_one_foot_during_a_push(robot, friction):
    """Friction drops as a small push begins. 0.2 is more than the push needs; at 0.04 the foot slides by its law."""
    push = Push(velocity_change=0.11, duration=0.1, start=0.5)
    firm = slip_ratio(played(robot, on(robot, (), pushes=(push,)))).max()
    icy = (Plate(("left",), changes=(FrictionChange(friction, 0.5),)),)
    session = play(robot, on(robot, icy, pushes=(push,)))
    assert session.fall is None
    ratio = slip_ratio(session)
    assert ratio.max() <= friction + 1e-6
    if firm > friction:
        assert ratio.max() > 0.999 * friction
        assert firm > 1.2 * friction
    else:
        assert ratio.max() == pytest.approx(firm, rel=1e-3)


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
    """What happened to the ground before a snapshot comes back with it, what happened after it is forgotten."""
    scenario = on(talos, SWAYS["x"], seconds=2.0, ground_sense="felt")
    lift = MoveGround(PlateMotion("z", 0.02, "step", 0.5), "left")

    def run(session: Session, ticks: int) -> bytes:
        for _ in range(ticks):
            session.tick()
        return session.recording.rows()[-ticks:].tobytes()

    undisturbed, session = Session(scenario, robot=talos), Session(scenario, robot=talos)
    for one in (undisturbed, session):
        run(one, 600)
        one.post(lift)
        run(one, 100)
    snapshot = session.snapshot()
    for event in (StopGround(), SetFriction(0.3, "left"), MoveGround(PlateMotion("y", 0.05))):
        session.post(event)
    disturbed = run(session, 300)
    session.resume(snapshot)
    again = run(session, 300)
    assert again == run(undisturbed, 300)
    assert again != disturbed


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
        ([{}, {"motions": [{"axis": "x", "amplitude": 5.0}]}], r"ground\[1\]\.motions\[0\]\.amplitude"),
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
