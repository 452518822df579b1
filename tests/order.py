"""Which files of tests begin first, and which stay together, so that two processes end at the same time."""

from __future__ import annotations

import pytest
from xdist.scheduler import LoadFileScheduling

BROWSER = "tests/browser"
# Those that keep a core busy for ten seconds and more, the longest first; the short ones fill the end.
LONGEST = (
    "tests/experiments/test_push_limit.py",
    "tests/test_terrain.py",
    "tests/control/test_whole_body_qp.py",
    "tests/app/test_server.py",
    "tests/control/test_switching.py",
    "tests/control/test_slack_qp.py",
    "tests/app/test_measured_server.py",
    "tests/test_lessons.py",
    "tests/test_gates.py",
    "tests/control/test_resolved_momentum.py",
    "tests/control/test_motion.py",
    "tests/experiments/test_figures.py",
)


def file_of(item: pytest.Item) -> str:
    return item.nodeid.split("::")[0]


def begin_first(items: list[pytest.Item]) -> None:
    """Files that want the machine to themselves, then the browser, then the longest, then the rest."""
    quiet = {file_of(item) for item in items if item.get_closest_marker("quiet")}

    def rank(item: pytest.Item) -> int:
        name = file_of(item)
        if name in quiet:
            return -2
        if name.startswith(BROWSER):
            return -1
        return LONGEST.index(name) if name in LONGEST else len(LONGEST)

    items.sort(key=rank)


class ByFile(LoadFileScheduling):
    """Each file in one process, and all that a browser draws in one: two browsers are too much for two cores."""

    def _split_scope(self, nodeid: str) -> str:
        return BROWSER if nodeid.startswith(BROWSER) else str(super()._split_scope(nodeid))
