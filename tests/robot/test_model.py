from __future__ import annotations

from dataclasses import fields

import numpy as np
import pinocchio as pin
import pytest

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import load_spec
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.state import Dynamics, State
from momentum_lab.robot.urdf import bare_urdf
from tests.conftest import assert_close, random_state
from tests.robot.conftest import CATALOG, WriteBiped

STEP = 1e-6
ROUNDED = 1e-4
"""The URDFs give right angles with four or five digits."""


@pytest.fixture
def state(any_robot: RobotModel) -> State:
    return random_state(any_robot, np.random.default_rng(3))


def test_facts_of_the_two_complete_robots(talos: RobotModel, g1: RobotModel) -> None:
    assert (talos.nq, talos.nv, talos.na) == (39, 38, 32)
    assert (g1.nq, g1.nv, g1.na) == (36, 35, 29)
    assert_close([talos.mass, g1.mass], [90.272, 33.341], 5e-4)


@pytest.mark.parametrize(("name", "mass"), [("romeo", 40.529), ("icub", 28.347)])
def test_masses_of_the_other_robots(name: str, mass: float) -> None:
    assert_close(RobotModel.named(name).mass, mass, 1e-3)


def test_legs_have_six_joints_and_the_upper_body_has_the_rest(any_robot: RobotModel) -> None:
    legs = np.concatenate([sole.joints for sole in any_robot.soles])
    assert [len(sole.joints) for sole in any_robot.soles] == [6, 6]
    assert sorted([*legs, *any_robot.upper_body]) == list(range(any_robot.na))
    assert any_robot.foot_names == ("left", "right")


def test_every_joint_has_limits_a_motor_and_a_rotor(any_robot: RobotModel) -> None:
    assert (any_robot.position_lower < any_robot.position_upper).all()
    assert (any_robot.effort_limit > 0.4).all()
    armature = any_robot.model.armature
    assert_close(armature[:6], np.zeros(6), 0.0)
    assert ((armature[6:] >= 1e-3) & (armature[6:] <= 0.2)).all()


def test_g1_armature_is_the_rotor_inertia_behind_its_gears(g1: RobotModel) -> None:
    rotor, carrier, output = 0.489e-4, 0.098e-4, 0.533e-4
    first, second = 4.5, 1 + 48 / 22
    reflected = rotor * (first * second) ** 2 + carrier * second**2 + output
    hip = g1.matching_joints(["*_hip_pitch_joint"])
    assert_close(g1.model.armature[6 + hip], [reflected, reflected], 1e-8)


def test_later_armature_patterns_win(talos: RobotModel) -> None:
    grippers = talos.matching_joints(["gripper_*"])
    others = np.setdiff1d(np.arange(talos.na), grippers)
    assert (talos.model.armature[6 + grippers] == 0.01).all()
    assert (talos.model.armature[6 + others] == 0.1).all()


def test_the_added_sole_of_g1_lies_35_mm_below_the_ankle(g1: RobotModel, rng: np.random.Generator) -> None:
    state = random_state(g1, rng)
    dynamics = g1.at(state)
    data = g1.model.createData()
    pin.framesForwardKinematics(g1.model, data, state.q)
    for i, name in enumerate(("left_ankle_roll_link", "right_ankle_roll_link")):
        ankle = data.oMf[g1.frame(name)]
        assert_close(dynamics.sole_position[i], ankle.translation - 0.035 * ankle.rotation[:, 2], 1e-12)
        assert_close(dynamics.sole_rotation[i], ankle.rotation, 1e-12)


def test_soles_look_up_and_forward_when_all_joints_are_zero(any_robot: RobotModel) -> None:
    dynamics = any_robot.at(State(pin.neutral(any_robot.model), np.zeros(any_robot.nv)))
    left, right = dynamics.sole_rotation
    assert_close(left[:, 2], [0.0, 1.0, 0.0] if any_robot.spec.name == "human" else [0.0, 0.0, 1.0], ROUNDED)
    assert_close(left, right, ROUNDED)
    across = left.T @ (dynamics.sole_position[0] - dynamics.sole_position[1])
    assert across[1] > 0.1
    assert_close(across[[0, 2]], [0.0, 0.0], ROUNDED)


def test_corners_go_round_the_rectangle_counter_clockwise(any_robot: RobotModel) -> None:
    for sole in any_robot.soles:
        edges = np.roll(sole.corners, -1, axis=0) - sole.corners
        turns = np.cross(edges, np.roll(edges, -1, axis=0))[:, 2]
        width, length = sole.upper[1] - sole.lower[1], sole.upper[0] - sole.lower[0]
        assert_close(turns, np.full(4, width * length), 1e-12)
        assert 0.04 < width < length <= 0.25
        assert_close(sole.corners[0], [*sole.lower, 0.0], 0.0)


def test_mass_matrix_and_nonlinear_effects_solve_the_inverse_dynamics(
    any_robot: RobotModel, state: State
) -> None:
    dynamics, data = any_robot.at(state), any_robot.model.createData()
    acceleration = np.random.default_rng(4).normal(size=any_robot.nv)
    torque = pin.rnea(any_robot.model, data, state.q, state.v, acceleration)
    assert_close(dynamics.mass_matrix @ acceleration + dynamics.nonlinear_effects, torque, 1e-10)
    assert_close(dynamics.mass_matrix, dynamics.mass_matrix.T, 0.0)


def test_momentum_is_the_sum_over_the_links(any_robot: RobotModel, state: State) -> None:
    dynamics = any_robot.at(state)
    model, data = any_robot.model, any_robot.model.createData()
    pin.forwardKinematics(model, data, state.q, state.v)
    momentum, moment, velocity = np.zeros(6), np.zeros(3), np.zeros(3)
    for joint in range(1, model.njoints):
        inertia, placement, twist = model.inertias[joint], data.oMi[joint], data.v[joint]
        centre = placement.act(inertia.lever)
        speed = placement.rotation @ (twist.linear + np.cross(twist.angular, inertia.lever))
        spin = placement.rotation @ (inertia.inertia @ twist.angular)
        momentum[:3] += inertia.mass * speed
        momentum[3:] += np.cross(centre - dynamics.com_in_world, inertia.mass * speed) + spin
        moment += inertia.mass * centre
        velocity += inertia.mass * speed
    assert_close(dynamics.momentum, momentum, 1e-10)
    assert_close(dynamics.centroidal_map @ state.v, momentum, 1e-10)
    assert_close(dynamics.com_in_world, moment / any_robot.mass, 1e-12)
    assert_close(dynamics.com_velocity, velocity / any_robot.mass, 1e-12)


def test_bias_terms_are_what_moves_while_v_is_constant(any_robot: RobotModel, state: State) -> None:
    """Central differences along the motion with constant v: d(A_G v)/dt and d(J v)/dt."""
    dynamics = any_robot.at(state)
    before, after = (
        any_robot.at(State(any_robot.integrate(state.q, step * state.v), state.v)) for step in (-STEP, STEP)
    )

    def rate(of: str) -> np.ndarray:
        return (getattr(after, of) @ state.v - getattr(before, of) @ state.v) / (2 * STEP)

    assert_close(dynamics.centroidal_bias, rate("centroidal_map"), 2e-4)
    assert_close(dynamics.sole_bias, rate("sole_jacobian"), 1e-5)
    assert_close(dynamics.pelvis_bias, rate("pelvis_jacobian"), 1e-5)


def test_jacobians_are_the_velocities_of_the_placements(any_robot: RobotModel, state: State) -> None:
    dynamics = any_robot.at(state)
    before, after = (
        any_robot.at(State(any_robot.integrate(state.q, step * state.v), state.v)) for step in (-STEP, STEP)
    )
    velocity = dynamics.sole_jacobian @ state.v
    assert_close(velocity[:, :3], (after.sole_position - before.sole_position) / (2 * STEP), 1e-7)
    for i in range(2):
        turn = pin.log3(after.sole_rotation[i] @ before.sole_rotation[i].T) / (2 * STEP)
        assert_close(velocity[i, 3:], turn, 1e-7)
    pelvis_turn = pin.log3(after.pelvis_rotation @ before.pelvis_rotation.T) / (2 * STEP)
    assert_close((dynamics.pelvis_jacobian @ state.v)[3:], pelvis_turn, 1e-7)


def test_locked_inertia_gives_the_angular_momentum_of_a_rigid_turn(
    any_robot: RobotModel, state: State
) -> None:
    dynamics = any_robot.at(state)
    spin = np.array([0.3, -0.7, 0.5])
    data = any_robot.model.createData()
    pin.forwardKinematics(any_robot.model, data, state.q)
    base = data.oMi[1]
    v = np.zeros(any_robot.nv)
    v[:3] = base.rotation.T @ np.cross(spin, base.translation - dynamics.com_in_world)
    v[3:6] = base.rotation.T @ spin
    assert_close((dynamics.centroidal_map @ v)[3:], dynamics.locked_inertia @ spin, 1e-10)


def test_a_state_gives_the_same_bits_whatever_was_computed_before(any_robot: RobotModel) -> None:
    rng = np.random.default_rng(5)
    state, other = random_state(any_robot, rng), random_state(any_robot, rng)
    fresh = RobotModel(any_robot.spec).at(state)
    any_robot.at(other)
    pin.aba(any_robot.model, any_robot.data, other.q, other.v, np.ones(any_robot.nv))
    pin.computeAllTerms(any_robot.model, any_robot.data, other.q, other.v)
    assert_same(any_robot.at(state), fresh)


def test_earlier_dynamics_are_not_overwritten_by_later_ones(any_robot: RobotModel) -> None:
    rng = np.random.default_rng(6)
    first, second = random_state(any_robot, rng), random_state(any_robot, rng)
    dynamics = any_robot.at(first)
    kept = {f.name: np.copy(getattr(dynamics, f.name)) for f in fields(Dynamics) if f.name != "state"}
    q, v = first.q.copy(), first.v.copy()
    any_robot.at(second)
    for name, value in kept.items():
        assert np.array_equal(getattr(dynamics, name), value), name
    assert np.array_equal(first.q, q)
    assert np.array_equal(first.v, v)


def assert_same(left: Dynamics, right: Dynamics) -> None:
    for f in fields(Dynamics):
        if f.name != "state":
            assert np.array_equal(getattr(left, f.name), getattr(right, f.name)), f.name


def test_integrate_moves_the_base_along_its_own_axes(any_robot: RobotModel) -> None:
    q = pin.neutral(any_robot.model)
    q[3:7] = [0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]
    step = np.zeros(any_robot.nv)
    step[0], step[8] = 0.1, 0.2
    moved = any_robot.integrate(q, step)
    assert_close(moved[:3], [0.0, 0.1, 0.0], 1e-12)
    assert_close(moved[9], q[9] + 0.2, 1e-12)


def test_an_unknown_frame_is_answered_with_the_links(g1: RobotModel) -> None:
    with pytest.raises(
        RobotError, match=r"frame of g1: got tail; allowed: one of pelvis, imu_in_pelvis, left_hip"
    ):
        g1.frame("tail")


def test_a_pattern_without_a_joint_is_answered_with_the_joints(g1: RobotModel) -> None:
    with pytest.raises(
        RobotError, match=r"joints of g1: got tail_\*; allowed: patterns of left_hip_pitch_joint,"
    ):
        g1.matching_joints(["left_*", "tail_*"])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'pelvis = "base"',
            'pelvis = "hips"',
            r"frame of biped: got hips; allowed: one of base, left_hip",
        ),
        ('trunk = "base"\nupper', 'trunk = "chest"\nupper', r"frame of biped: got chest"),
        ('parent = "left_ankle_roll_link"', 'parent = "toe"', r"frame of biped: got toe"),
        ('parent = "left_ankle_roll_link"\n', "", r"frame of biped: got left_sole"),
        (
            'frame = "left_sole"',
            'frame = "head"',
            r"feet\.left\.frame: got head; allowed: a new name, or no parent",
        ),
        ('[push_bodies]\ntrunk = "base"', '[push_bodies]\ntrunk = "arm"', r"frame of biped: got arm"),
        (
            "[push_bodies]",
            "[fall_points]\nhorn = [[0.0, 0.0, 0.0]]\n[push_bodies]",
            r"frame of biped: got horn",
        ),
        ("[push_bodies]", '[armature]\n"wing_*" = 0.1\n[push_bodies]', r"joints of biped: got wing_\*"),
        ('upper_body = ["neck"]', 'upper_body = ["arm_*"]', r"joints of biped: got arm_\*"),
        ('"*_knee" = 0.7', '"*_elbow" = 0.7', r"joints of biped: got \*_elbow"),
        (
            'joints = ["left_*"]',
            'joints = ["left_*", "neck"]',
            r"feet\.left\.joints of biped: got neck; allowed: joints between pelvis and foot",
        ),
    ],
)
def test_names_that_the_urdf_lacks_are_refused_at_loading(
    write_biped: WriteBiped, old: str, new: str, message: str
) -> None:
    with pytest.raises(RobotError, match=message) as caught:
        RobotModel.named(str(write_biped(spec=((old, new),))))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "limit",
    [
        '<limit lower="-1" upper="1" effort="0" velocity="10"/>',
        '<limit lower="0" upper="0" effort="100" velocity="10"/>',
        '<limit effort="100" velocity="10"/>',
    ],
)
def test_joints_without_usable_limits_are_named(write_biped: WriteBiped, limit: str) -> None:
    neck = '<limit lower="-1" upper="1" effort="100" velocity="10"/>'
    path = write_biped()
    urdf = path.with_suffix(".urdf")
    urdf.write_text(urdf.read_text().replace(neck, limit, 1))
    with pytest.raises(RobotError, match="joint limits of biped: got neck; allowed: an effort above 0"):
        RobotModel.named(str(path))


def test_an_arm_has_no_feet_to_stand_on(write_biped: WriteBiped) -> None:
    path = write_biped()
    text = path.read_text().replace(str(path.with_suffix(".urdf")), "talos_data/robots/talos_left_arm.urdf")
    path.write_text(text)
    with pytest.raises(RobotError, match="frame of biped: got left_ankle_roll_link; allowed: one of"):
        RobotModel.named(str(path))


@pytest.mark.parametrize("name", CATALOG)
def test_push_bodies_and_fall_points_are_links_of_the_robot(name: str) -> None:
    spec, robot = load_spec(name), RobotModel.named(name)
    for link in (*spec.push_bodies.values(), *spec.fall_points):
        assert robot.model.frames[robot.frame(link)].type == pin.FrameType.BODY


def test_limits_of_the_file_replace_those_of_the_urdf_everywhere(write_biped: WriteBiped) -> None:
    limits = (
        '[limits."*_knee"]\nlower = 0.2\neffort = 55.0\n\n[limits.left_knee]\nupper = 1.5\n\n[push_bodies]'
    )
    robot = RobotModel.named(str(write_biped(spec=(("[push_bodies]", limits),))))
    left, right = robot.matching_joints(["left_knee"]), robot.matching_joints(["right_knee"])
    for knee, upper in ((left, 1.5), (right, 2.5)):
        assert_close(robot.position_lower[knee], [0.2], 0.0)
        assert_close(robot.position_upper[knee], [upper], 0.0)
        assert_close(robot.effort_limit[knee], [55.0], 0.0)
    joint = next(
        j for j in bare_urdf(robot.urdf, robot.spec).findall("joint") if j.get("name") == "left_knee"
    )
    assert joint.find("limit").attrib == {"lower": "0.2", "upper": "1.5", "effort": "55.0", "velocity": "10"}
    assert (robot.effort_limit == 100.0).sum() == robot.na - 2
