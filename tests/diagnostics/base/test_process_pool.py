"""Processes that end before their work is done: said in words, with how to go on."""

from __future__ import annotations

import os

import pytest

from diagnostics.base.process_pool import process_pool
from siggen.errors import EngineError


def test_a_killed_process_is_said_in_words() -> None:
    with (
        pytest.raises(EngineError, match=r"one of 1 process was ended from outside.*the same command begins again"),
        process_pool(1) as pool,
    ):
        pool.submit(os.abort).result()
