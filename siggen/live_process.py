"""Who writes: a process by its machine, the start of that machine, and its number; and whether it is gone."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def this_process() -> dict[str, Any]:
    """Return host, start of the machine ("" where the system does not tell it) and number of this process."""
    boot = Path("/proc/sys/kernel/random/boot_id")
    start = boot.read_text(encoding="ascii").strip() if boot.is_file() else ""
    return {"host": platform.node(), "boot": start, "pid": os.getpid()}


def is_gone(process: Mapping[str, Any]) -> bool:
    """Tell whether a process is known to be gone: it ran on this machine, since its last start, and does not."""
    here = this_process()
    if not here["boot"] or any(process.get(name) != here[name] for name in ("host", "boot")):
        return False
    return not Path(f"/proc/{process.get('pid')}").exists()
