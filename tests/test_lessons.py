"""Every lesson, played on every robot it names: what it says is what the recording shows."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree

import pytest

from momentum_lab.lesson.loader import lesson_files, load_lesson
from momentum_lab.lesson.parts import Choice, Explain, Lesson, Number, Play, Run
from momentum_lab.lesson.playing import play_lesson, told
from momentum_lab.physics.push import Push
from momentum_lab.robot.model import RobotModel

LESSONS = [load_lesson(path) for path in lesson_files()]
CASES = [(lesson, robot) for lesson in LESSONS for robot in lesson.robots]
NAMES = [f"{lesson.number}-{robot}" for lesson, robot in CASES]


@pytest.mark.parametrize(("lesson", "robot"), CASES, ids=NAMES)
def test_every_claim_holds(lesson: Lesson, robot: str, request: pytest.FixtureRequest) -> None:
    played = play_lesson(lesson, request.getfixturevalue(robot))
    assert [claim for claim in played.claims if not claim.holds] == []
    for step in lesson.steps:
        record = told(step, played)
        assert "nan" not in record["text"]
        assert "{" not in record["text"]
        if isinstance(step, Explain):
            ElementTree.fromstring(record["mathml"])


@pytest.mark.parametrize("lesson", LESSONS, ids=lambda lesson: str(lesson.number))
def test_lesson_asks_before_it_shows(lesson: Lesson) -> None:
    """A question, a prediction, then play, then an explanation; short, and about one thing."""
    kinds = [type(step) for step in lesson.steps]
    predicted = min(kinds.index(kind) for kind in (Choice, Number) if kind in kinds)
    assert predicted < kinds.index(Play) < kinds.index(Explain)
    assert lesson.question.endswith("?")
    assert len(lesson.file.read_text().splitlines()) <= 130
    assert all(run.for_robot(None).seconds <= 5.0 for run in lesson.runs.values())
    assert len({lesson.number for lesson in LESSONS}) == len(LESSONS)


def changed_run(lesson: Lesson, label: str, **changes: object) -> Lesson:
    run = lesson.runs[label]
    return replace(lesson, runs={**lesson.runs, label: Run(run.scenario, {**run.changes, **changes})})


def test_claim_made_false_by_another_scenario_is_caught(g1: RobotModel) -> None:
    """Fig. 7's push with the wrong priority: the robot that is to stand falls, and its words are not true."""
    lesson = next(lesson for lesson in LESSONS if lesson.number == 7)
    played = play_lesson(changed_run(lesson, "bend", priority=1.0), g1)
    failed = {claim.text for claim in played.claims if not claim.holds}
    assert {"the robot that bends does not fall", "the one that bends keeps braking"} <= failed


def test_push_that_is_too_small_is_caught(g1: RobotModel) -> None:
    lesson = next(lesson for lesson in LESSONS if lesson.number == 8)
    small = changed_run(lesson, "push", pushes=(Push(force=1.0, start=0.2),))
    failed = [claim.text for claim in play_lesson(small, g1).claims if not claim.holds]
    assert "the robot asks for more than its feet can give" in failed
