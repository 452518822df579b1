"""A finished run as a row of pictures: what to draw, how long each one lasts; plain data, no viewer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from momentum_lab.app.overlays import Picture
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.side_scene import to_the_left
from momentum_lab.choice_words import names_of_chosen
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
class Side:
    """The pictures of the robot beside the first.

    Attributes:
        reel: one picture for every picture of the first; the last ones are alike if its simulation stopped.
        since: the first picture in which it is there.
        names: what to call the first and the second robot.
        offset: from the first robot to where it is drawn (2,), m.
    """

    reel: Reel
    since: int
    names: tuple[str, str]
    offset: np.ndarray


@dataclass(frozen=True, slots=True)
class Reel:
    """The pictures of a run.

    Attributes:
        title: what it shows, for people.
        robot: who was pushed, with its meshes.
        rows: one sample per picture, oldest first (n, width).
        rate: pictures per second of simulated time.
        pushes: all pushes, sized.
        ground: the ground at all times of the run.
        safe_border: the border that the controller kept in the end, m.
        side: the robot beside this one; None when there is none.
    """

    title: str
    robot: LoadedRobot
    rows: np.ndarray
    rate: float
    pushes: tuple[Push, ...]
    ground: Ground
    safe_border: float
    side: Side | None = None

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
        rows = run.recording.rows(every)
        return cls._of(run, robot, rows, every, _side(run, robot, rows, every))

    @classmethod
    def _of(
        cls, run: FinishedRun, robot: LoadedRobot, rows: np.ndarray, every: int, side: Side | None = None
    ) -> Reel:
        return cls(
            _title(run),
            robot,
            rows,
            1.0 / (every * run.scenario.timestep),
            run.pushes,
            _ground(run),
            float(getattr(run.choices.gains, "safe_border", 0.0)),
            side,
        )

    @property
    def span(self) -> tuple[float, float]:
        """Times of the first and the last picture, s of the run."""
        times = self.rows[:, self.robot.layout.slices["time"]]
        return float(times[0, 0]), float(times[-1, 0])

    def time(self, picture: int) -> float:
        """When a picture comes, s since the first one."""
        return picture / self.rate

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


def _side(run: FinishedRun, robot: LoadedRobot, rows: np.ndarray, every: int) -> Side | None:
    """The robot beside the first at the times of the first one's samples (n, width)."""
    beside, time = run.beside, robot.layout.slices["time"]
    if beside is None or not len(beside.recording):
        return None
    own = beside.recording.rows()
    late = (rows[:, time] - own[0, time]) / run.scenario.timestep
    places = np.rint(late.ravel()).astype(int)
    there = np.clip(places, 0, len(own) - 1)
    first = Sample(robot.layout, robot.layout.slices, rows[0])
    return Side(
        Reel._of(beside, robot, own[there], every),
        int(np.searchsorted(places, 0)),
        names_of_chosen(run.choices, beside.choices),
        to_the_left(float(first["com"][2]), first["q"]),
    )


def _title(run: FinishedRun) -> str:
    chosen, robot = run.choices, run.robot.spec.name
    if run.beside is None:
        return " · ".join((run.scenario.name, robot, chosen.controller, f"priority {chosen.priority:g}"))
    names = names_of_chosen(chosen, run.beside.choices)
    same = (chosen.controller,) if chosen.controller == run.beside.choices.controller else ()
    return " · ".join((run.scenario.name, robot, *same, " beside ".join(names)))


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
