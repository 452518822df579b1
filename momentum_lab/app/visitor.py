"""One browser tab: its own session in its own process, its own scene, its own panels."""

from __future__ import annotations

import math
import threading
import traceback
from collections.abc import Callable
from pathlib import Path

import numpy as np
import viser

from momentum_lab.app.camera import LOOSE, START_VIEW, TIGHT, VIEWS
from momentum_lab.app.comparison import Comparison
from momentum_lab.app.control_panel import Choices
from momentum_lab.app.demo_stage import DemoStage
from momentum_lab.app.exporter import finished
from momentum_lab.app.film import film
from momentum_lab.app.first_pose import FirstPose
from momentum_lab.app.lesson_wire import LessonEvent
from momentum_lab.app.library import Library
from momentum_lab.app.link import Link
from momentum_lab.app.marks import FEW_LABELS, Theme
from momentum_lab.app.notices import Notices
from momentum_lab.app.page_plan import PagePlan
from momentum_lab.app.panels import Panels
from momentum_lab.app.profile import RenderProfile
from momentum_lab.app.pulling import Reach
from momentum_lab.app.reel import Reel
from momentum_lab.app.robots import LoadedRobot, RobotShelf
from momentum_lab.app.share_panel import Sharing
from momentum_lab.app.snapshot import view_of
from momentum_lab.app.stage import Stage
from momentum_lab.app.telling import told
from momentum_lab.app.view_panel import ViewSettings
from momentum_lab.app.wire import Frame, RunTaken, Truth, rows_of
from momentum_lab.app.world import add_floor, add_world
from momentum_lab.errors import InputError
from momentum_lab.events import Branch, Event
from momentum_lab.experiments.window import around_pushes
from momentum_lab.recording import Sample
from momentum_lab.run_file import Run


class Visitor:
    """Draws the session of one browser tab and hands on what its person wants.

    Args:
        client: the browser tab.
        shelf: loaded robots.
        first: what the session starts with.
        pose: how its robot stands before the session has told.
        choices: what can be chosen.
        profile: how much to draw.
        url: where the lab is served.
        library: the lessons.
        lesson: the script of the lesson to begin with.
        demo: how long nobody has to touch the tab before it plays by itself, s; None: it never does.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        shelf: RobotShelf,
        first: Run,
        pose: FirstPose,
        choices: Choices,
        profile: RenderProfile,
        url: str,
        library: Library,
        lesson: Path | None = None,
        demo: float | None = None,
    ) -> None:
        self._url, self._library, self._lesson = url, library, lesson
        self._client, self._shelf, self._profile = client, shelf, profile
        self._choices, self._pose = choices, pose
        self._plan = PagePlan.of(client)
        self._link = Link(first, choices.robots, choices.scenarios)
        self._stage: Stage | None = None
        self._view = START_VIEW
        self._panels: Panels | None = None
        self._comparison, self._notices = Comparison(client), Notices(client)
        self._demo = DemoStage(client, self._link.ask, self._robot, demo)
        self._run = -1
        self._floor: tuple[float, Theme] = (0.0, "light")
        self._left = False
        # A browser has only so much time for drawing: none of it goes to what moves while it draws a film.
        self._filming = threading.Event()
        self.frames = 0
        self.latest: Frame | None = None
        self._thread = threading.Thread(target=self._live, name=f"visitor-{client.client_id}", daemon=True)
        self._thread.start()

    @property
    def client(self) -> viser.ClientHandle:
        """The browser tab."""
        return self._client

    @property
    def worker_pid(self) -> int | None:
        """Process id of the session."""
        return self._link.process.pid

    def post(self, event: Event) -> None:
        """Hand an event to the session; tell the person if it is not allowed."""
        self._demo.demo.touch()
        if isinstance(event, Branch) and self._panels is not None:
            self._panels.hand.give_up()  # what it holds is forgotten, or let go there
        try:
            self._link.post(event)
        except InputError as error:
            self.tell(str(error))

    def _ask(self, event: LessonEvent) -> None:
        self._demo.demo.touch()
        self._link.ask(event)

    def tell(self, words: str) -> None:
        """Show a notice."""
        self._notices.tell(words)

    def close(self) -> None:
        """End the session and the drawing: the tab has been closed."""
        self._left = True
        self._demo.close()
        if self._panels is not None:
            self._panels.learn.close()
        self._link.close()
        self._thread.join()

    def _live(self) -> None:
        """Draw frames until the session ends."""
        try:
            add_world(self._client, self._profile)
            self._appear()
            for frame in self._link.frames():
                self._draw(frame)
                self.latest = frame
                self.frames += 1
        except Exception:
            traceback.print_exc()
            self._link.close()
        if self._panels is not None and not self._left:
            self._panels.status.end()

    def _appear(self) -> None:
        """Show the robot while its session still starts: a browser then draws it before it makes the panels."""
        pose = self._pose
        with self._client.atomic():
            stage = self._set_stage(pose.robot, self._shelf.get(pose.robot), pose.q, pose.com_height)
            stage.body.see_through(ViewSettings().see_through)
        self._client.flush()

    def _draw(self, frame: Frame) -> None:
        """Everything that is new in a frame, sent at once."""
        truth = frame.truth
        loaded = self._shelf.get(truth.robot)
        sample = Sample.of(loaded.layout, rows_of(frame.row, loaded.layout.width)[0])
        if self._panels is not None:
            self._comparison.begin(frame, loaded, self._panels.runs, self._panels.plots)
        stage = self._set_stage(truth.robot, loaded, sample["q"], float(sample["com"][2]))
        self._demo.before(stage.camera, frame.demo)
        panels = self._panels or self._furnish(truth, loaded.layout.foot_names)
        self._comparison.begin(frame, loaded, panels.runs, panels.plots)
        if truth.run != self._run:
            self._run = truth.run
            panels.plots.clear()
        changed = not self._filming.is_set() and self._draw_picture(stage, panels, frame, sample)
        if changed:
            self._look(self._view)
            self._reach_other(panels, stage)
        self._demo.after(stage.camera, self._comparison.spread, frame.demo)
        self._client.flush()
        self._draw_panels(panels, frame, loaded, sample)

    def _set_stage(self, name: str, loaded: LoadedRobot, q: np.ndarray, size: float) -> Stage:
        """The stage for the robot that plays; the one before it leaves."""
        if self._stage is not None and self._stage.name == name:
            return self._stage
        if self._stage is not None:
            self._stage.remove()
        self._stage = Stage.of(self._client, name, loaded, q, size, self._plan.covered)
        self._look(self._view)
        if self._panels is not None:
            self._receive(self._panels, self._stage)
        return self._stage

    def _furnish(self, truth: Truth, feet: tuple[str, ...]) -> Panels:
        self._panels = Panels(
            self._client,
            self._plan,
            self.post,
            self.tell,
            self._look,
            self._link.want_frame,
            self._choices,
            truth,
            self._sharing(),
            feet,
            self._ask,
            self._library,
            self._lesson,
            self._demo,
        )
        if self._stage is not None:
            self._receive(self._panels, self._stage)
        return self._panels

    def _robot(self) -> str:
        """Which robot plays."""
        return "" if self._stage is None else self._stage.name

    def _sharing(self) -> Sharing:
        return Sharing(
            self._link.take_run,
            self._link.take_recording,
            self._link.open,
            self.tell,
            lambda name, content: self._client.send_file_download(name, content, save_immediately=True),
            lambda: view_of(self._client),
            self._reel,
            self._film,
            self._url,
            self._link.take_back,
            self._notices.say,
            self._notices.warn,
        )

    def _reel(self, taken: RunTaken) -> Reel:
        """The pictures of a run, around its pushes."""
        return Reel.of(around_pushes(finished(taken)), self._shelf.get(taken.run.scenario.robot))

    def _film(self, reel: Reel, lines: int, report: Callable[[float], None]) -> bytes:
        """A run as this tab would show it, as an .mp4 file; the tab's own picture stands still meanwhile."""
        if self._panels is None:
            raise InputError("film", "a page without panels", "a page that has been loaded")
        self._filming.set()
        try:
            return film(self._client, reel, self._panels.settings, lines, report)
        finally:
            self._filming.clear()
            self._link.want_frame()

    def _receive(self, panels: Panels, stage: Stage) -> None:
        """Fit the panels to the robot on stage."""
        panels.push.set_robot(stage.loaded)
        panels.hand.reach(Reach(stage.body, stage.loaded, stage.size, np.zeros(3)))
        panels.learn.set_robot(stage.loaded)
        panels.begin_plots(stage.loaded)
        panels.ground.set_feet(stage.loaded.layout.foot_names)
        panels.settings.changed = True

    def _draw_picture(self, stage: Stage, panels: Panels, frame: Frame, sample: Sample) -> bool:
        """Draw both robots; whether the second one has come or gone."""
        with self._client.atomic():  # or a picture could be sent in two halves
            self._draw_scene(stage, panels, frame.truth, sample)
            return self._comparison.draw(frame, sample, panels.settings)

    def _draw_scene(self, stage: Stage, panels: Panels, truth: Truth, sample: Sample) -> None:
        settings = panels.settings
        if settings.changed:
            settings.changed = False
            stage.body.see_through(settings.see_through, settings.theme)
            self._comparison.see_through(settings)
        floor = (truth.floor, settings.theme)
        if floor != self._floor:
            self._floor = floor
            add_floor(self._client, *floor)
        place = self._comparison.middle(sample["com"][:2])
        stage.camera.follow(place, LOOSE if truth.fall is None and not self._comparison.other_fell else TIGHT)
        alone = self._comparison.spread is None
        labelled = settings.labelled if alone else settings.labelled & FEW_LABELS
        stage.draw(truth, sample, settings, labelled)

    def _reach_other(self, panels: Panels, stage: Stage) -> None:
        """Let the robot beside the first be grabbed, too; what pushes one pushes both."""
        other, spread = self._comparison.other_body, self._comparison.spread
        if other is not None and spread is not None:
            panels.hand.reach(Reach(other, stage.loaded, stage.size, np.append(spread, 0.0)))

    def _draw_panels(self, panels: Panels, frame: Frame, loaded: LoadedRobot, sample: Sample) -> None:
        truth = frame.truth
        panels.control.follow(truth)
        panels.learn.follow(truth, sample.number("time"), frame.lesson)
        panels.share.follow(truth, frame.left)
        panels.ground.follow(truth)
        panels.mismatch.follow(truth)
        panels.control.see(sample)
        panels.hand.follow(truth)
        panels.control.bounds.see(sample, loaded.model, truth)
        if truth.fall is None:
            panels.push.see(sample)
        panels.push.refresh()
        if truth.push is not None:
            panels.plots.along(truth.push.along)
        panels.plots.add(rows_of(frame.history, loaded.layout.width))
        self._comparison.after(frame, sample, panels.runs, panels.plots)
        panels.legend.show(panels.settings.shown, self._comparison.paths)
        tried = self._comparison.tried(frame.foreseeing)
        panels.status.follow(truth, told(frame, sample, loaded), sample.number("time"), tried)
        panels.plots.look_at(sample.number("time") if truth.behind else math.inf)
        if not truth.playing:
            panels.plots.draw()  # nothing comes later that could show the last samples
        for notice in frame.notices:
            self.tell(notice)

    def _look(self, name: str) -> None:
        """Turn the camera to the robot where it is now, and to what comes on stage later."""
        stage = self._stage
        self._view = name if name in VIEWS else self._view
        if stage is not None and name in VIEWS:
            place, spread = stage.body.place_on_ground, self._comparison.spread
            stage.camera.look(name, place if spread is None else self._comparison.middle(place), spread)
