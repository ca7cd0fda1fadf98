"""A module that a worker takes minutes to import, as it takes seconds for the physics on a busy machine."""

from __future__ import annotations

import os
import time
from pathlib import Path

if os.environ.get("SIGGEN_TEST_DRIVER", str(os.getpid())) != str(os.getpid()):
    (Path(os.environ["SIGGEN_TEST_BUSY"]) / str(os.getpid())).touch()
    time.sleep(300.0)


def same(task: int) -> int:
    return task
