"""What is compared in one browser tab: a robot beside the first, a run that was kept, a push that was foreseen."""

from __future__ import annotations

import numpy as np
import viser

from momentum_lab.app.differences import differences, names_of, with_choices
from momentum_lab.app.foresight import SECONDS
from momentum_lab.app.foresight_scene import PATHS, ForesightScene
from momentum_lab.app.ghost import Ghost, KeptRun
from momentum_lab.app.plots import Plots
from momentum_lab.app.robot_scene import RobotScene
from momentum_lab.app.robots import LoadedRobot
from momentum_lab.app.runs_panel import RunsPanel
from momentum_lab.app.side_scene import SideScene
from momentum_lab.app.story import Facts, Story
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.wire import Frame, Other, Truth, rows_of
from momentum_lab.recording import Sample

_KEPT, _NOW = "A", "now"


class Comparison:
    """Everything beside the one robot that one browser tab shows.

    Args:
        client: the browser tab.
    """

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client
        self._loaded: LoadedRobot | None = None
        self._truth: Truth | None = None
        self._other: Truth | None = None
        # What was the case when the latest push began: a slider that moves later belongs to the next run.
        self._pushed: tuple[Truth, Truth | None] | None = None
        self._stories: list[Story] = []
        self._side: SideScene | None = None
        self._ghost: Ghost | None = None
        self._paths: list[ForesightScene] = []
        self._foreseen_at = 0.0
        self._names: tuple[str, str] | None = None
        self._end = 0.0
        self.kept: KeptRun | None = None

    @property
    def spread(self) -> np.ndarray | None:
        """From the first robot to the one beside it (2,), m; None without one."""
        return None if self._side is None else self._side.offset

    @property
    def other_body(self) -> RobotScene | None:
        """The meshes of the robot beside the first; None without one."""
        return None if self._side is None else self._side.body

    @property
    def other_fell(self) -> bool:
        """Whether the robot beside the first has fallen."""
        return self._other is not None and self._other.fall is not None

    def middle(self, place: np.ndarray) -> np.ndarray:
        """Between the first robot, seen from above (2,), and the one beside it; the first one's place without one."""
        return place if self._side is None else 0.5 * (place + self._side.place_on_ground)

    def begin(self, frame: Frame, loaded: LoadedRobot, panel: RunsPanel, plots: Plots) -> None:
        """Do what was asked for since the last frame, and leave an older run or robot behind."""
        if panel.wants_forgotten:
            panel.wants_forgotten = False
            self._forget()
            plots.forget()
        if panel.wants_kept:
            panel.wants_kept = False
            self._keep(plots)
        if self._truth is None or frame.truth.run != self._truth.run:
            self._stories = [Story(loaded.model, loaded.layout) for _ in range(2)]
            self._show_paths(())
            if self._loaded is not loaded:
                self._leave_side()
        self._loaded, self._truth = loaded, frame.truth
        self._other = None if frame.other is None else frame.other.truth
        self._note_push()

    def draw(self, frame: Frame, sample: Sample, settings: ViewSettings) -> bool:
        """Draw what belongs beside the robot; whether a second robot has come or gone.

        Args:
            frame: what is new.
            sample: the first robot's.
            settings: what a person has chosen to see.
        """
        had = self._side is not None
        if frame.other is None:
            self._leave_side()
        else:
            self._draw_other(frame.other, frame.truth, sample, settings)
        if self._ghost is not None:
            self._ghost.draw(frame.truth, sample.number("time"))
        return had != (self._side is not None)

    def after(self, frame: Frame, sample: Sample, panel: RunsPanel, plots: Plots) -> None:
        """Take note of a frame's samples, and show what they amount to."""
        if self._loaded is None:
            return
        width = self._loaded.layout.width
        self._note_way_back(sample.number("time") + frame.truth.behind)
        self._stories[0].add(rows_of(frame.history, width))
        if frame.other is None:
            self._stories[1] = Story(self._loaded.model, self._loaded.layout)
            plots.alone()
        else:
            others = rows_of(frame.other.history, width)
            self._stories[1].add(others)
            plots.add_beside(others)
        if frame.foreseen:
            self._foresee(frame)
        elif self._has_come_true(frame.truth, sample.number("time")):
            self._show_paths(())
        panel.follow(frame.truth, self.kept is not None)
        if self.kept is not None:
            plots.ahead = self.kept.ahead(frame.truth, sample.number("time"))
        if self._ghost is not None:
            self._ghost.show(panel.shows_ghost)
        if panel.is_time():
            self._compare(panel)

    @property
    def paths(self) -> tuple[str, ...]:
        """Keys of the marks whose paths are drawn."""
        return PATHS if self._paths else ()

    def tried(self, foreseeing: float | None) -> str:
        """What is known of a push that is only tried, in a sentence; empty without one.

        Args:
            foreseeing: how much of it is worked out, from 0 to 1; None when nothing is being tried.
        """
        if foreseeing is not None:
            return f"Trying the push on a copy: {100.0 * foreseeing:.0f} %."
        truth = self._truth
        pushed = truth is not None and truth.push is not None and truth.push.start >= self._foreseen_at
        words = [] if pushed else [path.words for path in self._paths]
        if len(words) > 1 and truth is not None and self._other is not None:
            names = self._names or names_of(truth, self._other)
            words = [f"{name}: {each}" for name, each in zip(names, words, strict=True)]
        return f"Tried, not pushed: {'. '.join(words)}." if words else ""

    def _draw_other(self, other: Other, first: Truth, sample: Sample, settings: ViewSettings) -> None:
        if self._loaded is None:
            return
        loaded = self._loaded
        beside = Sample.of(loaded.layout, rows_of(other.row, loaded.layout.width)[0])
        if self._side is None:
            self._side = SideScene(self._client, loaded, beside)
            self._side.see_through(settings)
        self._side.draw(beside, other.truth, settings)
        self._names = other.names or names_of(first, other.truth)
        self._side.name(self._names, (sample["com"], beside["com"]))

    def see_through(self, settings: ViewSettings) -> None:
        """Whether marks inside a body show, as a person has chosen."""
        if self._side is not None:
            self._side.see_through(settings)

    def _note_push(self) -> None:
        """Remember the choices under which the robots were pushed."""
        if self._truth is None or self._truth.push is None:
            self._pushed = None
        elif self._pushed is None or (self._pushed[0].run, self._pushed[0].push) != (
            self._truth.run,
            self._truth.push,
        ):
            self._pushed = (self._truth, self._other)

    def _note_way_back(self, end: float) -> None:
        """After a way back the run goes on with what has been chosen by then: that is what it is told apart by.

        Args:
            end: of the run, s.
        """
        if self._pushed is not None and self._truth is not None and end < self._end:
            self._pushed = (self._truth, self._other)
        self._end = end

    def _as_pushed(self) -> tuple[Truth, Truth | None]:
        """What is the case with both robots, with the choices under which they were pushed."""
        assert self._truth is not None
        if self._pushed is None:
            return self._truth, self._other
        first, other = self._pushed
        other = self._other if self._other is None or other is None else with_choices(self._other, other)
        return with_choices(self._truth, first), other

    def _keep(self, plots: Plots) -> None:
        """Keep the run of now."""
        if self._truth is None or self._loaded is None or not len(self._stories[0]):
            return
        self._forget()
        self.kept = KeptRun(self._as_pushed()[0], self._loaded, self._stories[0].copy())
        self._ghost = Ghost(self._client, self.kept)
        plots.keep()

    def _forget(self) -> None:
        if self._ghost is not None:
            self._ghost.remove()
        self._ghost = self.kept = None

    def _foresee(self, frame: Frame) -> None:
        roots = ("", "/beside")
        self._foreseen_at = frame.foreseen[0].start
        self._show_paths(tuple(zip(roots, frame.foreseen, strict=False)))

    def _has_come_true(self, truth: Truth, simulated: float) -> bool:
        """Whether the robot has been pushed since it was foreseen, and all of that is over."""
        push = truth.push
        return (
            bool(self._paths) and push is not None and self._foreseen_at <= push.start < simulated - SECONDS
        )

    def _show_paths(self, foreseen: tuple) -> None:
        for path in self._paths:
            path.remove()
        self._paths = []
        loaded = self._loaded
        if loaded is not None:
            self._paths = [
                ForesightScene(self._client, loaded, each, root)
                for root, each in foreseen
                if each.rows and (not root or self._side is not None)
            ]

    def _compare(self, panel: RunsPanel) -> None:
        """Put the runs side by side in the table."""
        truth, other = self._as_pushed()
        runs: list[tuple[str, Truth, Story]] = [(_NOW, truth, self._stories[0])]
        if other is not None:
            names = names_of(truth, other)
            runs = [(names[0], truth, self._stories[0]), (names[1], other, self._stories[1])]
        if self.kept is not None:
            runs.insert(0, (_KEPT, self.kept.truth, self.kept.story))
        runs = [run for run in runs if len(run[2])]
        columns: list[tuple[str, Facts]] = [(name, story.facts(each)) for name, each, story in runs]
        panel.compare(columns, differences([each for _, each, _ in runs]))

    def _leave_side(self) -> None:
        if self._side is not None:
            self._side.remove()
            self._side = None
