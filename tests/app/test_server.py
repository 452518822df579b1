"""The lab over a real socket: isolation, freedom from leftovers, and clients that send nonsense."""

from __future__ import annotations

import math
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import pytest
from websockets.exceptions import ConnectionClosed

from momentum_lab.app import server
from momentum_lab.app.bare_client import BareClient, Received
from momentum_lab.app.profile import TEST
from momentum_lab.app.server import LabServer
from momentum_lab.app.visitor import Visitor
from momentum_lab.app.wake import Wake
from momentum_lab.app.wire import Truth
from momentum_lab.errors import InputError, ServerError
from momentum_lab.scenario import Scenario
from tests.app.test_link import alive

# The lab ignores this itself, but pytest sets its own filters for every test.
pytestmark = pytest.mark.filterwarnings("ignore:Queued a:UserWarning")

PATIENCE = 30.0
PUSH = "Push  (P)"


@pytest.fixture(scope="module")
def lab() -> Iterator[LabServer]:
    with LabServer(Scenario("stand"), profile=TEST) as lab:
        yield lab


@pytest.fixture
def client(lab: LabServer) -> Iterator[BareClient]:
    with BareClient(lab.url) as client:
        client.read_until(furnished, PATIENCE)
        client.read(0.3)
        yield client
    wait_for(lambda: not lab.visitors)


def furnished(received: Received) -> bool:
    return PUSH in received.labels and "View tab" in received.labels


def wait_for(condition: Callable[[], object]) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "not true in time"
        time.sleep(0.02)


def truth_of(visitor: Visitor) -> Truth:
    wait_for(lambda: visitor.latest is not None)
    assert visitor.latest is not None
    return visitor.latest.truth


def told(client: BareClient, words: str) -> None:
    """Wait until a notice says something."""
    client.read_until(lambda received: any(words in notice for notice in received.notices), PATIENCE)


# What a new tab gets


def test_a_new_tab_shows_a_standing_robot_and_asks_for_a_push(client, lab):
    received = client.read(1.0)
    assert received.kinds["MeshMessage"] > 30
    assert received.kinds["GuiUplotMessage"] == 4
    assert {"robot", "priority", "force (N)", "camera", "Push tab", "Help"} <= set(received.labels)
    assert received.told[1] > 0.0
    assert truth_of(lab.visitors[0]).fall is None


def test_a_tab_may_be_drawn_to_from_several_threads(client, lab):
    buffer = lab.visitors[0].client._websock_connection.get_message_buffer()
    assert isinstance(buffer.message_event, Wake)


def test_there_is_no_way_to_a_public_tunnel(client):
    theme = client.received.latest["ThemeConfigurationMessage"]
    assert theme["show_share_button"] is False


def test_the_test_profile_has_no_shadows(client):
    assert client.received.latest["EnableLightsMessage"]["cast_shadow"] is False
    assert client.received.latest["EnvironmentMapMessage"]["hdri_data"] is None


# What a tab does


def test_the_button_pushes_and_the_robot_moves(client, lab):
    client.read(0.5)
    turned = client.received.drawings
    client.set_value(PUSH, True)
    client.read_until(lambda received: received.drawings > turned + 10, PATIENCE)
    assert truth_of(lab.visitors[0]).push.force == 217.0


def test_a_slider_reaches_the_session_within_a_tenth_of_a_second(client, lab):
    client.read(0.3)
    start = time.monotonic()
    client.set_value("priority", 0.35)
    wait_for(lambda: truth_of(lab.visitors[0]).priority == 0.35)
    assert time.monotonic() - start < 0.4  # a tenth, and room for a busy machine


def test_a_still_robot_is_not_sent_again(client):
    client.read(1.5)
    changes = client.received.changes
    client.read(1.0)
    assert client.received.changes - changes < 5


# What a tab must not do


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e9, -3.0])
def test_a_slider_out_of_its_range_is_refused_and_the_session_goes_on(client, lab, value):
    client.set_value("priority", value)
    told(client, "allowed:")
    client.set_value("priority", 0.5)
    wait_for(lambda: truth_of(lab.visitors[0]).priority == 0.5)


@pytest.mark.parametrize("value", [math.nan, 1e9, -5.0])
def test_a_push_that_no_slider_could_give_is_refused(client, lab, value):
    client.set_value("force (N)", value)
    client.set_value(PUSH, True)
    told(client, "force: got")
    assert truth_of(lab.visitors[0]).push is None


def test_files_of_the_server_cannot_be_named(client, lab):
    client.set_value("robot", "/etc/passwd.toml")
    told(client, "robot: got /etc/passwd.toml; allowed: one of")
    assert truth_of(lab.visitors[0]).robot == "talos"


def test_a_tab_that_sends_rubbish_harms_nobody(client, lab):
    with BareClient(lab.url) as other:
        other.read_until(furnished, PATIENCE)
        other.send({"type": "GuiUpdateMessage", "uuid": "nobody", "updates": {"value": 1}})
        other.send_raw(b"\x81\xa4type\xa6Nobody")
    before = client.read(0.2).told[1]
    assert client.read(0.5).told[1] > before


# Isolation and leftovers


def test_each_tab_has_a_robot_of_its_own(client, lab):
    (first,) = lab.visitors
    with BareClient(lab.url) as other:
        other.read_until(furnished, PATIENCE)
        (second,) = [visitor for visitor in lab.visitors if visitor is not first]
        assert first.worker_pid != second.worker_pid
        other.set_value(PUSH, True)
        wait_for(lambda: truth_of(second).push is not None)
        other.set_value("robot", "g1")
        wait_for(lambda: truth_of(second).robot == "g1")
        assert truth_of(first).push is None
        assert truth_of(first).robot == "talos"


def test_closing_a_tab_ends_its_process(client, lab):
    (first,) = lab.visitors
    other = BareClient(lab.url)
    other.read_until(furnished, PATIENCE)
    (second,) = [visitor for visitor in lab.visitors if visitor is not first]
    other.close()
    wait_for(lambda: not alive(second.worker_pid))
    wait_for(lambda: lab.visitors == [first])
    assert alive(first.worker_pid)


def test_closing_the_lab_ends_everything():
    with LabServer(Scenario("stand"), profile=TEST) as lab:
        client = BareClient(lab.url)
        client.read_until(furnished, PATIENCE)
        pid = lab.visitors[0].worker_pid
    assert not alive(pid)
    with pytest.raises(OSError, match="refused"):
        socket.create_connection(("127.0.0.1", lab.port), timeout=1.0)
    with pytest.raises(ConnectionClosed):
        client.read(PATIENCE)


def test_a_full_lab_says_so(client, lab, monkeypatch):
    monkeypatch.setattr(server, "MOST_VISITORS", 1)
    with BareClient(lab.url) as other:
        told(other, "1 tabs are open: close one.")
        assert len(lab.visitors) == 1


# Addresses


def test_the_real_port_is_told_and_only_this_machine_is_served(lab):
    assert lab.url == f"http://127.0.0.1:{lab.port}"
    assert lab.port > 0


def test_a_port_in_use_is_refused(lab):
    with pytest.raises(ServerError) as error:
        LabServer(Scenario("stand"), port=lab.port)
    assert str(error.value) == (
        f"port: got {lab.port}, which is in use; allowed: a free port, or 0 to let the system choose one"
    )


@pytest.mark.parametrize("port", [-1, 65536])
def test_a_port_that_does_not_exist_is_refused(port):
    with pytest.raises(ServerError, match=r"^port: got .*; allowed: 0 \(any free port\) to 65535$"):
        LabServer(Scenario("stand"), port=port)


def test_a_host_that_is_not_this_machine_is_refused():
    with pytest.raises(ServerError, match=r"^host: got 192\.0\.2\.1; allowed: an address of this machine"):
        LabServer(Scenario("stand"), host="192.0.2.1")


def test_a_scenario_that_cannot_start_is_refused():
    with pytest.raises(InputError, match=r"^robot: got nobody; allowed: one of"):
        LabServer(Scenario("stand", robot="nobody"))
    with pytest.raises(InputError, match=r"^stance: got middle; allowed: feet among"):
        LabServer(Scenario("stand", stance=("middle",)))


# The server as a process

SERVE = """
from momentum_lab.app.profile import TEST
from momentum_lab.app.server import serve
from momentum_lab.scenario import Scenario
if __name__ == "__main__":
    serve(Scenario("stand"), port=0, open_browser=False, profile=TEST)
"""


@pytest.fixture
def served(tmp_path) -> Iterator[tuple[subprocess.Popen, str]]:
    """The lab served by a process, and its address."""
    script = tmp_path / "lab.py"
    script.write_text(SERVE)
    process = subprocess.Popen(
        [sys.executable, script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    line = process.stdout.readline()
    yield process, line.split()[2]
    process.kill()
    process.communicate()


def children(pid: int) -> set[int]:
    """All processes below a process."""
    parents = {}
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                with open(f"/proc/{entry}/stat") as file:
                    parents[int(entry)] = int(file.read().rsplit(")", 1)[1].split()[1])
            except (FileNotFoundError, ProcessLookupError):
                continue
    found = {pid}
    while new := {child for child, parent in parents.items() if parent in found} - found:
        found |= new
    return found - {pid}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_and_sigterm_end_it_cleanly(served, number):
    process, url = served
    with BareClient(url) as client:
        client.read_until(furnished, PATIENCE)
        below = children(process.pid)
        assert len(below) >= 2
        wait_for(lambda: client._socket.recv_messages.paused)  # it has read enough, as a phone that sleeps
        for pid in (process.pid, *below) if number == signal.SIGINT else (process.pid,):
            os.kill(pid, number)  # a terminal sends Ctrl+C to all of them
        begun = time.monotonic()
        process.wait(PATIENCE)
        assert time.monotonic() - begun < 5.0  # this tab reads no goodbye; viser alone waits 6 s for it
        socket.create_server(("127.0.0.1", int(url.rpartition(":")[2]))).close()
        with pytest.raises(ConnectionClosed):
            client.read(PATIENCE)
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    assert "Traceback" not in err
    assert "viser" not in out
    wait_for(lambda: not any(alive(pid) for pid in below))


def test_a_server_that_is_killed_leaves_no_process(served):
    process, url = served
    with BareClient(url) as client:
        client.read_until(furnished, PATIENCE)
        below = children(process.pid)
        process.kill()
    wait_for(lambda: not any(alive(pid) for pid in below))
