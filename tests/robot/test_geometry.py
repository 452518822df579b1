from __future__ import annotations

import time
from collections import defaultdict
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import trimesh

from momentum_lab.errors import RobotError
from momentum_lab.robot.geometry import LinkMesh, visual_meshes
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.posture import standing_posture
from momentum_lab.robot.urdf import robot_data_folder
from tests.conftest import assert_close
from tests.robot.conftest import WriteBiped

HEIGHTS = {"talos": 1.75, "g1": 1.32, "romeo": 1.40, "icub": 1.04, "human": 1.79, "simple_humanoid": 1.312}
"""Heights standing straight, m: published; a person whose legs of 0.879 m are 0.491 of the height (Winter); the sum
of the simple humanoid's links, 0.105 + 0.3 + 0.3535 + 0.176 + 0.35, and half a ball of a joint on top."""


@pytest.fixture(scope="module")
def meshes(any_robot: RobotModel) -> tuple[LinkMesh, ...]:
    return visual_meshes(any_robot)


def in_world(robot: RobotModel, meshes: tuple[LinkMesh, ...], q: np.ndarray) -> np.ndarray:
    """All vertices in the world (n, 3)."""
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    placed = [m.vertices @ data.oMi[m.joint].rotation.T + data.oMi[m.joint].translation for m in meshes]
    return np.vstack(placed)


def sole_axes(robot: RobotModel) -> np.ndarray:
    """Forward, left and up of the left sole with all joints at zero, in the axes of the root (3, 3)."""
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, pin.neutral(robot.model))
    return data.oMf[robot.soles[0].frame].rotation


def distance_to_surface(meshes: tuple[LinkMesh, ...], point: np.ndarray) -> float:
    """From a point (3,) to the nearest triangle, m."""
    triangles = np.vstack([mesh.vertices[mesh.faces] for mesh in meshes]).astype(float)
    nearest = trimesh.triangles.closest_point(triangles, np.tile(point, (len(triangles), 1)))
    return float(np.linalg.norm(nearest - point, axis=1).min())


def test_a_robot_is_light_enough_to_be_drawn(meshes: tuple[LinkMesh, ...]) -> None:
    assert 9_000 < sum(len(mesh.faces) for mesh in meshes) < 60_000
    assert sum(len(mesh.vertices) for mesh in meshes) < 110_000
    assert 15 < len(meshes) < 65


def test_there_is_one_mesh_per_joint_and_colour(meshes: tuple[LinkMesh, ...]) -> None:
    keys = [(mesh.joint, mesh.color) for mesh in meshes]
    assert len(set(keys)) == len(keys)
    assert [mesh.joint for mesh in meshes] == sorted(mesh.joint for mesh in meshes)


def test_meshes_are_arrays_that_a_viewer_takes(meshes: tuple[LinkMesh, ...]) -> None:
    for mesh in meshes:
        assert (mesh.vertices.dtype, mesh.faces.dtype) == (np.float32, np.uint32)
        assert mesh.vertices.shape[1] == mesh.faces.shape[1] == 3
        assert np.isfinite(mesh.vertices).all()
        assert mesh.faces.max() == len(mesh.vertices) - 1
        assert all(0.0 <= channel <= 1.0 for channel in mesh.color)


def test_the_drawn_robot_is_as_tall_as_the_real_one(
    any_robot: RobotModel, meshes: tuple[LinkMesh, ...]
) -> None:
    up = sole_axes(any_robot)[:, 2]
    heights = in_world(any_robot, meshes, pin.neutral(any_robot.model)) @ up
    assert_close(np.ptp(heights), HEIGHTS[any_robot.spec.name], 0.01)


def test_the_drawn_robot_stands_on_the_ground(any_robot: RobotModel, meshes: tuple[LinkMesh, ...]) -> None:
    points = in_world(any_robot, meshes, standing_posture(any_robot))
    assert_close(points[:, 2].min(), 0.0, 1e-3)
    assert_close(points[:, 1].max(), -points[:, 1].min(), 0.01)


def test_the_sole_rectangle_lies_within_the_drawn_foot(
    any_robot: RobotModel, meshes: tuple[LinkMesh, ...]
) -> None:
    for sole in any_robot.soles:
        frame = any_robot.model.frames[sole.frame]
        foot = np.vstack([mesh.vertices for mesh in meshes if mesh.joint == frame.parentJoint])
        foot = (foot - frame.placement.translation) @ frame.placement.rotation
        assert (foot[:, :2].min(axis=0) < sole.lower).all()
        assert (foot[:, :2].max(axis=0) > sole.upper).all()
        assert -1e-3 < foot[:, 2].min() < 1.5e-3


def test_fall_points_lie_on_the_drawn_robot(any_robot: RobotModel, meshes: tuple[LinkMesh, ...]) -> None:
    for link, points in any_robot.spec.fall_points.items():
        frame = any_robot.model.frames[any_robot.frame(link)]
        body = tuple(mesh for mesh in meshes if mesh.joint == frame.parentJoint)
        for point in points:
            distance = distance_to_surface(body, frame.placement.act(np.array(point)))
            assert distance < 0.03, (link, point, distance)


def test_every_joint_carries_what_pinocchio_loads_for_it(
    any_robot: RobotModel, meshes: tuple[LinkMesh, ...]
) -> None:
    """Bounding boxes against Pinocchio's own loader, which ignores that the iCub's mesh files have y up."""
    share = str(robot_data_folder().parents[1])
    loaded = pin.buildGeomFromUrdf(
        any_robot.model, str(any_robot.urdf), pin.GeometryType.VISUAL, package_dirs=[share]
    )
    upright = pin.utils.rotate("x", np.pi / 2) if any_robot.spec.name == "icub" else np.eye(3)
    expected: dict[int, list[np.ndarray]] = defaultdict(list)
    for shape in loaded.geometryObjects:
        if shape.meshPath not in ("BOX", "CYLINDER", "SPHERE"):
            points = np.array(shape.geometry.vertices()) @ (shape.placement.rotation @ upright).T
            expected[shape.parentJoint].append(points + shape.placement.translation)
    for joint, parts in expected.items():
        points = np.vstack(parts)
        drawn = np.vstack([mesh.vertices for mesh in meshes if mesh.joint == joint])
        assert_close(drawn.min(axis=0), points.min(axis=0), 0.006)
        assert_close(drawn.max(axis=0), points.max(axis=0), 0.006)


def test_colours_come_from_the_urdf_or_from_the_mesh_file(talos: RobotModel) -> None:
    assert {mesh.color for mesh in visual_meshes(talos)} == {
        (0.9, 0.9, 0.9), (0.7, 0.7, 0.7), (0.2, 0.2, 0.2), (0.1, 0.1, 0.1), (1.0, 0.5, 0.0)
    }  # fmt: skip
    icub = visual_meshes(RobotModel.named("icub"))
    assert (0.424, 0.506, 0.639) in {mesh.color for mesh in icub}


def test_a_robot_is_loaded_in_two_seconds(talos: RobotModel) -> None:
    start = time.process_time()
    visual_meshes(talos)
    assert time.process_time() - start < 2.0


def shape_of(write_biped: WriteBiped, shape: str, origin: str = "", material: str = "") -> LinkMesh:
    """The one mesh of a biped whose trunk shows `shape`."""
    visual = f"<visual>{origin}<geometry>{shape}</geometry>{material}</visual>"
    (mesh,) = visual_meshes(RobotModel.named(str(write_biped(visual=visual))))
    assert mesh.joint == 1
    return mesh


@pytest.mark.parametrize(
    ("shape", "half"),
    [
        ('<box size="0.2 0.4 0.6"/>', [0.1, 0.2, 0.3]),
        ('<cylinder radius="0.1" length="0.6"/>', [0.1, 0.1, 0.3]),
        ('<sphere radius="0.1"/>', [0.1, 0.1, 0.1]),
    ],
)
def test_primitives_have_their_size(write_biped: WriteBiped, shape: str, half: list[float]) -> None:
    mesh = shape_of(write_biped, shape)
    assert_close(mesh.vertices.max(axis=0), half, 1e-3)
    assert_close(mesh.vertices.min(axis=0), np.negative(half), 1e-3)


def test_the_origin_turns_and_moves_a_shape(write_biped: WriteBiped) -> None:
    origin = f'<origin xyz="1 2 3" rpy="0 0 {np.pi / 2}"/>'
    mesh = shape_of(write_biped, '<box size="0.2 0.4 0.6"/>', origin)
    assert_close(mesh.vertices.max(axis=0), [1.2, 2.1, 3.3], 1e-6)


def test_a_colour_is_written_in_place_or_named(write_biped: WriteBiped) -> None:
    box = '<box size="1 1 1"/>'
    inline = shape_of(write_biped, box, material='<material name=""><color rgba="1 0.5 0 1"/></material>')
    assert inline.color == (1.0, 0.5, 0.0)
    assert shape_of(write_biped, box).color == (0.7, 0.7, 0.7)
    visual = f'<visual><geometry>{box}</geometry><material name="blue"/></visual>'
    named = '<material name="blue"><color rgba="0 0 1 1"/></material></robot>'
    path = write_biped(visual=visual, urdf=(("</robot>", named),))
    (mesh,) = visual_meshes(RobotModel.named(str(path)))
    assert mesh.color == (0.0, 0.0, 1.0)


def test_a_mirrored_mesh_keeps_its_outside_out(write_biped: WriteBiped, tmp_path: Path) -> None:
    trimesh.creation.box((0.2, 0.4, 0.6)).export(tmp_path / "box.stl")
    mesh = shape_of(write_biped, '<mesh filename="box.stl" scale="1 -1 2"/>')
    assert_close(mesh.vertices.max(axis=0), [0.1, 0.2, 0.6], 1e-6)
    assert_close(trimesh.Trimesh(mesh.vertices, mesh.faces).volume, 0.2 * 0.4 * 1.2, 1e-6)


def test_a_mesh_file_whose_y_axis_is_up_is_set_upright(write_biped: WriteBiped, tmp_path: Path) -> None:
    folder = robot_data_folder() / "icub_description" / "meshes" / "upmc" / "visual"
    text = (folder / "icub_l_hand.dae").read_text()
    assert "Y_UP" in text
    (tmp_path / "y_up.dae").write_text(text)
    (tmp_path / "z_up.dae").write_text(text.replace("Y_UP", "Z_UP"))

    def points(name: str) -> np.ndarray:
        path = write_biped(visual=f'<visual><geometry><mesh filename="{name}"/></geometry></visual>')
        return np.vstack([mesh.vertices for mesh in visual_meshes(RobotModel.named(str(path)))])

    as_written, upright = points("z_up.dae"), points("y_up.dae")
    assert_close(np.ptp(upright, axis=0), np.ptp(as_written, axis=0)[[0, 2, 1]], 1e-6)
    assert_close(upright.max(axis=0)[2], as_written.max(axis=0)[1], 1e-6)


def test_packages_are_found_above_the_urdf(write_biped: WriteBiped, tmp_path: Path) -> None:
    (tmp_path / "my_robot").mkdir()
    trimesh.creation.box((0.2, 0.4, 0.6)).export(tmp_path / "my_robot" / "box.stl")
    mesh = shape_of(write_biped, '<mesh filename="package://my_robot/box.stl"/>')
    assert len(mesh.faces) == 12


def test_simplifying_moves_a_surface_by_millimetres(write_biped: WriteBiped, tmp_path: Path) -> None:
    trimesh.creation.icosphere(6, 0.2).export(tmp_path / "ball.stl")
    mesh = shape_of(write_biped, '<mesh filename="ball.stl"/>')
    assert len(mesh.faces) < 10_000
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    assert_close(np.linalg.norm(centres, axis=1), np.full(len(centres), 0.2), 0.005)


def test_loose_panels_are_left_as_they_are(write_biped: WriteBiped, tmp_path: Path) -> None:
    sphere = trimesh.creation.icosphere(4, 0.2)
    panels = trimesh.util.concatenate([sphere.submesh([[3 * i]])[0] for i in range(600)])
    panels.export(tmp_path / "panels.stl")
    assert len(shape_of(write_biped, '<mesh filename="panels.stl"/>').faces) == 600


def test_sharp_edges_are_not_shared_and_smooth_ones_are(write_biped: WriteBiped) -> None:
    assert len(shape_of(write_biped, '<box size="1 1 1"/>').vertices) == 24
    ball = shape_of(write_biped, '<sphere radius="1"/>')
    assert len(ball.vertices) == len(ball.faces) // 2 + 2


def test_a_missing_mesh_is_named(write_biped: WriteBiped) -> None:
    with pytest.raises(
        RobotError,
        match=r"mesh in biped\.urdf: got package://mine/gone\.stl; allowed: a file .* or a folder above it",
    ):
        shape_of(write_biped, '<mesh filename="package://mine/gone.stl"/>')


@pytest.mark.parametrize("name", ["noise.stl", "noise.dae", "noise.xyzzy"])
def test_an_unreadable_mesh_is_named(write_biped: WriteBiped, tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"\x00\x01 this is no mesh")
    with pytest.raises(
        RobotError, match=r"mesh: got .*noise\.\w+; allowed: a readable mesh file \("
    ) as caught:
        shape_of(write_biped, f'<mesh filename="{name}"/>')
    assert "\n" not in str(caught.value)


def test_an_unknown_shape_is_named(write_biped: WriteBiped) -> None:
    robot = RobotModel.named(str(write_biped()))
    urdf = Path(robot.urdf)
    cone = "<visual><geometry><cone/></geometry></visual></link>"
    urdf.write_text(urdf.read_text().replace("</link>", cone, 1))
    with pytest.raises(
        RobotError, match=r"shape in biped\.urdf: got cone; allowed: mesh, box, cylinder, capsule or sphere"
    ):
        visual_meshes(robot)
