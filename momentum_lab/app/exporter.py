"""Files made of a run, in a process of their own: a picture that is drawn delays no tick and no other drawing."""

from __future__ import annotations

import io
import multiprocessing
from collections.abc import Callable
from multiprocessing.connection import Connection

import msgspec

from momentum_lab.app.birth import born
from momentum_lab.app.wire import RunTaken, rows_of
from momentum_lab.choices import Choices
from momentum_lab.errors import InputError, LabError
from momentum_lab.experiments.window import around_pushes
from momentum_lab.fall import Fall
from momentum_lab.finished import FinishedRun
from momentum_lab.provenance import provenance
from momentum_lab.recording import Layout, Recording
from momentum_lab.robot.model import RobotModel
from momentum_lab.run_file import encoded
from momentum_lab.trace import write_trace

# A minute's table on a busy machine takes less, s.
_PATIENCE = 180.0


class _Made(msgspec.Struct, frozen=True):
    """What came out: the content of a file, or why there is none."""

    content: bytes
    problem: str = ""


def made_elsewhere(kind: str, taken: RunTaken) -> bytes:
    """The content of a file about a run, made by another process.

    Args:
        kind: one of `MAKERS`.
        taken: the run, with its recording.

    Raises:
        InputError: it cannot be made of this run.
    """
    ours, theirs = multiprocessing.Pipe()
    process = born(main, (theirs, kind), "export")
    theirs.close()
    try:
        ours.send_bytes(msgspec.msgpack.encode(taken))
        if not ours.poll(_PATIENCE):
            raise InputError("download", kind, f"what can be made within {_PATIENCE:g} s")
        answer = msgspec.msgpack.decode(ours.recv_bytes(), type=_Made)
    except (EOFError, OSError) as error:
        raise InputError("download", kind, "a run that fits into memory") from error
    finally:
        ours.close()
        process.terminate()
        process.join()
    if answer.problem:
        raise InputError("download", kind, answer.problem)
    return answer.content


def main(connection: Connection, kind: str) -> None:
    """Take a run out of the pipe, put a file into it."""
    with connection:
        taken = msgspec.msgpack.decode(connection.recv_bytes(), type=RunTaken)
        try:
            answer = _Made(made(kind, taken))
        except (LabError, MemoryError) as error:
            answer = _Made(b"", str(error) or "a run that fits into memory")
        connection.send_bytes(msgspec.msgpack.encode(answer))


def made(kind: str, taken: RunTaken) -> bytes:
    """The content of a file about a run.

    Raises:
        InputError: it cannot be made of this run.
    """
    return MAKERS[kind](finished(taken))


def finished(taken: RunTaken, robot: RobotModel | None = None) -> FinishedRun:
    """The run as summaries and figures take it.

    Args:
        taken: the run.
        robot: its robot, if it is loaded already.
    """
    robot = robot or RobotModel.named(taken.run.scenario.robot)
    layout = Layout.of(robot)
    rows = rows_of(taken.rows, layout.width)
    recording = Recording(layout, max(1, len(rows)))
    for row in rows:
        recording.next_row()[:] = row
    return FinishedRun(
        taken.run,
        robot,
        recording,
        taken.time,
        Choices.of(taken.run.scenario).after_all((entry.event for entry in taken.run.events), robot),
        taken.pushes,
        None if taken.fall is None else Fall(taken.fall.time, taken.fall.reason),
        taken.failures,
        taken.com_speed,
        None if taken.other is None else finished(taken.other, robot),
        taken.since,
    )


def _trace(run: FinishedRun) -> bytes:
    file = io.BytesIO()  # a process that is stopped in the middle would leave a folder behind
    write_trace(run.recording, provenance(run), file, None if run.beside is None else run.beside.recording)
    return file.getvalue()


def _table(run: FinishedRun) -> bytes:
    from momentum_lab.experiments.run_table import table

    return table(run)


def _plots(run: FinishedRun) -> bytes:
    from momentum_lab.experiments.run_plots import over_time, png

    return png(over_time(run))


def _report(run: FinishedRun) -> bytes:
    from momentum_lab.experiments.run_report import report

    return report(run)


def _recording(run: FinishedRun) -> bytes:
    from momentum_lab.app.recorder import html_file

    return html_file(around_pushes(run))


def _viser(run: FinishedRun) -> bytes:
    from momentum_lab.app.recorder import viser_file

    return viser_file(around_pushes(run))


MAKERS: dict[str, Callable[[FinishedRun], bytes]] = {
    "run": lambda run: encoded(run.run),
    "trace": _trace,
    "table": _table,
    "plots": _plots,
    "report": _report,
    "recording": _recording,
    "viser": _viser,
}
"""Kind -> what makes it; matplotlib and viser are loaded by those that need them."""
