"""What the first record on a machine costs: compilation in its two parts, by processes with an empty cache."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator

from benchmarks.row import Row, duration_text

PRESET = "quickstart"
PART = """
import json, sys, time
from numba.core import event

class Compiled(event.Listener):
    functions = 0

    def on_start(self, event):
        self.functions += 1

    def on_end(self, event):
        pass

compiled = Compiled()
event.register("numba:compile", compiled)
import siggen
from siggen.record.compilation import CompilationPart, run_part
from siggen.record.simulation import simulate_specimen

config = siggen.load_config(sys.argv[1], ["specimens=1", "duration_s=0.05"])
begin = time.process_time()
if sys.argv[2] == "record":
    simulate_specimen(config, [config.records_per_specimen - 1])
else:
    run_part(CompilationPart(config, sys.argv[2]))
print(json.dumps([time.process_time() - begin, compiled.functions]))
"""


def rows(*, quick: bool) -> Iterator[Row]:  # noqa: ARG001 - as every topic
    """Yield the CPU time of both parts, and of a first record behind them; all in one empty cache."""
    found: dict[str, tuple[float, int]] = {}
    with tempfile.TemporaryDirectory() as cache:
        for name in ("teeth", "motion", "record"):
            found[name] = _run(name, cache)
    whole = sum(cost for cost, _ in found.values())
    for name in ("teeth", "motion"):
        cost, functions = found[name]
        what = f"compiling for {PRESET}, part {name}: {functions} functions, CPU"
        yield Row(what, duration_text(cost), f"both parts: {duration_text(whole)}", cost / whole)
    cost, functions = found["record"]
    what = f"a first record of {PRESET} in a new process behind them: {functions} functions compiled, CPU"
    yield Row(what, duration_text(cost), goal="0 functions", met=functions == 0)


def _run(name: str, cache: str) -> tuple[float, int]:
    command = [sys.executable, "-c", PART, PRESET, name]
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    cost, functions = json.loads(done.stdout)
    return float(cost), int(functions)
