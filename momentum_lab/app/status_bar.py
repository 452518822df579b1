"""Below the picture, or above the tabs: how the robot is doing, how time runs, and the buttons that run it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import viser

from momentum_lab.app import html
from momentum_lab.app.push_strip import PushStrip
from momentum_lab.app.series import KEPT
from momentum_lab.app.speed_mark import speed_cell
from momentum_lab.app.time_bar import cell
from momentum_lab.app.widgets import Bound, Post
from momentum_lab.app.wire import Truth
from momentum_lab.events import Branch, LookBack, Pause, Play, Reset, SetSpeed, StepOnce
from momentum_lab.palette import BLUE
from momentum_lab.plain import plain
from momentum_lab.status import Status

INVITATION = "Push the robot: press P or the button."
SMALL_STEP, LARGE_STEP = 1, 20
_SMALL, _LARGE, _STAND_UP = "+1 ms", "+20 ms", "Stand up"
_SPEEDS = {"1/8": 0.125, "1/4": 0.25, "1/2": 0.5, "1": 1.0}
_DIRECTIONS = {0: "forward", 90: "to the left", 180: "backward", 270: "to the right"}
# A status that says more than "standing" stays readable for this long, s.
_READABLE = 0.9
_PASSING = frozenset({"border", "lifted", "solver"})
# The slider reaches back to the next multiple of this behind the start of the run, s.
_REACH = 5.0
# How often the figures change, s.
_PERIOD = 0.1
_LOOK_BACK = "look back (s)"
_GO_ON = (
    "With the gains and the controller of now. What was done later is forgotten; "
    "pushes of the scenario or of an opened run come again."
)
# So many pushes are named, the others counted.
_NAMED = 3


class StatusBar:
    """Status, time and playback of one browser tab.

    Args:
        gui: where the widgets go.
        post: where events go.
        clock: seconds, for tests.
    """

    def __init__(self, gui: viser.GuiApi, post: Post, clock: Callable[[], float] = time.monotonic) -> None:
        self._post, self._clock = post, clock
        self._playing = True
        self._invitation = INVITATION
        self._shown: Status | None = None
        self._since = self._simulated = -math.inf
        self._next = -math.inf
        self._texts: dict[str, str] = {}
        gui.add_html(html.TITLE)
        gui.add_html(cell("status"))
        self._status = gui.add_html(html.status_line("standing", "standing", "green"))
        gui.add_html(cell("time"))
        self._time = gui.add_html("")
        gui.add_html(cell("words"))
        self._sentence = gui.add_html(html.sentence(INVITATION))
        self._stand_up = gui.add_button(
            "Stand up again  (R)", color=BLUE, icon=viser.Icon.ARROW_UP, visible=False
        )
        gui.add_html(cell("buttons"))
        self._buttons = gui.add_button_group("time", _buttons(playing=True))
        self._speed = gui.add_html(speed_cell(_SPEEDS.values(), 1.0))
        speeds = gui.add_button_group("speed", tuple(_SPEEDS))
        gui.add_html(cell("strip"))
        self._strip = PushStrip(gui, _LOOK_BACK, clock)
        gui.add_html(cell("look"))
        self._look_back: Bound[float] = Bound(
            gui.add_slider(
                _LOOK_BACK,
                -_REACH,
                0.0,
                0.01,
                0.0,
                hint="Stops time and shows what was; a line in the plots is where you are. "
                "Play goes on from the end, B from there.",
            ),
            lambda seconds: LookBack(max(0.0, -seconds)),
            post,
            clock,
        )
        self._branch = gui.add_button(
            branch_words(()), color=BLUE, icon=viser.Icon.GIT_BRANCH, visible=False, hint=_GO_ON
        )
        self._stand_up.on_click(lambda _: post(Reset()))
        self._buttons.on_click(lambda event: self._pressed(event.target.value))
        self._branch.on_click(lambda _: post(Branch()))
        speeds.on_click(lambda event: post(SetSpeed(_SPEEDS.get(event.target.value, 1.0))))

    def toggle(self) -> None:
        """Play what is paused, pause what plays."""
        self._post(Pause() if self._playing else Play())

    def follow(self, truth: Truth, status: Status, simulated: float, tried: str = "") -> None:
        """Show how the robot is doing.

        Args:
            truth: what is the case.
            status: the most important thing to say about the latest sample.
            simulated: its time, s.
            tried: what there is to say about a push that is only tried.
        """
        if truth.playing != self._playing:
            self._playing = truth.playing
            self._buttons.options = _buttons(truth.playing)
            self._next = -math.inf
        end = simulated + truth.behind
        reach = min(KEPT, _REACH * max(1, math.ceil(end / _REACH)))
        if self._look_back.handle.min != -reach:
            self._look_back.handle.min = -reach
        self._look_back.follow(-truth.behind)
        self._branch.visible = truth.behind > 0.0
        self._warn(truth.forgotten)
        self._write("speed", self._speed, speed_cell(_SPEEDS.values(), truth.speed))
        self._strip.follow([end - start for start in truth.pushed], reach, truth.playing)
        now = self._clock()
        if now < self._next and truth.playing:
            return
        self._next = now + _PERIOD
        if simulated < self._simulated:
            self._shown = None  # the robot has been stood up
        self._simulated = simulated
        status = self._readable(status, now, truth.playing)
        self._write("status", self._status, html.status_line(status.kind, status.words, status.color))
        line = html.time_line(
            simulated, truth.real_time_factor, truth.speed, truth.playing, truth.failures, truth.behind
        )
        self._write("time", self._time, line)
        down = truth.fall is not None or truth.stopped is not None
        self._write("sentence", self._sentence, html.sentence(tried or _sentence(truth) or self._invitation))
        self._sentence.visible = not down and truth.behind == 0.0
        self._stand_up.visible = down and truth.behind == 0.0

    def invite(self, on: bool) -> None:
        """Whether a robot that nobody has pushed is to be pushed."""
        self._invitation = INVITATION if on else ""

    def end(self) -> None:
        """Say that the session's process has gone."""
        self._status.content = html.status_line(
            "stopped", "the simulation has ended: reload the page", "black"
        )

    def _warn(self, forgotten: tuple[float, ...]) -> None:
        """Say beforehand what going on from here forgets."""
        words = branch_words(forgotten)
        if self._branch.label != words:
            self._branch.label = words
            self._branch.hint = f"{_GO_ON}{forgotten_words(forgotten)}"

    def _readable(self, status: Status, now: float, playing: bool) -> Status:
        """The status, or one that has not been readable long enough yet."""
        shown = self._shown
        held = shown is not None and shown.kind in _PASSING and now - self._since < _READABLE
        if shown is not None and held and playing and status.kind == "standing":
            return shown
        self._shown, self._since = status, now
        return status

    def _pressed(self, name: str) -> None:
        if name in {"Play", "Pause"}:
            self._post(Play() if name == "Play" else Pause())
        elif name == _STAND_UP:
            self._post(Reset())
        else:
            self._post(StepOnce(SMALL_STEP if name == _SMALL else LARGE_STEP))

    def _write(self, name: str, handle: viser.GuiHtmlHandle, content: str) -> None:
        if self._texts.get(name) != content:
            self._texts[name] = handle.content = content


def _buttons(playing: bool) -> tuple[str, ...]:
    return ("Pause" if playing else "Play", _SMALL, _LARGE, _STAND_UP)


def branch_words(forgotten: tuple[float, ...]) -> str:
    """What the button to go on says, given the pushes of a hand that are not repeated, s of the run."""
    if not forgotten:
        return "Go on from here  (B)"
    pushes = "push" if len(forgotten) == 1 else "pushes"
    return f"Go on without {len(forgotten)} later {pushes}  (B)"


def forgotten_words(forgotten: tuple[float, ...]) -> str:
    """When those pushes were, in a sentence."""
    if not forgotten:
        return ""
    times = ", ".join(f"{start:.2f} s" for start in forgotten[:_NAMED])
    more = f" and {len(forgotten) - _NAMED} more" if len(forgotten) > _NAMED else ""
    return f" Forgotten: pushed at {times}{more}."


_BITS = {True: ", with the same bits", False: ", with other bits", None: ""}


def _sentence(truth: Truth) -> str:
    """What was done; nothing before the first push."""
    if truth.opened is not None and truth.opened.over:
        return f"The opened run ends here{_BITS[truth.opened.agrees]}. Play goes on."
    push = truth.push
    if push is None:
        return ""
    towards = _DIRECTIONS.get(
        round(push.direction_deg) % 360, f"{plain(push.direction_deg, '.0f')}° from forward"
    )
    where = "" if push.body is None else f" on the {push.body.replace('_', ' ')}"
    return (
        f"Last push: {push.force or 0.0:.0f} N for {1e3 * push.duration:.0f} ms {towards}{push.tilt}{where}."
    )
