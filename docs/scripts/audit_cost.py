"""CPU and wall time of the audit of 1,007 records, step by step: `python docs/scripts/audit_cost.py [SET]`.

Without SET, makes one in runs/audit_cost where it is missing: 53 gearboxes in 19 states like bench (two channels, 1.5 s
at 25.6 kHz, two healthy records each), with the quickest model, since the audit costs the same whatever moved the
gears. One process, one thread. The table of the set is made anew.
"""

from __future__ import annotations

import resource
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import siggen
from diagnostics.audit.audit_report import audit_set, write_audit
from siggen.config.inheritance import inherited
from siggen.config.yaml_source import read_yaml

CONFIGS, FOLDER = Path("configs"), Path("runs/audit_cost")
GEARBOXES, DAMAGED = 53, 17
SEVERITIES = ("slight", "moderate", "severe")


def quick_config() -> dict[str, Any]:
    """Return bench with linear mesh stiffness, no casing and pits in place of spalls."""
    raw, linear = (inherited(read_yaml(CONFIGS / f"{name}.yaml"), CONFIGS) for name in ("bench", "linear_pits"))
    pits = [state for state in linear["states"] if state["name"] != "healthy"]
    states = raw["states"][:2]
    for k in range(DAMAGED):
        grade = min(k // 6, 2)
        states.append({**pits[grade], "name": f"pits_{k:02d}", "grows_from": "none", "severity": SEVERITIES[grade]})
    for part in ("housing", "background", "manufacture"):
        raw.pop(part, None)
    for sensor in raw["sensors"]:
        sensor.update(path=None, place="pinion_bearing")
        sensor.pop("position_mm")
    splits = {"train": 10, "validation": 10, "test": 0}
    return {
        **raw, "name": "cost", "specimens": GEARBOXES, "splits": splits, "dynamics": linear["dynamics"],
        "states": states,
    }  # fmt: skip


@contextmanager
def timed(name: str, _: int) -> Iterator[Callable[[], None]]:
    """Print what a step took."""
    wall, cpu = time.perf_counter(), time.process_time()
    yield lambda: None
    print(f"| {name} | {time.process_time() - cpu:.0f} s | {time.perf_counter() - wall:.0f} s |", flush=True)


def main(path: Path) -> None:
    """Print one row per step."""
    if not (path / "manifest.json").exists():
        siggen.generate(siggen.load_config(quick_config()), path, workers=2)
    shutil.rmtree(path.with_name(f"{path.name}_table"), ignore_errors=True)
    dataset, wall, cpu = siggen.open(path), time.perf_counter(), time.process_time()
    print("| step | CPU | wall |\n|---|---|---|")
    audit = audit_set(dataset, paired=True, with_realism=True, stage=timed)
    with timed("page and figures", 1):
        write_audit(audit, dataset, path.with_name(f"{path.name}_audit"))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"| all, {audit.records} records, {memory:.0f} MB | {time.process_time() - cpu:.0f} s |", end="")
    print(f" {time.perf_counter() - wall:.0f} s |")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
