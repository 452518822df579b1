"""Dark or light: the key turns the page to the other, whatever the browser prefers, and the browser remembers."""

from __future__ import annotations

from types import SimpleNamespace

from momentum_lab.app.appearance import Appearance
from momentum_lab.app.view_panel import ViewSettings


def test_the_key_turns_the_page_to_the_other_and_back():
    remembered: list[tuple[str, str]] = []
    dressed: list[bool] = []
    client = SimpleNamespace(
        local_storage=SimpleNamespace(set_item=lambda key, value: remembered.append((key, value))),
        gui=SimpleNamespace(configure_theme=lambda **theme: dressed.append(theme["dark_mode"])),
    )
    settings = ViewSettings()
    colours = Appearance(client, settings, lambda: None)
    colours.toggle()
    assert settings.theme == "dark"
    colours.toggle()
    assert settings.theme == "light"
    assert dressed == [True, False]
    assert remembered == [("colours", "dark"), ("colours", "light")]
