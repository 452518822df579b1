"""A program that ends while a thread of its own starts processes leaves none half born."""

import importlib.util
import os
import signal
import subprocess
import sys
import time

import pytest

from momentum_lab.app.birth import LOADED_ONCE, born

# A thread starts one process after the other; the program ends at a moment of its own choice.
ENDS = """
import sys
import threading
import time
from momentum_lab.app.birth import born

def go_on():
    while True:
        born(len, (bytes(10_000_000),), "short")  # long orders take long to give
        begun.set()

if __name__ == "__main__":
    begun = threading.Event()
    threading.Thread(target=go_on, daemon=True).start()
    begun.wait()
    time.sleep(float(sys.argv[1]))
"""


@pytest.mark.parametrize("instant", [0.0, 0.01, 0.02, 0.03, 0.05, 0.08])
def test_a_program_ends_in_silence_while_processes_are_started(tmp_path, instant):
    script = tmp_path / "ends.py"
    script.write_text(ENDS)
    ended = subprocess.run(
        [sys.executable, script, str(instant)], capture_output=True, text=True, timeout=60, check=False
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")


def test_a_process_has_its_name_and_ends_with_the_program():
    process = born(print, (), "one of ours")
    process.join()
    assert (process.name, process.daemon, process.exitcode) == ("one of ours", True, 0)


def test_a_process_does_not_hear_ctrl_c():
    process = born(time.sleep, (0.3,), "deaf")
    os.kill(process.pid, signal.SIGINT)  # most likely before it has its orders
    process.join()
    assert process.exitcode == 0
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_what_is_loaded_once_exists():
    assert importlib.util.find_spec(
        LOADED_ONCE
    )  # multiprocessing says nothing about a name that it cannot find
