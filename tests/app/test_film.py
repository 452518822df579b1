"""Films: every picture of a run goes to ffmpeg in its order and size, and the tab's scene is as before."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from momentum_lab.app.encoder import encoder, ffmpeg
from momentum_lab.app.film import film
from momentum_lab.app.reel import Reel
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.errors import InputError
from momentum_lab.finished import FinishedRun
from momentum_lab.robot.model import RobotModel
from momentum_lab.scenario import Scenario
from momentum_lab.session import Session
from tests.app.fakes import FakeClient, FakeHandle

# Keeps what it is told beside the film, which it makes out of the first bytes of the pictures.
FAKE = f"""#!{sys.executable}
import json, sys
data = sys.stdin.buffer.read()
print("this is only a warning", file=sys.stderr)
open({{log!r}}, "w").write(json.dumps({{{{"words": sys.argv[1:], "bytes": len(data)}}}}))
open(sys.argv[-1], "wb").write(b"film" + data[:: {{stride}}])
"""
BROKEN = f"""#!{sys.executable}
import sys
print("Unknown encoder 'mp4'\\n", file=sys.stderr)
sys.exit(1)
"""


class Tab(FakeClient):
    """A tab that answers every request for a picture with one of a single grey, brighter every time."""

    def __init__(self) -> None:
        super().__init__()
        self.camera = FakeHandle(
            position=np.array([3.0, -2.0, 1.0]),
            wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
            fov=0.5,
            image_width=641,
            image_height=401,
        )
        self.asked: list[dict] = []

    def get_render(self, height: int, width: int, **kw: object) -> np.ndarray:
        self.asked.append({"height": height, "width": width, **kw})
        return np.full((height, width, 3), len(self.asked), dtype=np.uint8)


def program(folder: Path, text: str) -> None:
    path = folder / "ffmpeg"
    path.write_text(text)
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The only folder on the PATH."""
    monkeypatch.setenv("PATH", str(tmp_path))
    return tmp_path


@pytest.fixture(scope="module")
def reel(g1: RobotModel) -> Reel:
    session = Session(Scenario("s", robot="g1", seconds=0.2), robot=g1)
    for _ in range(121):
        session.tick()
    run = FinishedRun.of(session)
    return Reel.of(run, LoadedRobot(run.robot, (), run.recording.layout))


def test_ffmpeg_gets_every_picture_and_what_it_makes_is_the_film(folder, reel):
    log, (width, height) = folder / "log.json", (712, 400)
    program(folder, FAKE.format(log=str(log), stride=width * height * 3))
    tab, fractions = Tab(), []
    assert film(tab, reel, ViewSettings(), 720, fractions.append) == b"film\x01\x02\x03\x04"
    told = json.loads(log.read_text())
    assert told["bytes"] == 4 * width * height * 3
    words = " ".join(told["words"])
    assert "-f rawvideo -pix_fmt rgb24 -s 712x400 -r 25 -i -" in words
    assert words.endswith(".mp4")
    assert fractions == [0.25, 0.5, 0.75, 1.0]


def test_the_tab_looks_from_where_it_did_at_a_robot_below_the_floor(folder, reel):
    program(folder, FAKE.format(log=str(folder / "log.json"), stride=1000))
    tab = Tab()
    film(tab, reel, ViewSettings(), 720, lambda _: None)
    assert {(asked["width"], asked["height"], asked["fov"]) for asked in tab.asked} == {(712, 400, 0.5)}
    studio = tab.scene.nodes["/film"]
    for asked in tab.asked:
        assert asked["position"] - studio.position == pytest.approx(tab.camera.position)
    assert studio.removed
    assert {name.split("/")[1] for name in tab.scene.nodes} == {"film"}


def test_without_ffmpeg_nothing_begins(folder, reel):
    tab = Tab()
    with pytest.raises(
        InputError, match=r"^film: got no ffmpeg on the lab's machine; allowed: .*apt install"
    ):
        film(tab, reel, ViewSettings(), 720, lambda _: None)
    assert tab.scene.nodes == {}
    assert tab.asked == []


def test_an_ffmpeg_that_fails_is_quoted(folder, reel):
    program(folder, BROKEN)
    tab = Tab()
    with pytest.raises(InputError, match="failed: Unknown encoder 'mp4'"):
        film(tab, reel, ViewSettings(), 720, lambda _: None)
    assert tab.scene.nodes["/film"].removed


def test_a_browser_that_has_gone_and_a_film_that_is_stopped_leave_nothing(folder, reel, monkeypatch):
    program(folder, FAKE.format(log=str(folder / "log.json"), stride=1000))
    tab = Tab()
    stopped = InputError("film", "stopped", "x")

    def stop(fraction: float) -> None:
        raise stopped

    with pytest.raises(InputError) as caught:
        film(tab, reel, ViewSettings(), 720, stop)
    assert caught.value is stopped
    assert tab.scene.nodes["/film"].removed

    def gone(*_: object, **__: object) -> None:
        raise RuntimeError("the client disconnected")

    monkeypatch.setattr(tab, "get_render", gone)
    with pytest.raises(InputError, match=r"^picture: got no answer"):
        film(tab, reel, ViewSettings(), 720, lambda _: None)


def test_the_real_one_makes_a_film_of_that_length(tmp_path):
    path = tmp_path / "film.mp4"
    with encoder(path, (64, 48), 25.0) as write:
        for grey in range(0, 250, 10):
            write(np.full((48, 64, 3), grey, dtype=np.uint8))
    probe = Path(ffmpeg()).with_name("ffprobe")
    words = [probe, "-v", "error", "-show_entries", "stream=width,height,nb_frames", "-of", "json", path]
    told = json.loads(subprocess.run(words, capture_output=True, check=True, env=os.environ).stdout)
    assert told["streams"] == [{"width": 64, "height": 48, "nb_frames": "25"}]


def test_a_small_film_is_small(folder, reel):
    program(folder, FAKE.format(log=str(folder / "log.json"), stride=1000))
    tab = Tab()
    film(tab, reel, ViewSettings(), 360, lambda _: None)
    assert {(asked["width"], asked["height"]) for asked in tab.asked} == {(640, 360)}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("position", np.array([1.0, np.nan, 0.0])),
        ("wxyz", (1.0, 0.0, np.inf, 0.0)),
        ("fov", np.nan),
        ("fov", 0.0),
        ("fov", 4.0),
        ("image_height", 0),
        ("image_height", None),
    ],
)
def test_a_camera_that_tells_nonsense_takes_no_film(folder, reel, name, value):
    program(folder, FAKE.format(log=str(folder / "log.json"), stride=1000))
    tab = Tab()
    setattr(tab.camera, name, value)
    with pytest.raises(InputError, match=r"^camera: got .*; allowed: "):
        film(tab, reel, ViewSettings(), 720, lambda _: None)
    assert (tab.asked, tab.scene.nodes) == ([], {})
