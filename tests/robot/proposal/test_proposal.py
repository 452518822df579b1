"""What a URDF and two sole frames are enough for; the shipped files, measured by hand, are the second opinion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from momentum_lab.errors import RobotError
from momentum_lab.robot.catalog import load_spec
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.proposal import Proposal, propose
from momentum_lab.robot.urdf import robot_data_folder
from momentum_lab.robot.writing import robot_toml
from tests.conftest import assert_close
from tests.robot.conftest import WriteBiped

FRAMES = {
    "romeo": ("l_sole", "r_sole"),
    "icub": ("l_sole", "r_sole"),
    "human": ("left_foot", "right_foot"),
    "simple_humanoid": ("l_ankle", "r_ankle"),
}


@pytest.fixture(scope="module", params=FRAMES)
def proposed(request: pytest.FixtureRequest) -> tuple[str, Proposal]:
    """Each robot's name and the proposal for its URDF."""
    urdf = robot_data_folder() / load_spec(request.param).urdf
    return request.param, propose(urdf, FRAMES[request.param])


def text_of(proposal: Proposal) -> str:
    return "\n".join(f"{remark.grade}: {remark.text}" for remark in proposal.remarks)


def biped(path: Path) -> Proposal:
    return propose(path.with_suffix(".urdf"), ("left_ankle_roll_link", "right_ankle_roll_link"))


FOOT = '<collision><origin xyz="0.02 0 -0.025"/><geometry><box size="0.2 0.08 0.05"/></geometry></collision>'


def with_feet(shape: str = FOOT) -> tuple[tuple[str, str], ...]:
    """Replacements that give the small biped feet of a shape."""
    return tuple(
        (f'<link name="{side}_ankle_roll_link">', f'<link name="{side}_ankle_roll_link">{shape}')
        for side in ("left", "right")
    )


def test_the_parts_are_those_of_the_shipped_file(proposed: tuple[str, Proposal]) -> None:
    name, proposal = proposed
    shipped, spec = load_spec(name), proposal.spec
    assert spec.pelvis == shipped.pelvis
    bodies = dict(shipped.push_bodies)
    bodies["trunk"] = bodies.pop(
        "torso", bodies["trunk"]
    )  # the simple humanoid is pushed at its pelvis instead
    assert spec.push_bodies == bodies
    ours, theirs = RobotModel(spec), RobotModel(shipped)
    for mine, other in zip(ours.soles, theirs.soles, strict=True):
        assert mine.joints.tolist() == other.joints.tolist()
    assert ours.upper_body.tolist() == theirs.upper_body.tolist()


def test_soles_are_those_of_the_shipped_file_within_their_rounded_corners(
    proposed: tuple[str, Proposal],
) -> None:
    """Romeo's and the iCub's feet have round outlines, in which other rectangles are as good."""
    name, proposal = proposed
    loose = {"romeo": 0.006, "icub": 0.014}.get(name, 0.0011)
    for ours, theirs in zip(proposal.spec.feet.values(), load_spec(name).feet.values(), strict=True):
        assert_close([*ours.x, *ours.y], [*theirs.x, *theirs.y], loose)
        assert_close(ours.offset, theirs.offset, 1e-4)
        assert_close(ours.rpy, theirs.rpy, 1e-6)


def test_what_is_written_is_read_back(proposed: tuple[str, Proposal], tmp_path: Path) -> None:
    _, proposal = proposed
    path = tmp_path / "robot.toml"
    path.write_text(robot_toml(proposal.spec, ["as \\ proposed"]))
    assert load_spec(str(path)) == proposal.spec


def test_the_simple_humanoid_is_told_what_is_wrong_with_its_urdf() -> None:
    proposal = propose(robot_data_folder() / load_spec("simple_humanoid").urdf, FRAMES["simple_humanoid"])
    text = text_of(proposal)
    assert "LLEG_KNEE turns -2.10 to 0.70 rad, RLEG_KNEE 0.00 to 2.62" in text
    assert "half_sitting of simple_humanoid.srdf lies outside the URDF's limits: RLEG_ANKLE_P = -0.42" in text
    assert "30 links have the same moments of inertia" in text
    assert "a shape of BODY is 1.7 m across and is left out" in text
    assert "of the effort of WAIST_P" in text


def test_a_box_for_a_foot_gives_its_own_rectangle_and_a_frame_below_the_ankle(
    write_biped: WriteBiped,
) -> None:
    proposal = biped(write_biped(urdf=with_feet()))
    for foot in proposal.spec.feet.values():
        assert_close([*foot.x, *foot.y], [-0.08, 0.12, -0.04, 0.04], 1e-9)
        assert foot.parent is not None
        assert_close(foot.offset, [0.0, 0.0, -0.05], 1e-9)
    assert "50 mm above the sole: left_ankle_roll_link_sole is added" in text_of(proposal)
    assert proposal.fault == ""


def test_the_visual_shape_serves_where_there_is_no_collision_shape(write_biped: WriteBiped) -> None:
    visual = FOOT.replace("collision", "visual")
    foot = biped(write_biped(urdf=with_feet(visual))).spec.feet["left"]
    assert_close([*foot.x, *foot.y], [-0.08, 0.12, -0.04, 0.04], 1e-9)


def test_a_foot_without_a_shape_is_a_guess_in_proportion_to_the_leg(write_biped: WriteBiped) -> None:
    """A person with legs of 0.8 m is 1.63 m tall and has feet of 25 cm (Winter)."""
    proposal = biped(write_biped())
    foot = proposal.spec.feet["left"]
    assert_close(foot.x[1] - foot.x[0], 0.152 * 0.8 / 0.491, 0.003)
    assert "estimated: the left foot has no shape: its rectangle is a guess" in text_of(proposal)


def test_missing_motors_are_guessed_and_named(write_biped: WriteBiped) -> None:
    path = write_biped(urdf=(*with_feet(), ('effort="100"', 'effort="0"')))
    proposal = biped(path)
    assert "missing: no effort limit above 0, a guess instead: neck, left_hip_yaw" in text_of(proposal)
    limits = {name: limit.effort for name, limit in proposal.spec.limits.items()}
    weight_times_leg = 9.81 * 34 * 0.8
    assert_close(limits["left_knee"], 0.3 * weight_times_leg, 10.0)
    assert_close(limits["neck"], 0.03 * weight_times_leg, 1.0)
    assert RobotModel(proposal.spec).effort_limit.min() > 0.0


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ('velocity="10"', 'velocity="0"', "doubtful: no velocity limit, which is not used: neck, "),
        ('velocity="10"', 'velocity="100"', "doubtful: velocity limits above 50 rad/s are placeholders: neck"),
        ('izz="0.02"', 'izz="0.9"', "doubtful: moments of inertia that no solid has: base, "),
        ('<child link="head"/>', '<child link="head"/><mimic joint="left_knee"/>',
         "doubtful: mimic joints are taken for motors of their own: neck"),
        ('<mass value="2"/>', '<mass value="0"/>', "missing: no mass behind these joints: neck"),
        ('<link name="head">', '<link name="head"><visual><geometry><mesh filename="package://no/head.stl"/>'
         "</geometry></visual>", "missing: 1 mesh cannot be read: package://no/head.stl"),
        ('<link name="base">', '<link name="base"><collision><geometry><sphere radius="3"/></geometry></collision>',
         "doubtful: a shape of base is 10.4 m across and is left out"),
    ],
)  # fmt: skip
def test_what_looks_wrong_is_said(write_biped: WriteBiped, old: str, new: str, text: str) -> None:
    assert text in text_of(biped(write_biped(urdf=(*with_feet(), (old, new)))))


def test_feet_given_in_the_wrong_order_look_backwards(write_biped: WriteBiped) -> None:
    path = write_biped(urdf=with_feet(FOOT.replace("0.02 0", "0.04 0")))
    proposal = propose(path.with_suffix(".urdf"), ("right_ankle_roll_link", "left_ankle_roll_link"))
    assert "longer behind its frame than in front: left and right swapped?" in text_of(proposal)


def test_a_robot_whose_legs_cannot_place_their_feet_has_a_reason_instead_of_a_posture(
    write_biped: WriteBiped,
) -> None:
    narrow = '<limit lower="-0.01" upper="0.01" effort="100" velocity="10"/>'
    wide = '<limit lower="-0.6" upper="0.6" effort="100" velocity="10"/>'
    proposal = biped(write_biped(urdf=(*with_feet(), (wide, narrow))))
    assert "standing posture of biped" in proposal.fault


def test_a_mesh_of_a_package_is_found_above_the_urdf_whatever_the_folder_is_called(
    write_biped: WriteBiped,
) -> None:
    source = robot_data_folder() / "simple_humanoid_description" / "meshes" / "box.stl"
    path = write_biped(visual='<visual><geometry><mesh filename="package://my_robot/meshes/cube.stl" '
                              'scale="0.2 0.2 0.2"/></geometry></visual>')  # fmt: skip
    (path.parent / "meshes").mkdir()
    (path.parent / "meshes" / "cube.stl").write_bytes(source.read_bytes())
    proposal = biped(path)
    assert "cannot be read" not in text_of(proposal)
    assert_close(np.ptp(proposal.spec.fall_points["base"], axis=0), [0.2, 0.2, 0.2], 2e-3)


@pytest.mark.parametrize("size", ["0.2 0.004 0.05", "0 0 0.05"])
def test_feet_that_are_lines_or_points_are_refused(write_biped: WriteBiped, size: str) -> None:
    path = write_biped(urdf=with_feet(FOOT.replace("0.2 0.08 0.05", size)))
    with pytest.raises(RobotError, match=r"by \d+ mm; allowed: feet with soles of at least 10 mm"):
        biped(path)


@pytest.mark.parametrize(
    ("soles", "message"),
    [
        (
            ("left_foot", "right_foot"),
            r"soles: got left_foot, right_foot; allowed: LEFT,RIGHT: two frames of the URDF; at the ends of its tree",
        ),
        (
            ("left_knee_link", "left_ankle_roll_link"),
            r"allowed: frames of two feet, each at the end of a leg",
        ),
        (("head", "head"), r"allowed: frames of two feet, each at the end of a leg"),
    ],
)
def test_frames_that_are_no_feet_are_refused(
    write_biped: WriteBiped, soles: tuple[str, str], message: str
) -> None:
    with pytest.raises(RobotError, match=message):
        propose(write_biped().with_suffix(".urdf"), soles)
