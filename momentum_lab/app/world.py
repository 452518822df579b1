"""Ground and light of a browser tab."""

from __future__ import annotations

from momentum_lab.app.marks import Theme
from momentum_lab.app.profile import RenderProfile
from momentum_lab.app.viewer import Viewer
from momentum_lab.palette import Color

# Of the floor, its lines every 10 cm, its lines every metre.
FLOORS: dict[Theme, tuple[Color, Color, Color]] = {
    "light": ((246, 246, 244), (222, 222, 222), (176, 176, 176)),
    "dark": ((56, 60, 66), (82, 87, 94), (132, 138, 146)),
}


def add_world(client: Viewer, profile: RenderProfile) -> None:
    """Put floor and light into a browser tab's scene."""
    client.scene.configure_default_lights(enabled=True, cast_shadow=profile.shadows)
    if not profile.environment:
        client.scene.configure_environment_map(None)
    add_floor(client, 0.0, "light")


def add_floor(client: Viewer, height: float, theme: Theme, root: str = "") -> None:
    """Put the floor of a light or a dark page at a height, m, below a node; without one below the world's."""
    plane, cell, section = FLOORS[theme]
    client.scene.add_grid(
        f"{root}/ground",
        position=(0.0, 0.0, height),
        infinite_grid=True,
        fade_distance=14.0,
        fade_strength=1.5,
        cell_size=0.1,
        cell_color=cell,
        cell_thickness=0.6,
        section_size=1.0,
        section_color=section,
        section_thickness=1.0,
        plane_color=plane,
        plane_opacity=1.0,
        shadow_opacity=0.22,
    )
