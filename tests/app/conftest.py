"""Samples to draw: a robot that stands, and the same robot while its CoP is at the safe border."""

from __future__ import annotations

import pytest

from momentum_lab.recording import Sample
from momentum_lab.robot.model import RobotModel
from momentum_lab.session import Session
from tests.runs import PUSH_END, PUSH_START, forward_push, played


@pytest.fixture(scope="session")
def pushed(talos: RobotModel) -> Session:
    """Talos after the chapter's push from behind."""
    return played(talos, forward_push(talos))


@pytest.fixture
def standing(pushed: Session) -> Sample:
    """Before the push."""
    return sample_at(pushed, PUSH_START - 0.05)


@pytest.fixture
def saturated(pushed: Session) -> Sample:
    """Just after the push: the CoP is on the safe border at the toes."""
    return sample_at(pushed, PUSH_END + 0.02)


def sample_at(session: Session, time: float) -> Sample:
    """The sample of a run at a simulated time."""
    row = session.recording.rows()[round(time / session.scenario.timestep)].copy()
    return Sample.of(session.recording.layout, row)


def changed_sample(sample: Sample, layout: object, **values: object) -> Sample:
    """The same sample with some quantities replaced."""
    other = Sample.of(layout, sample.row.copy())
    for name, value in values.items():
        other[name][...] = value
    return other
