"""The machine that the numbers belong to: processor, cores, versions, and how busy it is."""

from __future__ import annotations

import os
import platform
from pathlib import Path

from siggen.dataset.environment import environment
from siggen.workers.choice import default_workers

QUIET_LOAD = 0.5
"""Load average above which somebody else's work shows in the numbers."""


def machine_lines() -> list[str]:
    """Return what to print above a table; the last line is a warning if the machine is busy."""
    facts = environment()
    packages = " ".join(f"{name} {facts[name]}" for name in ("siggen", "numpy", "scipy", "numba", "pyarrow"))
    load = load_average()
    lines = [
        f"{_cpu_model()}, {default_workers()} of {os.cpu_count()} cores, one numeric thread per process",
        f"{facts['system']}, python {facts['python']}, {packages}",
        f"load average at start: {load:.2f}",
    ]
    if load > QUIET_LOAD:
        lines.append(f"WARNING: above {QUIET_LOAD}: others are using this machine, and wall times are pessimistic")
    return lines


def load_average() -> float:
    """Return the mean number of runnable processes over the last minute; 0 where it is unknown."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else 0.0


def _cpu_model() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    found = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(found, platform.machine())
