"""All robots of the catalog, and a small biped that tests can bend and break."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from momentum_lab.robot.model import RobotModel

CATALOG = ("g1", "human", "icub", "romeo", "simple_humanoid", "talos")

INERTIAL = """<inertial><mass value="{mass}"/>
  <inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>"""

LEG = (
    # joint, axis, origin below the parent, limits
    ("hip_yaw", "0 0 1", "0 {y} 0", "-1 1"),
    ("hip_roll", "1 0 0", "0 0 0", "-0.6 0.6"),
    ("hip_pitch", "0 1 0", "0 0 0", "-2 1"),
    ("knee", "0 1 0", "0 0 -0.4", "-0.1 2.5"),
    ("ankle_pitch", "0 1 0", "0 0 -0.4", "-1 1"),
    ("ankle_roll", "1 0 0", "0 0 0", "-0.6 0.6"),
)

SPEC = """
name = "biped"
title = "Biped"
urdf = "{urdf}"
pelvis = "base"
trunk = "base"
upper_body = ["neck"]

[feet.left]
frame = "left_sole"
parent = "left_ankle_roll_link"
offset = [0.0, 0.0, -0.05]
x = [-0.08, 0.12]
y = [-0.04, 0.04]
joints = ["left_*"]

[feet.right]
frame = "right_sole"
parent = "right_ankle_roll_link"
offset = [0.0, 0.0, -0.05]
x = [-0.08, 0.12]
y = [-0.04, 0.04]
joints = ["right_*"]

[home]
foot_distance = 0.2
base_height = 0.8

[home.joints]
"*_hip_pitch" = -0.35
"*_knee" = 0.7
"*_ankle_pitch" = -0.35

[push_bodies]
trunk = "base"
"""


@pytest.fixture(scope="session", params=CATALOG)
def any_robot(request: pytest.FixtureRequest) -> RobotModel:
    """Each robot of the catalog in turn."""
    return RobotModel.named(request.param)


WriteBiped = Callable[..., Path]


@pytest.fixture
def write_biped(tmp_path: Path) -> WriteBiped:
    """Writes the small biped and gives the path of its TOML file.

    `urdf` and `spec` list (old, new) replacements in the two texts.
    """

    def write(
        urdf: tuple[tuple[str, str], ...] = (), spec: tuple[tuple[str, str], ...] = (), visual: str = ""
    ) -> Path:
        model, text = biped_urdf(visual), SPEC.format(urdf=tmp_path / "biped.urdf")
        for old, new in urdf:
            assert old in model
            model = model.replace(old, new)
        for old, new in spec:
            assert old in text
            text = text.replace(old, new)
        (tmp_path / "biped.urdf").write_text(model)
        (tmp_path / "biped.toml").write_text(text)
        return tmp_path / "biped.toml"

    return write


def biped_urdf(visual: str) -> str:
    """A trunk with a neck joint on two legs of six joints; `visual` is put into the trunk."""
    parts = ['<robot name="biped">', f'<link name="base">{INERTIAL.format(mass=20)}{visual}</link>']
    parts += _joint("neck", "0 0 1", "0 0 0.5", "-1 1", "base", "head", mass=2)
    for side, y in (("left", 0.1), ("right", -0.1)):
        parent = "base"
        for name, axis, origin, limits in LEG:
            link = f"{side}_{name}_link"
            parts += _joint(f"{side}_{name}", axis, origin.format(y=y), limits, parent, link, mass=1)
            parent = link
    return "\n".join([*parts, "</robot>"])


def _joint(name: str, axis: str, xyz: str, limits: str, parent: str, link: str, mass: float) -> list[str]:
    lower, upper = limits.split()
    return [
        f'<link name="{link}">{INERTIAL.format(mass=mass)}</link>',
        f'<joint name="{name}" type="revolute"><origin xyz="{xyz}"/><axis xyz="{axis}"/>',
        f'<parent link="{parent}"/><child link="{link}"/>',
        f'<limit lower="{lower}" upper="{upper}" effort="100" velocity="10"/></joint>',
    ]
