"""What is said to whoever waits for the first record on a machine."""

from __future__ import annotations

from siggen.record.compilation import is_compiled

COMPILED_S = 50
"""CPU time of compiling what a first record of `quickstart` needs, check included (`python -m benchmarks cold`)."""
LARGER_SHARE = 0.6
"""Of the larger part, with which two processes are done."""


def compilation_text(method: str, workers: int) -> str:
    """Return a sentence for whoever waits for a machine's first record; empty where nothing is to be compiled."""
    if is_compiled(method):
        return ""
    wait_s = COMPILED_S * (LARGER_SHARE if workers > 1 else 1.0)
    machine = f"about {wait_s:.0f} s on an idle machine"
    return f"compiling the simulation, the first time only: {machine} before the first record"
