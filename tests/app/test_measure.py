"""The whole measurement in a short form: the real server, two clients, and believable figures."""

from __future__ import annotations

import time

import pytest

from momentum_lab.app.figures import AppMeasurement, figures
from momentum_lab.app.measure import Course, measure_app

pytestmark = pytest.mark.quiet

# Time for eight pushes. A machine that runs other things may be this much slower than the bounds of the report.
SECONDS = 12.0


@pytest.fixture(scope="module")
def measured() -> AppMeasurement:
    fractions: list[float] = []
    measured = measure_app(SECONDS, report=fractions.append)
    assert fractions == sorted(fractions)
    return measured


def test_every_line_is_told(measured, capsys):
    lines = [f"{f.name}: {f.value} ({f.bound or 'no bound'})" for f in figures(measured)]
    assert len(lines) == 14
    with capsys.disabled():  # bounds of a quiet machine are read here, not judged
        print("\n" + "\n".join(lines))


def test_time_runs_and_is_drawn(measured):
    assert SECONDS <= measured.seconds < SECONDS + 5.0
    assert 0.2 < measured.real_time_factor < 1.05
    assert 8.0 < measured.drawings_per_second < 45.0
    assert measured.messages_per_second > 5.0 * measured.drawings_per_second
    assert measured.late_ticks_per_minute >= 0.0


def loop_time() -> float:
    """Processor time of some plain Python: what this machine makes of a second of another one, s."""
    start, total = time.process_time(), 0
    for i in range(500_000):
        total += i * i % 7
    return time.process_time() - start


def test_drawing_is_cheap_for_this_machine(measured):
    # As a ratio, because machines differ by a factor of two: 5.6 loops a second when this was written, and some 10
    # before plots kept their polygons. The report's own bound, a quarter of a core, is read above, not judged.
    loop = sorted(loop_time() for _ in range(9))[4]
    assert 0.5 < measured.server_cpu / loop < 8.5


def test_a_push_is_seen_soon(measured):
    assert 0.0 < measured.push_delay <= measured.push_delay_longest < 1.0


def test_nothing_is_sent_while_nothing_changes(measured):
    assert measured.sent_while_paused == 0.0
    assert measured.drawn_while_standing == 0.0


def test_a_second_client_does_not_stop_the_first(measured):
    assert measured.aged == pytest.approx(6.0 * SECONDS)
    assert 0.0 < measured.stall < 1.5
    assert measured.stall < measured.first_picture_aged < 30.0


def test_a_short_run_says_nothing_about_memory(measured):
    assert measured.memory_growth is None


def test_memory_is_judged_after_the_first_minute():
    # 100 MB in the first minute, 2 MB a minute from then on.
    times = [1.5 * i for i in range(200)]
    sizes = [1e8 * min(1.0, t / 60.0) + 2e6 * max(0.0, t / 60.0 - 1.0) for t in times]
    assert Course([], times, sizes).growth == pytest.approx(2.0, rel=1e-6)
    assert Course([], times[:60], sizes[:60]).growth is None
