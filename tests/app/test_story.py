"""What a run amounts to, against its summary and against the recording itself."""

from __future__ import annotations

import numpy as np
import pytest

from momentum_lab.app.differences import differences, names_of, with_choices
from momentum_lab.app.ghost import Ghost, KeptRun
from momentum_lab.app.playback import Playback
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.runs_panel import table
from momentum_lab.app.story import Story
from momentum_lab.beside import Beside
from momentum_lab.events import ApplyPush
from momentum_lab.headless import Timing
from momentum_lab.physics.mismatch import Mismatch
from momentum_lab.physics.push import Push
from momentum_lab.scenario import Scenario, load_scenario
from momentum_lab.summary import summarize
from tests.app.fakes import FakeClient
from tests.runs import settled_after


@pytest.fixture(scope="module")
def fig7() -> Playback:
    """Both robots of the chapter's Fig. 7 after 2 s: the first stands, the second has fallen."""
    playback = Playback(load_scenario("fig7"))
    playback.tick(1999)
    return playback


def story_of(session) -> Story:
    story = Story(session.robot, session.recording.layout)
    story.add(session.recording.rows(20))
    return story


def test_facts_are_those_of_the_summary(fig7):
    truth = fig7.truth(1.0)
    for session, told in ((fig7.session, truth), (fig7.beside.session, fig7.beside_truth(truth))):
        facts = story_of(session).facts(told)
        summary = summarize(session, Timing(np.array([1e-4]), 1.0))
        # The story looks at every 20th tick: a fall of 1 m/s moves 20 mm meanwhile.
        assert facts.excursion == pytest.approx(summary.peak_com_excursion, abs=0.02)
        assert facts.angular_momentum == pytest.approx(summary.peak_angular_momentum, rel=0.1)
        assert facts.margin == pytest.approx(summary.min_cop_margin, abs=0.006)
        assert (facts.fall_time is None) == (summary.fall_time is None)
    assert facts.fall_time == pytest.approx(summary.fall_time - 0.2)
    assert facts.settled_after is None


def test_at_rest_after_the_last_time_that_the_com_was_fast(fig7):
    facts = story_of(fig7.session).facts(fig7.truth(1.0))
    assert facts.settled_after == pytest.approx(settled_after(fig7.session) - 0.2, abs=0.021)


@pytest.mark.parametrize("second", [0.05, 0.6])
def test_times_count_from_the_latest_push_before(second):
    """A light push, and a second later one that it withstands or that fells it."""
    playback = Playback(Scenario("s", robot="g1"))
    playback.take(ApplyPush(Push(velocity_change=0.02)))
    playback.tick(999)
    playback.take(ApplyPush(Push(velocity_change=second)))
    playback.tick(2500)
    session, fall = playback.session, playback.session.fall
    if fall is not None:
        playback.take(ApplyPush(Push(velocity_change=0.01)))  # is none before the fall
        playback.tick(100)
    truth = playback.truth(1.0)
    facts = story_of(session).facts(truth)
    assert (fall is not None) == (second > 0.3)
    if fall is not None:
        assert facts.fall_time == pytest.approx(fall.time - 1.0)
    else:
        assert facts.settled_after == pytest.approx(settled_after(session) - 1.0, abs=0.021)
    text = table([("A", facts), ("now", facts)], {})
    assert "seconds count from the latest push before" in text


def test_a_branch_replaces_what_came_after_it(pushed):
    story = story_of(pushed)
    rows = pushed.recording.rows(20)
    story.add(rows[50:60])
    assert len(story) == 60
    np.testing.assert_allclose(story.posture(1e9), rows[59][story.layout.slices["q"]], rtol=0.0, atol=1e-12)


def test_posture_between_two_samples(pushed):
    story = story_of(pushed)
    for tick in (350, 353, 360):
        q = pushed.recording.column("q")[tick]
        found = story.posture(float(pushed.recording.column("time")[tick]))
        # Joints accelerate by up to 60 rad/s^2: within 20 ms that bends a line by a t^2 / 8 = 3e-3 rad.
        np.testing.assert_allclose(found, q, rtol=0.0, atol=3e-3)
        assert np.linalg.norm(found[3:7]) == pytest.approx(1.0)


# What differs


def test_only_what_differs_is_told(fig7):
    first = fig7.truth(1.0)
    second = fig7.beside_truth(first)
    assert differences([first, second]) == {"priority": ("0", "1")}
    assert names_of(first, second) == ("priority 0", "priority 1")
    assert names_of(first, first) == ("first", "second")


def test_another_controller_has_no_gains_of_the_first():
    playback = Playback(Scenario("s", robot="g1", beside=Beside("slack-qp")))
    first = playback.truth(1.0)
    second = playback.beside_truth(first)
    found = differences([first, second])
    assert found["controller"] == ("computed-torque", "slack-qp")
    assert found["com weight"][0] == "–"
    assert names_of(first, second) == ("computed-torque", "slack-qp")


# The ghost


def kept_run(pushed) -> KeptRun:
    """The chapter's push at 0.2 s, kept; told as the app would tell it."""
    truth = Playback(Scenario("s")).truth(1.0)
    truth = type(truth)(
        **{**{f: getattr(truth, f) for f in truth.__struct_fields__}, "first_push": Push(start=0.2)}
    )
    loaded = LoadedRobot(pushed.robot, (), pushed.recording.layout)
    return KeptRun(truth, loaded, story_of(pushed))


def test_the_ghost_is_pushed_when_the_robot_is(pushed):
    kept = kept_run(pushed)
    playback = Playback(Scenario("s"))
    assert kept.time(playback.truth(1.0), 0.1) == pytest.approx(0.1)
    assert kept.time(playback.truth(1.0), 7.0) == pytest.approx(0.2)  # waits for a push
    playback.tick(499)
    playback.take(ApplyPush(Push(force=50.0)))
    playback.tick(100)
    assert kept.time(playback.truth(1.0), 0.6) == pytest.approx(0.3)


def test_the_ghost_stands_where_the_kept_robot_was(pushed):
    kept, client = kept_run(pushed), FakeClient()
    ghost = Ghost(client, kept)
    playback = Playback(Scenario("s"))
    truth = playback.truth(1.0)
    for _ in range(2):
        ghost.draw(truth, 0.15)
    base = client.scene.nodes["/ghost/1"]
    np.testing.assert_allclose(base.position, pushed.recording.column("q")[150][:3], atol=1e-3)
    ghost.show(False)
    assert not base.visible
    ghost.remove()
    assert base.removed


def test_a_wrong_model_is_a_difference():
    exact, heavy = (
        Playback(Scenario("stand", robot="g1", mismatch=mismatch)).truth(1.0)
        for mismatch in (Mismatch(), Mismatch(mass_error=0.1))
    )
    assert differences([exact, heavy]) == {"model: mass error": ("0", "0.1")}
    assert with_choices(exact, heavy).mismatch == heavy.mismatch
