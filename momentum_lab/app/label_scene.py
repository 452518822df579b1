"""Labels in the scene: names and numbers beside marks; marks near each other share one label."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import viser

from momentum_lab.app.marks import STYLES, Anchor
from momentum_lab.app.overlays import Mark, Point
from momentum_lab.app.viewer import Viewer

# Points nearer to each other than this, in CoM heights, are at the same place for a reader.
_TOGETHER = 0.03
# Less than this does not show, m.
_SAME_PLACE = 3e-4
# The points on the ground, the one whose label may not move first.
_POINTS = ("cop", "cmp", "com_ground", "cop_desired", "cop_granted", "capture")
# What is told about the other marks; those that are not here have no label.
_OTHERS = {"com": "{label}", "grf": "{label} {text}", "push": "{label} {text}", "gap": "{text}"} | {
    "safe_border": "{text}"
}


@dataclass(frozen=True, slots=True)
class Label:
    """Some words in the scene.

    Attributes:
        key: the mark they belong to.
        text: the words.
        at: where, m.
        anchor: which corner of the words is there.
    """

    key: str
    text: str
    at: Point
    anchor: Anchor


def arrange(marks: list[Mark], size: float) -> list[Label]:
    """Labels for some marks.

    Points on the ground that are near each other share one label, "CoP · CMP": two would cover each other. It is no
    claim that they are the same: a small gap is a lever, too, and the bar between them says how much it turns.

    Args:
        marks: what is drawn.
        size: height of the robot's CoM, m.
    """
    present = {mark.key: mark for mark in marks}
    labels = []
    for group in _groups([present[key] for key in _POINTS if key in present], _TOGETHER * size):
        style = STYLES[group[0].key]
        text = " · ".join(STYLES[mark.key].label for mark in group)
        labels.append(Label(style.key, text, group[0].points[0], style.anchor))
    for key, words in _OTHERS.items():
        if key in present and (mark := present[key]):
            text = words.format(label=STYLES[key].label, text=mark.text).strip()
            labels.append(Label(key, text, mark.at or mark.points[0], STYLES[key].anchor))
    return [label for label in labels if label.text]


def _groups(points: list[Mark], distance: float) -> list[list[Mark]]:
    """Marks of single points, those near the first of a group put together."""
    groups: list[list[Mark]] = []
    for mark in points:
        here = np.array(mark.points[0])
        near = next((g for g in groups if np.linalg.norm(here - g[0].points[0]) < distance), None)
        if near is None:
            groups.append([mark])
        else:
            near.append(mark)
    return groups


class LabelScene:
    """The labels of one browser tab.

    Args:
        client: the browser tab.
        root: name of the node that everything hangs below; empty: the world.
    """

    def __init__(self, client: Viewer, root: str = "") -> None:
        self._client, self._root = client, root
        self._handles: dict[str, viser.LabelHandle] = {}
        self._at: dict[str, np.ndarray] = {}

    def draw(self, labels: list[Label]) -> None:
        """Show exactly these labels."""
        shown = {label.key for label in labels}
        for key, handle in self._handles.items():
            handle.visible = key in shown
        for label in labels:
            self._draw_one(label)

    def remove(self) -> None:
        """Take all labels out of the scene."""
        for handle in self._handles.values():
            handle.remove()

    def _draw_one(self, label: Label) -> None:
        at = np.array(label.at)
        handle = self._handles.get(label.key)
        if handle is None:
            self._handles[label.key] = self._client.scene.add_label(
                f"{self._root}/labels/{label.key}",
                label.text,
                position=label.at,
                anchor=label.anchor,
                font_screen_scale=0.9,
            )
            self._at[label.key] = at
            return
        handle.text = label.text
        if np.abs(self._at[label.key] - at).max() > _SAME_PLACE:
            self._at[label.key] = at
            handle.position = label.at
