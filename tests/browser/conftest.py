"""The real server as a process, a real browser, and pages that fail a test when their console shows an error."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, sync_playwright

from tests.browser.lab_page import LOW, LabPage

OUTPUT = Path(__file__).parent / "output"
# Chromium without a graphics card draws WebGL in software; plots that it "accelerates" take all of its time.
FLAGS = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-accelerated-2d-canvas",
)
# Viser acknowledges a slider that a hand has just moved; a page that is replaced meanwhile has removed it.
CROSSED = "Tried to update non-existent component"
# Viser keeps a drag in the scene from selecting text, in a listener that Chromium has been told will not.
PASSIVE = "Unable to preventDefault inside passive event listener"
SERVE = """
import sys
from pathlib import Path
from momentum_lab.app.library import Library
from momentum_lab.app.profile import PROFILES
from momentum_lab.app.server import serve
from momentum_lab.scenario import load_scenario
if __name__ == "__main__":
    profile, scenario, *lessons = sys.argv[1:]
    library = Library(Path(lessons[0])) if lessons else None
    serve(load_scenario(scenario), port=0, open_browser=False, profile=PROFILES[profile], library=library)
"""


@dataclass(frozen=True, slots=True)
class Served:
    """The lab served by a process."""

    process: subprocess.Popen
    url: str


def serve(folder: Path, profile: str, scenario: str = "stand", *lessons: Path) -> Iterator[Served]:
    script = folder / "lab.py"
    script.write_text(SERVE)
    process = subprocess.Popen(
        [sys.executable, script, profile, scenario, *lessons], stdout=subprocess.PIPE, text=True
    )
    try:
        yield Served(process, process.stdout.readline().split()[2])
        process.terminate()
        process.wait(20.0)
        assert process.returncode == 0
    finally:
        process.kill()
        process.communicate()


@pytest.fixture(scope="session")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """The lab as tests can bear it: no shadows, no environment map, a robot of few triangles."""
    yield from serve(tmp_path_factory.mktemp("test"), "coarse")


@pytest.fixture
def served_in_detail(tmp_path: Path) -> Iterator[Served]:
    """The lab without shadows, but with all of its robot."""
    yield from serve(tmp_path, "test")


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """The system's Chromium, or the one that playwright has installed."""
    OUTPUT.mkdir(exist_ok=True)
    system = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=system, args=FLAGS)
        yield browser
        browser.close()


Opener = Callable[..., LabPage]


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Opener]:
    """Opens pages; at the end of the test none may have shown an error on its console."""
    errors: list[str] = []
    opened: list[Page] = []

    def note(message: ConsoleMessage) -> None:
        if message.type == "error" and not message.text.startswith((CROSSED, PASSIVE)):
            errors.append(message.text)

    def open_page(url: str, width: int = 1280, height: int = LOW, fingers: bool = False) -> LabPage:
        page = browser.new_page(viewport={"width": width, "height": height}, has_touch=fingers)
        opened.append(page)
        page.on("console", note)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(url)
        return LabPage(page)

    yield open_page
    for page in opened:
        page.close()
    assert errors == []
