"""What a tab without a browser makes of the messages it receives."""

from __future__ import annotations

from momentum_lab.app.bare_client import Received


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
    content = '<div class="lab n dim">simulated time \u2007<b>12.34 s</b> · 1.00 × real time</div>'
    received.take([{"type": "GuiUpdateMessage", "uuid": "x", "updates": {"content": content}}])
    assert received.told[1] == 12.34


def test_nodes_are_there_from_when_they_appear_until_they_are_hidden():
    def visible(on):
        return {"type": "SetSceneNodeVisibilityMessage", "name": "/marks/push", "visible": on}

    received = Received()
    received.take([{"type": "ArrowMessage", "name": "/marks/push", "props": {}}], 1.0)
    received.take([visible(True)], 2.0)
    assert received.shown == {"/marks/push": 1.0}
    received.take([visible(False)], 3.0)
    assert received.shown == {}
    received.take([visible(True)], 4.0)
    assert received.shown == {"/marks/push": 4.0}


def test_pictures_are_the_windows_in_which_something_turns():
    received = Received()
    received.take([{"type": "SetOrientationMessage", "name": "/robot/1"}] * 2, 1.0)
    received.take([{"type": "SetPositionMessage", "name": "/robot/1"}], 2.0)
    received.take([{"type": "SetOrientationMessage", "name": "/robot/1"}], 3.0)
    assert received.pictures == [1.0, 3.0]
    assert received.messages == 4
