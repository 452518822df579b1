"""Presets: those that ship stand the chapter's push; one's own are written whole or not at all."""

from __future__ import annotations

import os

import numpy as np
import pytest

from momentum_lab.control.presets import (
    SHIPPED,
    STANDARD,
    Preset,
    preset_named,
    presets,
    save_preset,
)
from momentum_lab.control.registry import CONTROLLERS
from momentum_lab.errors import GainError, InputError
from tests.runs import forward_push, play


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    return tmp_path / "momentum_lab" / "presets" / "computed-torque"


@pytest.mark.parametrize("name", SHIPPED)
@pytest.mark.parametrize("controller", CONTROLLERS)
def test_it_stands_the_chapters_push(controller, name, robot):
    """And the CoM is nearly at rest a second later, without a solve that failed."""
    gains = preset_named(name, controller).gains
    session = play(robot, forward_push(robot, seconds=1.3, controller=controller, gains=gains))
    assert session.fall is None
    assert np.linalg.norm(session.recording.latest["com_velocity"]) < 0.05
    assert session.solver_failures == 0


@pytest.mark.parametrize("controller", CONTROLLERS)
def test_the_standard_preset_is_all_defaults_and_the_others_are_not(controller):
    found = presets(controller)
    assert tuple(found) == SHIPPED
    assert found[STANDARD].gains == {}
    assert found["soft"].values(controller) != found["stiff"].values(controller)


def test_own_presets_are_kept_and_found_again(own_folder):
    path = save_preset("my-own", "computed-torque", {"linear_damping": 0.1 + 0.2, "friction": 0.6})
    assert path.parent == own_folder
    assert preset_named("my-own", "computed-torque").gains == {"linear_damping": 0.1 + 0.2}
    assert tuple(presets("computed-torque")) == (*SHIPPED, "my-own")
    assert "my-own" not in presets("slack-qp")


def test_a_preset_may_lie_anywhere(tmp_path):
    path = tmp_path / "Of a friend.toml"
    path.write_text("[gains]\nlinear_damping = 7.0\n")
    assert preset_named(str(path), "computed-torque").gains == {"linear_damping": 7.0}
    path.write_text("[gains]\nno_such_gain = 7.0\n")
    with pytest.raises(InputError, match=r"^preset: got .*friend\.toml; allowed: .*no_such_gain"):
        preset_named(str(path), "computed-torque")
    with pytest.raises(InputError, match="No such file"):
        preset_named(str(tmp_path / "none.toml"), "computed-torque")


@pytest.mark.parametrize("name", ["soft", "", "../up", "Big", "a" * 41, "a b", "ä"])
def test_names_that_are_refused(name, own_folder):
    with pytest.raises(InputError, match=r"^preset: got .*; allowed: 1 to 40 small letters"):
        save_preset(name, "computed-torque", {})
    assert not own_folder.exists()


def test_a_gain_out_of_range_saves_nothing(own_folder):
    with pytest.raises(GainError, match="linear_damping"):
        save_preset("mine", "computed-torque", {"linear_damping": 1e9})
    assert not own_folder.exists()


def test_a_folder_that_cannot_be_written_is_told(own_folder):
    own_folder.parent.mkdir(parents=True)
    own_folder.write_text("in the way")
    with pytest.raises(InputError, match="a file that can be written"):
        save_preset("mine", "computed-torque", {})
    assert own_folder.read_text() == "in the way"


def test_a_disk_that_fails_leaves_the_old_preset_as_it_was(own_folder, monkeypatch):
    path = save_preset("mine", "computed-torque", {"linear_damping": 9.0})
    before = path.read_bytes()

    def full(*_):
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(InputError, match="No space left"):
        save_preset("mine", "computed-torque", {"linear_damping": 7.0})
    assert [entry.name for entry in own_folder.iterdir()] == ["mine.toml"]
    assert path.read_bytes() == before


def test_foreign_files_are_left_out_and_named_when_asked_for(own_folder):
    own_folder.mkdir(parents=True)
    (own_folder / "odd.toml").write_text("[gains]\nmagic = 1.0\n")
    assert tuple(presets("computed-torque")) == SHIPPED
    with pytest.raises(InputError, match=r"odd\.toml; allowed: a TOML file with gains of computed-torque"):
        preset_named("odd", "computed-torque")


def test_unknown_preset_lists_the_known_ones():
    with pytest.raises(InputError, match=r"^preset: got nope; allowed: one of soft, chapter-like, stiff"):
        preset_named("nope", "computed-torque")


def test_values_are_all_gains():
    values = Preset({"linear_damping": 3.0}).values("computed-torque")
    assert values["linear_damping"] == 3.0
    assert values["linear_stiffness"] == 16.0
