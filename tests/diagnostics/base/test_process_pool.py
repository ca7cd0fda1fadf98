"""Processes that end before their work is done: said in words, with how to go on."""

from __future__ import annotations

import math
import os

import pytest

from diagnostics.base.process_pool import process_pool, second_process
from siggen.errors import EngineError


def test_a_killed_process_is_said_in_words() -> None:
    with (
        pytest.raises(EngineError, match=r"one of 1 process was ended from outside.*the same command begins again"),
        process_pool(1) as pool,
    ):
        pool.submit(os.abort).result()


@pytest.mark.parametrize("worth", [False, True])
def test_work_beside_gives_what_it_gives_here_and_its_errors(worth: bool) -> None:
    with second_process(worth=worth, first=os.getpid) as begin:
        power, root, process = begin(pow, 2.0, 0.5), begin(math.sqrt, -1.0), begin(os.getpid)
        assert power() == 2.0**0.5
        with pytest.raises(ValueError, match="math domain"):
            root()
        assert (process() != os.getpid()) is worth
