"""What it costs to score predictions for 10,000 records by every task of a set of states, and to refuse bad ones."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from benchmarks.row import Row, duration_text
from diagnostics.scoring.score import score
from siggen.config.names import NO_NAMES, Names
from siggen.errors import UsageError

GEARBOXES, TEETH, GOAL_S = 1250, (18, 47), 10.0
STATES = ("healthy", "healthy_again", "sham", "pits", "face_40", "face_80", "through_020", "through_030")
DAMAGED_FROM = 3


@dataclass(frozen=True)
class FabricatedSet:
    """Labels in memory behind what `score` asks of a set."""

    rows: pa.Table
    path: Path = Path("fabricated")
    splits: tuple[str, ...] = ("test",)
    config: dict[str, Any] = field(default_factory=dict)
    manifest: dict[str, Any] = field(default_factory=lambda: {"identity": "0" * 64, "simulation_version": 0})

    def names(self) -> tuple[Names, dict[str, str]]:
        """Return no names of a user's own."""
        return NO_NAMES, {}

    def labels(self, split: str | None = None, columns: Sequence[str] | None = None) -> pa.Table:
        """Return labels as a set does; all are of one split."""
        assert split in (None, *self.splits)
        return self.rows.select(list(columns)) if columns else self.rows

    def damage(self, split: str | None = None) -> pa.Table:
        """Return one damaged tooth for each damaged record."""
        assert split in (None, *self.splits)
        numbers = self.rows.column("record_id").to_numpy()
        damaged = numbers[numbers % len(STATES) >= DAMAGED_FROM]
        return pa.table({"record_id": damaged, "gear": ["pinion"] * damaged.size, "tooth": damaged % TEETH[0]})


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield the CPU time of both, and the time of the imports apart; quick takes a tenth of the records."""
    gearboxes = GEARBOXES // 10 if quick else GEARBOXES
    dataset, predictions = fabricated(gearboxes)
    count = gearboxes * len(STATES)
    start = time.process_time()
    found = score(dataset, predictions)
    cost_s = time.process_time() - start
    tasks = len({row.task for row in found.rows})
    what = f"score of {count:,} records, {tasks} tasks, {len(found.rows)} scores with limits"
    yield Row(what, duration_text(cost_s), goal=f"<= {GOAL_S:g} s", met=cost_s <= GOAL_S)
    bad = {**predictions, "damage": np.where(np.arange(count) % 7 == 0, np.nan, predictions["damage"])}
    bad["record_id"] = np.append(predictions["record_id"][1:], -1)
    start = time.process_time()
    try:
        score(dataset, bad)
    except UsageError as error:
        said = str(error).splitlines()[0]
        yield Row(f"refusal of {count:,} records: {said}", duration_text(time.process_time() - start))


def fabricated(gearboxes: int) -> tuple[Any, dict[str, np.ndarray]]:
    """Return a set of that many gearboxes, and predictions for every task: the truth with noise."""
    rng, size = np.random.default_rng(1), gearboxes * len(STATES)
    number, place = np.arange(size), np.tile(np.arange(len(STATES)), gearboxes)
    area = np.maximum(place - DAMAGED_FROM + 1.0, 0.0)
    damaged = area > 0.0
    names = np.array(STATES)[place]
    table = pa.table(
        {
            "record_id": number,
            "specimen_id": number // len(STATES),
            "split": ["test"] * size,
            "state": names,
            "state_id": place,
            "fault": np.where(damaged, "spalling", "healthy"),
            "sham": names == "sham",
            "damaged_area_mm2": area,
            "teeth_pinion": np.full(size, TEETH[0]),
            "teeth_gear": np.full(size, TEETH[1]),
        }
    )
    noisy = area + rng.normal(size=size)
    classes = ("healthy", *STATES[DAMAGED_FROM:])
    odds = np.exp(rng.normal(size=(size, len(classes))) + 2.0 * (area[:, None] == np.arange(len(classes))))
    probability = odds / odds.sum(axis=1, keepdims=True)
    found = {
        "record_id": number,
        "damage": noisy,
        "area_mm2": np.abs(noisy),
        "gear": np.where(rng.uniform(size=size) < 0.8, "pinion", "gear"),
        "tooth": np.where(rng.uniform(size=size) < 0.5, number % TEETH[0], 0),
        **{f"p_{name}": probability[:, k] for k, name in enumerate(classes)},
    }
    return FabricatedSet(table), found
