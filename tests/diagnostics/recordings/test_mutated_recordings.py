"""Recordings with wrong bytes give indicators or a sentence, and what parses them cannot take the command along."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from diagnostics.base import reading_process
from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.file_columns import file_columns
from siggen.errors import UsageError
from tests.faults.mutated_recordings import mutated_recordings, recordings


def test_every_mutated_recording_is_read_or_refused_in_words(tmp_path: Path) -> None:
    cases = list(mutated_recordings(27, recordings(tmp_path), seed=3))
    assert {case.outcome for case in cases} == {"accepted", "refused"}, [c for c in cases if c.outcome == "traceback"]
    assert all(case.message.startswith(str(tmp_path)) for case in cases if case.outcome == "refused")


def test_columns_that_come_from_the_process_apart_are_those_read_here(tmp_path: Path) -> None:
    for path in recordings(tmp_path):
        here, apart = file_columns(path), read_columns(path)
        assert list(here.values) == list(apart.values)
        assert (here.fs_hz, here.full_scale, here.simulated) == (apart.fs_hz, apart.full_scale, apart.simulated)
        for name, column in here.values.items():
            np.testing.assert_array_equal(column, apart.values[name])


def test_a_reading_process_that_was_killed_is_started_again(tmp_path: Path) -> None:
    path = recordings(tmp_path)[5]
    read_columns(path)
    os.kill(reading_process._started[os.getpid()].pid, signal.SIGKILL)
    reading_process._started[os.getpid()].wait()
    assert len(read_columns(path).values) == 2


def test_a_parser_that_crashes_or_never_ends_is_told_in_words(tmp_path: Path) -> None:
    assert reading_process._answer(signal.SIGSEGV, tmp_path) == {"ended": "signal 11"}
    assert reading_process._answer(signal.SIGXCPU, tmp_path) == {"ended": "reading it took too long"}
    path = recordings(tmp_path)[0]
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(reading_process, "_asked", lambda _: {"ended": "signal 11"})
        with pytest.raises(UsageError, match=r"0.csv: cannot be read: it is damaged, or far too large \(signal 11\)"):
            read_columns(path)


UNDER_A_LIMIT = """
import resource, sys
from pathlib import Path
from diagnostics.recordings.columns import read_columns
from diagnostics.recordings.file_columns import file_columns
resource.setrlimit(resource.RLIMIT_AS, (4_000_000 << 10,) * 2)
print(*read_columns(Path(sys.argv[1])).values)
file_columns(Path(sys.argv[1]))
assert "pandas" not in sys.modules
"""


def test_a_good_file_is_read_below_a_memory_limit_of_the_user_and_without_pandas(tmp_path: Path) -> None:
    path = recordings(tmp_path)[0]
    done = subprocess.run(
        [sys.executable, "-P", "-c", UNDER_A_LIMIT, path], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.stdout.split() == list(read_columns(path).values), done.stderr
