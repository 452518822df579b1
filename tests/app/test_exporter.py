"""Files about a run that plays: each made in another process, each the session's own numbers."""

from __future__ import annotations

import io
import tempfile

import msgspec
import numpy as np
import pytest
from PIL import Image

from momentum_lab.app import recorder
from momentum_lab.app.birth import warm_up
from momentum_lab.app.exporter import finished, made, made_elsewhere
from momentum_lab.app.playback import Playback
from momentum_lab.app.snapshot import encoded
from momentum_lab.app.wire import RunTaken, packed, rows_of, unpacked_answer
from momentum_lab.beside import Beside
from momentum_lab.errors import InputError
from momentum_lab.events import ApplyPush, SetBeside, SetGain, SetPriority
from momentum_lab.physics.push import Push
from momentum_lab.recording import Layout
from momentum_lab.robot.model import RobotModel
from momentum_lab.run_file import decoded, run_of_trace
from momentum_lab.scenario import Scenario
from momentum_lab.trace import load_trace


@pytest.fixture(scope="module")
def playback() -> Playback:
    playback = Playback(Scenario("s", robot="g1", gains={"friction": 0.5}))
    playback.take(ApplyPush(Push(force=40.0)))
    playback.tick(60)
    return playback


@pytest.fixture(scope="module")
def taken(playback) -> RunTaken:
    return playback.recorded()


def test_a_run_goes_through_the_pipe(taken):
    assert unpacked_answer(packed(taken)) == taken


def test_what_comes_out_is_the_session(playback, taken):
    run, session = finished(taken), playback.session
    assert np.array_equal(run.recording.rows(), session.recording.rows(), equal_nan=True)
    assert (run.choices, run.pushes, run.time) == (session.choices, session.pushes, session.time)
    assert (run.fall, run.stance) == (None, session.stance)


def test_a_trace_made_elsewhere(playback, taken):
    warm_up()
    trace = load_trace(io.BytesIO(made_elsewhere("trace", taken)), "trace.npz")
    assert np.array_equal(trace.columns["com"], playback.session.recording.column("com"))
    assert run_of_trace(trace) == taken.run


def test_a_trace_needs_no_folder_that_a_process_which_is_stopped_could_leave(taken, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", "/nowhere")
    assert made("trace", taken).startswith(b"PK")


def test_every_other_kind(taken):
    assert decoded("r.json", made("run", taken)) == taken.run
    assert made("table", taken).startswith(b"time [s],q/base_x [m],")
    assert b"__VISER_EMBED_DATA__" in made("recording", taken)
    assert Image.open(io.BytesIO(made("plots", taken))).format == "PNG"


@pytest.mark.parametrize("kind", ["recording", "viser"])
def test_recordings_are_of_what_happens_around_the_pushes(taken, monkeypatch, kind):
    """A robot that stands for a minute and is pushed after 50 s: from 49 s to 5 s after the push."""
    layout = Layout.of(RobotModel.named("g1"))
    rows = np.repeat(rows_of(taken.rows, layout.width)[:1], 60, axis=0)
    rows[:, layout.slices["time"]] = np.arange(60.0)[:, None]
    late = msgspec.structs.replace(taken, rows=rows.tobytes(), pushes=(Push(force=40.0, start=50.0),))
    monkeypatch.setattr(recorder, "html_file", lambda run: run.recording)
    monkeypatch.setattr(recorder, "viser_file", lambda run: run.recording)
    times = made(kind, late).column("time")
    assert (times[0], times[-1]) == (49.0, 55.0)
    assert len(rows_of(late.rows, layout.width)) == 60


def test_a_recording_made_elsewhere_is_the_one_made_here(taken):
    warm_up()
    assert made_elsewhere("viser", taken) == made("viser", taken)


def test_what_cannot_be_made_is_told():
    warm_up()
    empty = Playback(Scenario("s", robot="g1")).taken()
    with pytest.raises(InputError, match=r"^download: got report; allowed: .*at least one tick"):
        made_elsewhere("report", empty)


def test_a_picture_is_on_white():
    pixels = np.zeros((4, 6, 4), dtype=np.uint8)
    pixels[:2] = (10, 20, 30, 255)
    picture = np.array(Image.open(io.BytesIO(encoded(pixels))))
    assert picture.shape == (4, 6, 3)
    assert picture[0, 0].tolist() == [10, 20, 30]
    assert picture[3, 5].tolist() == [255, 255, 255]


def test_both_robots_are_in_what_is_taken():
    playback = Playback(Scenario("s", robot="g1", beside=Beside(priority=1.0)))
    playback.tick(20)
    playback.take(ApplyPush(Push(force=40.0)))
    playback.tick(20)
    assert playback.taken().other is None
    run = finished(unpacked_answer(packed(playback.recorded())))
    session = playback.beside.session
    assert np.array_equal(run.beside.recording.rows(), session.recording.rows(), equal_nan=True)
    assert (run.choices.priority, run.beside.choices.priority) == (0.0, 1.0)
    assert run.beside.pushes == session.pushes
    trace = load_trace(io.BytesIO(made("trace", playback.recorded())), "trace.npz")
    assert np.array_equal(trace.columns["com"], playback.session.recording.column("com"))
    assert trace.second.keys() == trace.columns.keys()
    assert np.array_equal(trace.second["com"], session.recording.column("com"))
    assert run_of_trace(trace) == run.run


def test_a_second_that_came_later_is_taken_with_all_that_was_chosen_before():
    playback = Playback(Scenario("s", robot="g1"))
    playback.take(SetPriority(0.25))
    playback.take(SetGain("linear_damping", 9.0))
    playback.tick(30)
    playback.take(SetBeside(Beside(gains={"angular_damping": 7.0})))
    playback.tick(20)
    run = finished(playback.recorded())
    assert run.beside.choices == playback.beside.session.choices
    assert run.choices.differing(run.beside.choices) == {"angular_damping"}
    assert (run.since, run.beside.since) == (0.0, pytest.approx(0.031))
    page = made("report", playback.recorded()).decode()
    assert "angular damping 5</th><th>angular damping 7</th>" in page
