"""What a whole page is made of, over a real socket: units, keys, names, colours, and a lab that plays by itself."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest

from momentum_lab.app import access_html, keyboard_html, look_html
from momentum_lab.app.bare_client import BareClient, Received
from momentum_lab.app.demo_stage import COMMAND, LISTENER
from momentum_lab.app.help_page import keys_in_help
from momentum_lab.app.profile import TEST
from momentum_lab.app.server import LabServer
from momentum_lab.scenario import Scenario

pytestmark = pytest.mark.filterwarnings("ignore:Queued a:UserWarning")

PATIENCE = 60.0
WAIT = 5.0
UNITS = (
    "N",
    "m",
    "cm",
    "mm",
    "s",
    "ms",
    "°",
    "rad",
    "kg",
    "N m",
    "N s",
    "1/s",
    "1/s²",
    "N m/rad",
    "N m s/rad",
)
NO_UNIT = "(no unit)"
NUMBERS = ("GuiSliderMessage", "GuiNumberMessage", "GuiVector2Message", "GuiVector3Message")


class Kept(Received):
    """Everything a client has received."""

    def __init__(self) -> None:
        super().__init__()
        self.everything: list[dict[str, Any]] = []

    def take(self, messages: list[dict[str, Any]], now: float | None = None) -> None:
        self.everything += messages
        super().take(messages, now)

    def props(self, *kinds: str) -> list[dict[str, Any]]:
        return [message["props"] for message in self.everything if message["type"] in kinds]

    def captions(self) -> list[str]:
        updates = [m["updates"].get("content") for m in self.everything if m["type"] == "GuiUpdateMessage"]
        return [content for content in updates if content and "data-demo" in content]


@pytest.fixture(scope="module")
def lab() -> Iterator[LabServer]:
    with LabServer(Scenario("stand", robot="g1"), profile=TEST, demo=WAIT) as lab:
        yield lab


@pytest.fixture(scope="module")
def client(lab: LabServer) -> Iterator[BareClient]:
    with BareClient(lab.url) as client:
        client.received = Kept()
        client.read_until(lambda received: COMMAND in received.labels, PATIENCE)
        yield client


def kept(client: BareClient) -> Kept:
    assert isinstance(client.received, Kept)
    return client.received


def has_unit(label: str) -> bool:
    inside = label.rpartition("(")[2].rstrip(")") if label.endswith(")") else ""
    return bool(inside) and all(part.strip() in UNITS for part in inside.split(","))


def folders(client: BareClient, label: str) -> list[str]:
    """Where the folders of a name have been put, one after the other."""
    found = [m for m in kept(client).everything if m["type"] == "GuiFolderMessage"]
    return [message["container_uuid"] for message in found if message["props"]["label"] == label]


def test_gains_of_another_controller_stay_where_the_first_ones_were(lab):
    with BareClient(lab.url) as client:
        client.received = Kept()
        client.read_until(lambda _: folders(client, "Keep these gains"), PATIENCE)
        client.set_value("controller", "whole-body-qp")
        client.read_until(lambda _: len(folders(client, "Keep these gains")) == 2, PATIENCE)
        places = {folders(client, name)[-1] for name in ("Gains", "Keep these gains")}
        assert places == {folders(client, "Gains")[0]}
        assert places != {folders(client, "Ground")[0]}  # that of another tab


def test_every_number_has_a_unit_or_says_that_it_has_none(client):
    numbers = kept(client).props(*NUMBERS)
    assert len(numbers) > 25
    silent = [n["label"] for n in numbers if not has_unit(n["label"]) and NO_UNIT not in (n["hint"] or "")]
    assert silent == []


def test_help_explains_every_key_of_the_palette(client):
    commands = [props for props in kept(client).props("RegisterCommandMessage") if props["hotkey"]]
    pressed = [(props["hotkey"], props["modifier"]) for props in commands]
    assert len(set(pressed)) == len(pressed)
    hotkeys = {props["hotkey"].replace("escape", "Esc") for props in commands}
    assert hotkeys == keys_in_help()
    assert not hotkeys & {"Space", " ", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"}


def test_a_page_names_its_widgets_and_listens_for_a_person(client):
    page = "".join(props["content"] for props in kept(client).props("GuiHtmlMessage"))
    once = (access_html.NAMES, look_html.STYLE, keyboard_html.KEYS, LISTENER)
    assert [page.count(piece) for piece in once] == [1, 1, 1, 1]


def test_dark_page_has_a_dark_floor_and_light_comes_back(client):
    def themes() -> list[bool]:
        return [m["dark_mode"] for m in kept(client).everything if m["type"] == "ThemeConfigurationMessage"]

    def floor() -> int:
        return max(kept(client).props("GridMessage")[-1]["plane_color"])

    assert (themes()[-1], floor() > 200) == (False, True)
    client.set_value("colours of the browser", "dark")
    client.read_until(lambda _: themes()[-1] and floor() < 100, PATIENCE)
    client.set_value("colours", "light")
    client.read_until(lambda _: not themes()[-1] and floor() > 200, PATIENCE)
    client.send({"type": "CommandTriggerMessage", "uuid": command(client, "Dark or light page")})
    client.read_until(lambda _: themes()[-1] and floor() < 100, PATIENCE)
    assert client.received.latest["LocalStorageSetItemMessage"]["value"] == "dark"
    client.set_value("colours", "light")
    client.read_until(lambda _: not themes()[-1] and floor() > 200, PATIENCE)
    client.set_value("colours of the browser", "light")
    client.set_value("colours", "no colour at all")


def test_nobody_is_there_so_it_plays_until_somebody_is(client, lab):
    visitor = lab.visitors[0]
    own = visitor.latest.truth
    # In the panel at the right and in that at the left: either may be folded away.
    client.read_until(lambda _: len(kept(client).captions()) >= 2, WAIT + PATIENCE)
    client.read_until(lambda _: visitor.latest.demo, PATIENCE)
    assert visitor.latest.truth.run != own.run
    client.send({"type": "CommandTriggerMessage", "uuid": command(client, COMMAND)})
    client.read_until(lambda _: not visitor.latest.demo, PATIENCE)
    assert visitor.latest.truth.run == own.run


def test_it_can_be_switched_off(client):
    client.set_value("demonstration", False)
    client.read(0.5)
    before, end = len(kept(client).captions()), time.monotonic() + WAIT + 1.5
    client.read(end - time.monotonic())
    assert len(kept(client).captions()) == before


def command(client: BareClient, label: str) -> str:
    return kept(client).labels[label]
