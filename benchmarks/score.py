"""What `score` of 10,000 records of a benchmark beside 17 baselines costs: CPU time of the command.

Labels and answers are drawn and signals are short: a score reads no signal. A gearbox has seven records, and a healthy
one as its reference.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

import siggen
from benchmarks.pages import command_cost
from benchmarks.row import Row, duration_text
from benchmarks.shipped import QUICKSTART
from diagnostics.scoring.benchmark import (
    BASELINES,
    FACTS,
    LEARN,
    PER_PART,
    REVEALED,
    TESTS,
    benchmark_facts,
    open_benchmark,
)
from siggen.plain_json import json_text

GOAL_S = 10.0
PARTS, GEARBOXES, FEW, ENTRIES = 6, 240, 24, 17
AREA_MM2 = {
    "healthy": 0.0,
    "sham": 0.0,
    "face_40": 8.0,
    "face_80": 16.0,
    "through_010": 2.0,
    "through_020": 4.0,
    "through_030": 6.0,
}
"""Of the states that a gearbox is asked about, once each."""
TOLD = ("record_id", "state", "fault", "sham", "damaged_area_mm2")
SAMPLES = 64


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of the command, on as many records as a whole benchmark asks about."""
    with tempfile.TemporaryDirectory() as parent:
        bench, mine = Path(parent) / "bench", Path(parent) / "mine.parquet"
        asked = _write_benchmark(bench, FEW if quick else GEARBOXES)
        (bench / BASELINES).mkdir()
        pq.write_table(_answers(asked, ENTRIES), bench / BASELINES / "predictions.parquet")
        pq.write_table(_answers(asked, 1), mine)
        cost, wall, memory = command_cost("siggen-diagnostics", "score", str(bench), str(mine))
    what = f"score of {len(asked):,} records of {PARTS} parts beside {ENTRIES} baselines: CPU, peak memory"
    measured, beside = f"{duration_text(cost)}, {memory / 1e6:.0f} MB", f"wall: {duration_text(wall)}"
    goal, met = ("", None) if quick else (f"<= {GOAL_S:g} s", cost <= GOAL_S)
    yield Row(what, measured, beside, goal=goal, met=met)


def _write_benchmark(folder: Path, gearboxes: int) -> list[int]:
    """Write a benchmark with revealed labels; return the records that are asked about."""
    learn = siggen.load_config(QUICKSTART, ["specimens=2", "duration_s=0.1", "fs_hz=12800", "mesh_harmonics=3"])
    siggen.generate(learn, folder / LEARN, 0)
    told, names = {}, [f"part_{number}" for number in range(PARTS)]
    for place, name in enumerate(names):
        found = list(_rows(gearboxes, (place + 1) * PER_PART))
        told[name] = {
            "labels": {key: [row[key] for row in found] for key in TOLD},
            "damage": {"record_id": [], "gear": [], "tooth": []},
        }
        siggen.write_recorded_set(learn, folder / TESTS / name, found, pa.schema([]), {}, "", measured=learn)
    facts = benchmark_facts(folder, "Labels that were drawn", "benchmark", tuple(names))
    (folder / FACTS).write_text(json_text(facts))
    ours = {name: facts[name] for name in ("digest", "simulation_version")}
    (folder / REVEALED).write_text(json.dumps({**ours, "parts": told}))
    parts = (open_benchmark(folder).part(name).labels("test", ["record_id"]) for name in names)
    return [record for part in parts for record in part.column("record_id").to_pylist()]


def _rows(gearboxes: int, first: int) -> Iterator[dict[str, Any]]:
    """Yield the references of all gearboxes, then the records that are asked about."""
    signal, pulses = np.zeros(SAMPLES, dtype=np.float32), np.arange(2.0)
    states = [("train", k, "healthy") for k in range(gearboxes)]
    states += [("test", k, state) for k in range(gearboxes) for state in AREA_MM2]
    for number, (split, gearbox, state) in enumerate(states):
        yield {
            "record_id": first + number, "specimen_id": first + gearbox, "state_id": 0, "state": state,
            "operating_point_id": 0, "repeat": 0, "split": split, "sham": state == "sham",
            "fault": "spalling" if AREA_MM2[state] else "healthy",
            "severity": "", "faulty_gear": "none", "damaged_area_mm2": AREA_MM2[state], "damaged_area_share": 0.0,
            "damage_profile_length_mm": 0.0, "mesh_stiffness_loss": 0.0, "speed_hz": 30.0, "torque_nm": 40.0,
            "teeth_pinion": 18, "teeth_gear": 47, "signals": (signal, signal), "tacho_s": pulses,
        }  # fmt: skip


def _answers(asked: list[int], entries: int) -> pa.Table:
    """Return what so many classifiers say of every record, by lot."""
    rng = np.random.default_rng(entries)
    return pa.table(
        {
            "classifier": np.repeat([f"entry {k}" if entries > 1 else "mine" for k in range(entries)], len(asked)),
            "record_id": np.tile(asked, entries),
            "damage": rng.normal(size=entries * len(asked)),
        }
    )
