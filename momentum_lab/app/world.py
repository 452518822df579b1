"""Ground and light of a browser tab."""

from __future__ import annotations

from momentum_lab.app.profile import RenderProfile
from momentum_lab.app.viewer import Viewer


def add_world(client: Viewer, profile: RenderProfile) -> None:
    """Put floor and light into a browser tab's scene."""
    client.scene.configure_default_lights(enabled=True, cast_shadow=profile.shadows)
    if not profile.environment:
        client.scene.configure_environment_map(None)
    add_floor(client, 0.0)


def add_floor(client: Viewer, height: float, root: str = "") -> None:
    """Put the floor at a height, m, below a node; without one below the world's."""
    client.scene.add_grid(
        f"{root}/ground",
        position=(0.0, 0.0, height),
        infinite_grid=True,
        fade_distance=14.0,
        fade_strength=1.5,
        cell_size=0.1,
        cell_color=(222, 222, 222),
        cell_thickness=0.6,
        section_size=1.0,
        section_color=(176, 176, 176),
        section_thickness=1.0,
        plane_color=(246, 246, 244),
        plane_opacity=1.0,
        shadow_opacity=0.22,
    )
