"""A finished run as a row of pictures: what to draw, how long each one lasts; plain data, no viewer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.app.overlays import Picture
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.effects import ground_after
from momentum_lab.errors import InputError
from momentum_lab.events import Reset
from momentum_lab.finished import FinishedRun
from momentum_lab.physics.ground import Ground
from momentum_lab.physics.push import Push
from momentum_lab.recording import Sample
from momentum_lab.terrain import terrain

PICTURES_PER_SECOND = 25
"""Of simulated time; an eye sees no steps, and every tick is still within 20 ms of a picture."""


@dataclass(frozen=True, slots=True)
class Reel:
    """The pictures of a run.

    Attributes:
        title: what it shows, for people.
        robot: who was pushed, with its meshes.
        rows: one sample per picture, oldest first (n, width).
        step: simulated time from one picture to the next, s.
        pushes: all pushes, sized.
        ground: the ground at all times of the run.
        safe_border: the border that the controller kept in the end, m.
    """

    title: str
    robot: LoadedRobot
    rows: np.ndarray
    step: float
    pushes: tuple[Push, ...]
    ground: Ground
    safe_border: float

    @classmethod
    def of(cls, run: FinishedRun, robot: LoadedRobot) -> Reel:
        """The pictures of a run since its robot last stood up, as far back as it was recorded.

        Args:
            run: the run.
            robot: its robot.

        Raises:
            InputError: nothing was recorded.
        """
        timestep = run.scenario.timestep
        every = max(1, round(1.0 / (PICTURES_PER_SECOND * timestep)))
        if not len(run.recording):
            raise InputError("recording", "no samples", "a run of at least one tick")
        return cls(
            _title(run),
            robot,
            run.recording.rows(every),
            every * timestep,
            run.pushes,
            _ground(run),
            float(getattr(run.choices.gains, "safe_border", 0.0)),
        )

    @property
    def seconds(self) -> float:
        """How long it plays, s of simulated time."""
        return len(self.rows) * self.step

    @property
    def samples(self) -> list[Sample]:
        """One per picture."""
        layout, slices = self.robot.layout, self.robot.layout.slices
        return [Sample(layout, slices, row) for row in self.rows]

    def picture(self, sample: Sample, arrow_scale: float) -> Picture:
        """What the marks of a sample need to know besides it, and how long arrows are."""
        begun = [push for push in self.pushes if push.start <= sample.number("time")]
        latest = max(begun, key=lambda push: push.start, default=None)
        return Picture(self.robot.model, latest, self.safe_border, arrow_scale)


def _title(run: FinishedRun) -> str:
    words = (
        run.scenario.name,
        run.robot.spec.name,
        run.choices.controller,
        f"priority {run.choices.priority:g}",
    )
    return " · ".join(words)


def _ground(run: FinishedRun) -> Ground:
    """What the scenario's ground became by all that was done to it since the robot last stood up."""
    first = ground = terrain(run.scenario, run.robot, run.stance)
    stood_up = run.ticks * run.scenario.timestep - run.time
    for entry in run.log:
        time = entry.tick * run.scenario.timestep - stood_up
        ground = (
            first if isinstance(entry.event, Reset) else ground_after(ground, entry.event, run.robot, time)
        )
    return ground
