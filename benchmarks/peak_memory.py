"""The largest resident size of this process and of its workers."""

from __future__ import annotations

import sys
from pathlib import Path


def peak_memory_bytes() -> dict[str, int]:
    """Return the largest resident size of this process, and of its largest finished worker; empty where unknown."""
    try:
        import resource
    except ImportError:  # not a POSIX system
        return {}
    unit = 1 if sys.platform == "darwin" else 1024
    parent, worker = (
        resource.getrusage(who).ru_maxrss * unit for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return {"parent": _own_peak_bytes() or parent, "largest_worker": worker}


def _own_peak_bytes() -> int | None:
    """Return this program's peak on Linux, where the usual figure also holds that of the process which started it."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return None
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM:")), None)
