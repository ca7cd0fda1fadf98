"""Peak memory of a process that makes one record, against the record's duration."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator

from benchmarks.row import Row

INTERNALS = ("mesh_force_n", "approach_m", "bearing_force_pinion_bearing_vertical_n")
CASES: dict[str, tuple[str, ...]] = {"bench": (), "industrial": (), "bench with internals": INTERNALS}
"""Name, and the quantities that no sensor sees which are stored beside the signals."""
SHORT_S, LONG_S = 10, 60
GOAL_BYTES, GOAL_GROWTH_BYTES = 450e6, 50e6
RECORD = """
import json, pathlib, resource, sys
import siggen
from siggen.sets.drawn import simulated

config = siggen.load_config(sys.argv[1], ["specimens=1", f"duration_s={sys.argv[2]}", *sys.argv[3:]])
(record,) = simulated(config, [0])
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
status = pathlib.Path("/proc/self/status")
if status.is_file():  # there ru_maxrss begins with the size of the process that started this one
    peak = 1024 * int(status.read_text().partition("VmHWM:")[2].split()[0])
print(json.dumps([peak, 4 * config.samples * len([*record.channels, *(record.internals or {})])]))
"""


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the peak of a long record beside that of a short one, and how much of it is the delivered signals."""
    names = ("bench",) if quick else tuple(CASES)
    for name in names:
        _peak(name, 0.1)  # compiles if need be, for which a process takes more memory than for any record
        (short, _), (long, delivered) = _peak(name, SHORT_S), _peak(name, LONG_S)
        yield Row(
            f"{name}: peak memory of a record of {LONG_S} s, {delivered / 1e6:.0f} MB of it delivered",
            f"{long / 1e6:.0f} MB",
            f"{SHORT_S} s: {short / 1e6:.0f} MB",
            goal=f"<= {GOAL_BYTES / 1e6:.0f} MB, + {GOAL_GROWTH_BYTES / 1e6:.0f} MB",
            met=long <= GOAL_BYTES and long - short <= GOAL_GROWTH_BYTES,
        )


def _peak(name: str, duration_s: float) -> tuple[int, int]:
    """Return the peak of a process of its own, and the bytes of the delivered signals."""
    stored = [f"internals.quantities=[{', '.join(CASES[name])}]"] if CASES[name] else []
    command = [sys.executable, "-c", RECORD, name.partition(" ")[0], str(duration_s), *stored]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    peak, delivered = json.loads(done.stdout)
    return int(peak), int(delivered)
