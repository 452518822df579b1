"""The measurement of the app: it runs, ends, and tells believable figures."""

from __future__ import annotations

from momentum_lab.app.bare_client import Received, measure_app


def test_the_app_is_measured_from_outside():
    measured = measure_app(3.0)
    assert 2.9 < measured.seconds < 4.0
    assert 0.2 < measured.real_time_factor < 1.1
    assert 5.0 < measured.drawings_per_second < 45.0
    assert 5.0 < measured.messages_per_drawing < 100.0
    assert 0.0 < measured.first_picture < 30.0


def test_a_picture_that_comes_in_two_windows_counts_once():
    def turn(name):
        return {"type": "SetOrientationMessage", "name": name}

    received = Received()
    for _ in range(7):
        received.take([turn("/robot/1"), turn("/robot/1/2")])
        received.take([turn("/robot/1/2/3")])
    assert received.drawings == 7
    assert received.changes == 21


def test_simulated_time_is_read_from_the_page():
    received = Received()
    content = '<div class="lab n dim">simulated time <b>12.34 s</b> · 1.00 × real time</div>'
    received.take([{"type": "GuiUpdateMessage", "uuid": "x", "updates": {"content": content}}])
    assert received.told[1] == 12.34
