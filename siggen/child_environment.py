"""What processes that siggen starts find in their environment: threads of libraries, and where modules come from."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "VECLIB_MAXIMUM_THREADS",
        "NUMEXPR_NUM_THREADS",
        "NUMBA_NUM_THREADS",
        "ARROW_NUM_THREADS",
        "ARROW_IO_THREADS",
    ),
    "1",
)
"""Numeric libraries read these when they are loaded: as many workers as cores, each with one thread."""

SAFE_PATH = {"PYTHONSAFEPATH": "1"}
"""`python -P`: without it a process of `multiprocessing` first looks for every module in the folder where it starts,
and so runs a `json.py` that came with somebody's recordings."""

OF_WORKERS = {**ONE_THREAD, **SAFE_PATH}


@contextmanager
def child_environment(variables: Mapping[str, str]) -> Iterator[None]:
    """Set environment variables for processes that start inside the block."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
