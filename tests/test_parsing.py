"""Trees of Python text, built in many threads at once."""

from __future__ import annotations

import ast
from concurrent.futures import ThreadPoolExecutor

import pytest

from momentum_lab.lesson.parsing import parsed

DEEP = "x = " + "(" * 40 + "1" + " + 1)" * 40


def test_threads_do_not_disturb_each_other():
    with ThreadPoolExecutor(8) as pool:
        trees = list(pool.map(parsed, [DEEP + f"\ny = {i}" for i in range(200)]))
    assert [ast.literal_eval(tree.body[1].value) for tree in trees] == list(range(200))


def test_what_is_not_python_is_refused():
    with pytest.raises(SyntaxError):
        parsed("1 +", mode="eval")
