from __future__ import annotations

from pathlib import Path

import pytest

from momentum_lab.errors import RobotError
from momentum_lab.robot.model import RobotModel
from momentum_lab.robot.urdf import load_model, read_urdf, robot_data_folder
from tests.robot.conftest import WriteBiped


def test_the_robot_data_package_is_found() -> None:
    assert (robot_data_folder() / "talos_data" / "robots" / "talos_reduced.urdf").is_file()


def test_a_missing_urdf_is_named(write_biped: WriteBiped) -> None:
    path = write_biped(spec=(("biped.urdf", "gone.urdf"),))
    with pytest.raises(
        RobotError, match=r"urdf of biped: got .*gone\.urdf; allowed: a file in the robot-data"
    ):
        RobotModel.named(str(path))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<robot name='a'><link name='b'>", r"a URDF file in XML \(no element found"),
        ("", r"a URDF file in XML \(no element found"),
        ("<sdf><model/></sdf>", r"root is <robot> with links, not <sdf>"),
        ("<robot name='empty'/>", r"root is <robot> with links"),
    ],
)
def test_what_is_no_urdf_is_refused_and_nothing_else_is_printed(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], text: str, message: str
) -> None:
    path = tmp_path / "broken.urdf"
    path.write_text(text)
    with pytest.raises(RobotError, match=message) as caught:
        load_model(path)
    assert str(path) in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_links_without_a_root_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "islands.urdf"
    path.write_text("<robot name='islands'><link name='a'/><link name='b'/></robot>")
    with pytest.raises(RobotError, match=r"islands\.urdf; allowed: a URDF that Pinocchio can read"):
        load_model(path)


def test_a_joint_that_turns_without_end_is_named(write_biped: WriteBiped) -> None:
    path = write_biped(urdf=(('name="neck" type="revolute"', 'name="neck" type="continuous"'),))
    with pytest.raises(RobotError, match="joints with one limited angle or position each, not neck"):
        RobotModel.named(str(path))


def test_the_root_element_is_returned_unchanged(write_biped: WriteBiped) -> None:
    root = read_urdf(write_biped().with_suffix(".urdf"))
    assert root.get("name") == "biped"
    assert len(root.findall("joint")) == 13
