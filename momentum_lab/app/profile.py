"""How much work a picture may be: for people, or for a test on a machine without a graphics card."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RenderProfile:
    """What the browser has to draw besides the robot and its marks.

    Attributes:
        name: the name on the command line.
        shadows: whether the light casts shadows.
        environment: whether an environment map lights the scene.
        cell: details of a robot smaller than this are drawn together, m; 0: none are.
    """

    name: str
    shadows: bool
    environment: bool
    cell: float = 0.0


NORMAL = RenderProfile("normal", shadows=True, environment=True)
TEST = RenderProfile("test", shadows=False, environment=False)
COARSE = RenderProfile("coarse", shadows=False, environment=False, cell=0.04)
PROFILES = {profile.name: profile for profile in (NORMAL, TEST, COARSE)}
