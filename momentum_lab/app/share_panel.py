"""The share tab: the run as a code, an address or a file, and the way back from each of them."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import viser

from momentum_lab.app import html, share_html
from momentum_lab.app.exporter import made_elsewhere
from momentum_lab.app.film_words import before_film, during_film
from momentum_lab.app.kept_before import KeptBefore
from momentum_lab.app.reel import Reel
from momentum_lab.app.wire import Opened, RunTaken, Truth
from momentum_lab.errors import LabError
from momentum_lab.experiments.run_table import thinned_words
from momentum_lab.run_file import Run, decoded, encoded
from momentum_lab.share_code import from_code, link, to_code

_INTRODUCTION = (
    "A run is its scenario and all that was done in it. Whoever opens it sees the same run, to the last bit."
)
# What can be downloaded: kind and how its file name ends.
_FILES = {
    "report (.html)": ("report", "-report.html"),
    "run file (.json)": ("run", ".json"),
    "trace, every tick (.npz)": ("trace", ".npz"),
    "table (.csv)": ("table", ".csv"),
    "picture of the view (.png)": ("view", "-view.png"),
    "picture of the plots (.png)": ("plots", "-plots.png"),
    "recording to play (.html)": ("recording", "-recording.html"),
    "recording (.viser)": ("viser", ".viser"),
    "film (.mp4)": ("film", ".mp4"),
    "small film (.mp4)": ("small film", ".mp4"),
}
_HINT = (
    "Report, trace and table hold the last minute since the robot stood up; plots, recordings and films the part of "
    "it around the pushes. All hold both robots."
)
_WITHOUT_SAMPLES = ("run", "view")
_IN_SIGHT = "This tab draws it: keep it in sight; its own picture stands still."
# Height of a film, pixels.
_FILMS = {"film": 720, "small film": 360}


@dataclass(frozen=True, slots=True)
class Sharing:
    """What the share tab can ask for.

    Attributes:
        take_run: the run as it is now, without samples.
        take_recording: the run as it is now, with the samples of both robots.
        open: starts a run.
        tell: shows a person what was wrong.
        send: lets the browser save a file of a name.
        view: a picture of what the browser shows, as a PNG file.
        reel: the pictures of a run.
        film: pictures as an .mp4 file so many pixels high; it tells the fraction that is done, and ends when that
            raises an error.
        url: where the lab is served.
        take_back: puts the run before the opened one on stage again.
        say: tells a person what has happened.
        warn: tells a person what is wrong, until it is closed: a page that loads may take longer than a notice.
    """

    take_run: Callable[[], RunTaken]
    take_recording: Callable[[], RunTaken]
    open: Callable[[Run], None]
    tell: Callable[[str], None]
    send: Callable[[str, bytes], None]
    view: Callable[[], bytes]
    reel: Callable[[RunTaken], Reel]
    film: Callable[[Reel, int, Callable[[float], None]], bytes]
    url: str
    take_back: Callable[[], None]
    say: Callable[[str], None]
    warn: Callable[[str], None]


class SharePanel:
    """The widgets of the share tab.

    Args:
        gui: where they go.
        sharing: what they ask for.
        address: the hidden text that holds the page's address when it carries a code.
        clock: seconds, for tests.
    """

    def __init__(
        self, gui: viser.GuiApi, sharing: Sharing, address: Any, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._sharing, self._clock = sharing, clock
        self._busy = threading.Lock()
        self._pace: dict[int, float] = {}  # how long a picture of a film so high took, s
        self._told = ""
        gui.add_html(html.sentence(_INTRODUCTION))
        make = gui.add_button("Make a code", icon=viser.Icon.QRCODE, hint="Of the run as it is now.")
        self._code = gui.add_html("")
        self._pasted: Any = gui.add_text("code", "", hint="A code, or an address that ends in one.")
        open_code = gui.add_button("Open the code", color="gray", icon=viser.Icon.FOLDER_OPEN)
        upload = gui.add_upload_button(
            "Open a run file",
            color="gray",
            icon=viser.Icon.UPLOAD,
            mime_type=".json,.toml,.npz",
            hint="A run file (.json, .toml) or a trace (.npz).",
        )
        self._opened = gui.add_html("")
        self._kept = KeptBefore(gui, sharing.take_back, sharing.say, self._forget_codes)
        self._what = gui.add_dropdown(
            "file",
            tuple(_FILES),
            hint=_HINT,
        )
        self._download = gui.add_button("Download", color="gray", icon=viser.Icon.DOWNLOAD)
        self._progress = gui.add_html("", visible=False)
        self._stop = gui.add_button("Stop the film", color="gray", icon=viser.Icon.PLAYER_STOP, visible=False)
        self._stopped = threading.Event()
        self._stop.on_click(lambda _: self._stopped.set())
        make.on_click(lambda _: self._attempt(self._make_code))
        open_code.on_click(lambda _: self._attempt(lambda: self._open_code(self._pasted.value)))
        upload.on_upload(lambda event: self._attempt(lambda: self._open_file(event.target.value)))
        self._download.on_click(lambda _: self._attempt(self._save))
        address.on_update(lambda event: self._arrived(event))

    def follow(self, truth: Truth, left: tuple[str, ...] = ()) -> None:
        """Show how far a run is that has been opened, and what can be taken back."""
        self._kept.follow(truth, left)
        text = "" if truth.opened is None else html.sentence(opened_words(truth.opened))
        if text != self._told:
            self._told = self._opened.content = text

    def _attempt(self, act: Callable[[], None], tell: Callable[[str], None] | None = None) -> None:
        """Do something once at a time; what is wrong with it is told, and the session goes on."""
        if not self._busy.acquire(blocking=False):
            self._sharing.tell("One thing at a time: the last file is still being made.")
            return
        try:
            act()
        except LabError as error:
            (tell or self._sharing.tell)(str(error))
        finally:
            self._busy.release()

    def _make_code(self) -> None:
        code = to_code(self._sharing.take_run().run)
        self._code.content = share_html.code(code, link(self._sharing.url, code))

    def _open_code(self, text: str) -> None:
        self._open(from_code(text))

    def _open_file(self, file: Any) -> None:
        self._open(decoded(file.name, file.content))

    def _open(self, run: Run) -> None:
        self._sharing.open(run)
        self._forget_codes()

    def _forget_codes(self) -> None:
        """Another run is on stage: codes of the one before would be taken for its own."""
        self._code.content = ""
        self._pasted.value = ""

    def _arrived(self, event: Any) -> None:
        if event.client is not None and event.target.value:
            self._attempt(lambda: self._open_code(event.target.value), self._of_the_address)

    def _of_the_address(self, problem: str) -> None:
        self._sharing.warn(f"The address of this page opens no run. {problem}")

    def _save(self) -> None:
        kind, end = _FILES[self._what.value]
        self._download.disabled, note = True, ""
        try:
            self._show(f"{self._what.value}: being made, the run goes on.")
            take = self._sharing.take_run if kind in _WITHOUT_SAMPLES else self._sharing.take_recording
            taken = take()
            content = self._content(kind, taken)
            self._sharing.send(file_name(taken.run) + end, content)
            note = thinned_words(content, taken.run.scenario.timestep) if kind == "table" else ""
        finally:
            self._download.disabled = False
            self._show(note)

    def _content(self, kind: str, taken: RunTaken) -> bytes:
        if kind == "view":
            return self._sharing.view()
        if kind in _FILMS:
            return self._film(self._sharing.reel(taken), _FILMS[kind])
        return encoded(taken.run) if kind == "run" else made_elsewhere(kind, taken)

    def _film(self, reel: Reel, lines: int) -> bytes:
        self._stopped.clear()
        self._stop.visible = True
        self._show(f"{before_film(reel, self._pace.get(lines))} {_IN_SIGHT}")
        percents, begun = set[int](), self._clock()

        def report(fraction: float) -> None:
            if self._stopped.is_set():
                raise LabError("The film was stopped.")
            passed, percent = self._clock() - begun, int(100.0 * fraction)
            self._pace[lines] = passed / (fraction * len(reel.rows))
            if percent not in percents:
                percents.add(percent)
                self._show(f"{during_film(reel, fraction, passed)} {_IN_SIGHT}")

        try:
            return self._sharing.film(reel, lines, report)
        finally:
            self._stop.visible = False

    def _show(self, words: str) -> None:
        """One line about a file that is being made or was made last; none without words."""
        self._progress.content = html.sentence(words)
        self._progress.visible = bool(words)


def file_name(run: Run) -> str:
    """A name for files about a run: small letters, digits, hyphens."""
    words = f"{run.scenario.name}-{run.scenario.robot.removesuffix('.toml').rpartition('/')[2]}"
    return re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-")[:80] or "run"


def opened_words(opened: Opened) -> str:
    """How far an opened run is, in a sentence."""
    if not opened.over:
        return f"The opened run plays until {opened.seconds:.2f} s of its time."
    bits = {
        None: "Other things were done in it than in the original.",
        True: "Its last sample has the same bits as the original.",
        False: "Its last sample has other bits than the original: another version or machine made it.",
    }
    return f"The opened run ends here. {bits[opened.agrees]} Play goes on."
