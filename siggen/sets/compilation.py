"""Whether the simulation still has to be compiled on this machine, and what that costs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

COMPILED_S = 40
"""CPU time of compiling all that a first record needs; 35 s measured on a core of 2024, for the law of tooth pairs."""


def is_compiled() -> bool:
    """Return whether numba's cache holds the forces of the tooth pairs, which take longest of all to compile.

    Derived: numba keeps an index beside the code, or where NUMBA_CACHE_DIR says. It is there after the first record.
    """
    from siggen.dynamics.mesh import pair_forces

    compiled: Any = pair_forces.write_forces
    folder = Path(compiled.stats.cache_path)
    return any(folder.glob("pair_forces.write_forces-*.nbi"))


def compilation_text() -> str:
    """Return a sentence for whoever waits for the first record on a machine; empty where nothing is to be compiled."""
    if is_compiled():
        return ""
    return f"compiling the simulation once: about {COMPILED_S} s of CPU per worker before the first record"
