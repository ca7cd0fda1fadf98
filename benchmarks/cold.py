"""What the first record on a machine costs: the check, and compilation in two parts, with an empty cache."""

from __future__ import annotations

import json
import os
import shutil
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
from siggen.checks.physical_problems import physical_problems
from siggen.record.compilation import run_part
from siggen.sets.drawn import compilation_parts, simulated

begin = time.process_time()
config = siggen.load_config(sys.argv[1], ["specimens=1", "duration_s=0.05"])
if sys.argv[2] == "record":
    severest = max(config.damaged_states(0))
    list(simulated(config, [severest * config.records_per_specimen // config.state_count]))
elif sys.argv[2] != "check":
    run_part(next(part for part in compilation_parts(config) if part.name == sys.argv[2]))
print(json.dumps([time.process_time() - begin, compiled.functions]))
"""


PARTS = ("teeth", "motion")


def rows(*, quick: bool) -> Iterator[Row]:  # noqa: ARG001 - as every topic
    """Yield the CPU time of the check before both parts, of each part, and of a first record behind them.

    The parts run side by side, so neither finds what the other one compiles: each has a copy of the check's cache.
    """
    found: dict[str, tuple[float, int]] = {}
    with tempfile.TemporaryDirectory() as cache:
        found["check"] = _run("check", cache)
        for name in PARTS:
            shutil.copytree(cache, f"{cache}_{name}")
            found[name] = _run(name, f"{cache}_{name}")
        for name in PARTS:
            shutil.copytree(f"{cache}_{name}", cache, dirs_exist_ok=True)
            shutil.rmtree(f"{cache}_{name}")
        found["record"] = _run("record", cache)
    whole = sum(found[name][0] for name in ("check", *PARTS))
    names = {"check": "checking the configuration", "teeth": "part teeth", "motion": "part motion"}
    for name, said in names.items():
        cost, functions = found[name]
        what = f"compiling for {PRESET}, {said}: {functions} functions, CPU"
        yield Row(what, duration_text(cost), f"check and both parts: {duration_text(whole)}", cost / whole)
    cost, functions = found["record"]
    what = f"a first record of {PRESET} in a new process behind them: {functions} functions compiled, CPU"
    yield Row(what, duration_text(cost), goal="0 functions", met=functions == 0)


def _run(name: str, cache: str) -> tuple[float, int]:
    command = [sys.executable, "-c", PART, PRESET, name]
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    cost, functions = json.loads(done.stdout)
    return float(cost), int(functions)
