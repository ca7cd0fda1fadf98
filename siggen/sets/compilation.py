"""What is said to whoever waits for the first record on a machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

from siggen.record.compilation import is_compiled

if TYPE_CHECKING:
    from siggen.config import Config

COMPILED_S = 50
"""CPU time of compiling what a first record of `quickstart` needs, check included (`python -m benchmarks cold`)."""
LARGER_SHARE = 0.6
"""Of the larger part, with which two processes are done."""


def compilation_text(config: Config, workers: int) -> str:
    """Return a sentence for whoever waits for the first record on a machine; empty where nothing is to be compiled."""
    if is_compiled(config.dynamics.method):
        return ""
    wait_s = COMPILED_S * (LARGER_SHARE if workers > 1 else 1.0)
    machine = f"about {wait_s:.0f} s on an idle machine"
    return f"compiling the simulation once, for all workers: {machine} before the first record"
