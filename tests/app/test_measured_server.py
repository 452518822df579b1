"""The lab in a process of its own: what it tells about itself is true."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterator

import numpy as np
import pytest

from momentum_lab.app.bare_client import BareClient
from momentum_lab.app.measure import PUSH
from momentum_lab.app.measured_server import MeasuredServer, resident_memory, stolen_time
from momentum_lab.errors import ServerError
from momentum_lab.scenario import Scenario
from tests.app.test_link import alive
from tests.app.test_server import children

PATIENCE = 60.0


@pytest.fixture(scope="module")
def server() -> Iterator[MeasuredServer]:
    with MeasuredServer(Scenario("stand")) as server:
        yield server


@pytest.fixture
def client(server: MeasuredServer) -> Iterator[BareClient]:
    with BareClient(server.url) as client:
        client.read_until(lambda received: PUSH in received.labels, PATIENCE)
        yield client


def test_vitals_grow_with_time_and_sessions(server, client):
    client.read(0.5)
    before, start = server.vitals(), time.perf_counter()
    client.read(1.0)
    after, elapsed = server.vitals(), time.perf_counter() - start
    assert 0.0 < after.cpu - before.cpu < elapsed  # less than a core: it never simulates
    assert after.late_ticks >= before.late_ticks >= 0
    assert 5e7 < after.memory < 5e9


def test_so_many_messages_are_sent_and_leave_nothing_behind(server, client):
    client.read(0.5)
    before = client.received.kinds["SetSceneNodeVisibilityMessage"]
    server.begin_aging(20_000)
    client.read_until(lambda _: server.aged(), PATIENCE)
    client.read(0.3)
    assert client.received.kinds["SetSceneNodeVisibilityMessage"] > before
    assert client.received.kinds["RemoveSceneNodeMessage"] >= 1
    assert not server.aged()


def test_memory_of_this_process_contains_what_it_holds():
    before = resident_memory(os.getpid())
    held = np.ones(10_000_000)
    assert resident_memory(os.getpid()) - before == pytest.approx(held.nbytes, rel=0.3)
    assert math.isnan(resident_memory(2**30))


def test_it_leaves_no_process():
    """Only what is below this one server counts: processes of other tests come and go."""
    with MeasuredServer(Scenario("stand")) as server:
        pid = server._process.pid
        below = {pid, *children(pid)}
        assert len(below) >= 2
    gone = time.monotonic() + 10.0
    while any(alive(one) for one in below) and time.monotonic() < gone:
        time.sleep(0.05)
    assert not any(alive(one) for one in below)


def test_a_lab_that_cannot_start_is_told(capfd):
    with pytest.raises(ServerError, match=r"^app: got no answer; allowed: one within 60 s"):
        MeasuredServer(Scenario("stand", robot="nobody"))
    assert "robot: got nobody" in capfd.readouterr().err


def test_the_host_takes_no_more_time_than_there_is():
    before, start = stolen_time(), time.perf_counter()
    time.sleep(0.3)
    taken, passed = stolen_time() - before, time.perf_counter() - start
    assert math.isnan(taken) or 0.0 <= taken <= 1.1 * passed * (os.cpu_count() or 1)
