"""Which tests begin first, which stay together, so that two processes end at the same time; which are tried again."""

from __future__ import annotations

import pytest
from xdist.scheduler import LoadFileScheduling

BROWSER = "tests/browser"
# Processes, threads and pages in real time: on two busy cores one of them is late now and then.
REAL_TIME = (BROWSER, "tests/app")
# They look at the same runs of the figures, which a process plays once (tests/experiments/played.py).
FIGURES = tuple(
    f"tests/experiments/test_{name}.py"
    for name in (
        "figures",
        "arm_swing",
        "felt_push",
        *(f"fig{number}" for number in (1, 4, 5, 7, 8, 9)),
        "flight",
        "kick",
        "table1",
    )
)
# Those that keep a core busy for ten seconds and more, the longest first; the short ones fill the end.
LONGEST = (
    *FIGURES,
    "tests/experiments/test_push_limit.py",
    "tests/test_terrain.py",
    "tests/control/test_whole_body_qp.py",
    "tests/app/test_server.py",
    "tests/test_lessons.py",
    "tests/control/test_motion.py",
    "tests/control/test_slack_qp.py",
    "tests/control/test_switching.py",
    "tests/control/test_resolved_momentum.py",
    "tests/app/test_measured_server.py",
    "tests/experiments/test_push_reach.py",
    "tests/test_gates.py",
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


def try_again(items: list[pytest.Item]) -> None:
    """What happens in real time has a second try, which the summary tells; what fails twice has failed."""
    for item in items:
        if file_of(item).startswith(REAL_TIME):
            item.add_marker(pytest.mark.flaky(reruns=1))


def scope_of(nodeid: str) -> str:
    """What stays in one process: a file; the figures; the browser, for two are too much for two cores."""
    name = nodeid.split("::")[0]
    if name.startswith(BROWSER):
        return BROWSER
    return FIGURES[0] if name in FIGURES else name


class ByFile(LoadFileScheduling):
    """Each scope in one process."""

    def _split_scope(self, nodeid: str) -> str:
        return scope_of(nodeid)
