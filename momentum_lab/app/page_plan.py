"""What a page has room for: panels at both sides, and a bar below the picture."""

from __future__ import annotations

from dataclasses import dataclass

import viser

LEFT = RIGHT = 350.0
"""Width of the panels at the sides, pixels."""
BAR_HEIGHT = 190.0
"""Of the bar below the picture and of what is free around it, pixels."""
# Pages narrower than this, width over height, have no room for plots beside the picture or for many labels.
_ROOMY = 1.1
LEAST_BAR = 460.0
"""A narrower picture has no bar: what stands side by side in it would not fit, pixels."""


@dataclass(frozen=True, slots=True)
class PagePlan:
    """What a page has room for, as it is opened.

    Attributes:
        roomy: whether panels stand at both sides of the picture.
        picture: width of the picture between them, pixels.
    """

    roomy: bool
    picture: float

    @classmethod
    def of(cls, client: viser.ClientHandle) -> PagePlan:
        """Of a browser tab that has no panels yet."""
        width, height = client.camera.image_width, client.camera.image_height
        return cls(width >= _ROOMY * height, width - LEFT - RIGHT)

    @property
    def bar(self) -> bool:
        """Whether status and time stand in a bar below the picture; if not, they stand above the tabs."""
        return self.picture >= LEAST_BAR

    @property
    def covered(self) -> float:
        """How much of the picture's lower part is covered, pixels."""
        return BAR_HEIGHT if self.bar else 0.0
