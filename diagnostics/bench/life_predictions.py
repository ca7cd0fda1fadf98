"""What the baselines of remaining life say of the inspections asked about; they learn on the part to learn from.

They count hours by what wears as much there: the load of every part and the exponent of torque are published.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.base.progress import Stage
from diagnostics.bench.conditions import LIFE_CONDITIONS
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.scoring.benchmark import LEARN, Benchmark
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD
from diagnostics.scoring.remaining_life import COLUMNS
from diagnostics.training.life_baselines import Inspections, predictors
from diagnostics.training.life_rows import blind_inspections, inspections_of
from siggen.dataset.reading import Dataset


def life_predictions(benchmark: Benchmark, seed: int, workers: int, stage: Stage) -> Iterator[pa.Table]:
    """Yield the rows of every baseline.

    Raises
    ------
    DatasetError
        If fewer than four gearboxes of the part to learn from failed.
    """
    parts = {name: benchmark.part(name) for name in benchmark.parts}
    learn = inspections_of(benchmark.learn(), _table(LEARN, benchmark.learn(), workers, stage))
    tests = [blind_inspections(part, _table(name, part, workers, stage)) for name, part in parts.items()]
    found = joined([learn, *tests])
    paces = [pace(benchmark.learn().config, LIFE_CONDITIONS.get(name, {})) for name in parts]
    hour = np.repeat([1.0, *paces], [one.specimen.size for one in (learn, *tests)])
    found = replace(found, age_h=found.age_h * hour)
    known = np.arange(found.specimen.size) < learn.specimen.size
    asked = ~known & (found.split == "test")
    every = predictors(found, seed)
    with stage("baselines", len(every)) as advance:
        for name, predict in every.items():
            hours = np.maximum(predict(known, asked) / hour[asked, None], 0.0)  # lives are never below 0
            record = pa.array(found.record_id[asked], pa.int64())
            yield pa.table(
                {CLASSIFIER: [name] * len(record), RECORD: record, **dict(zip(COLUMNS, hours.T, strict=True))}
            )
            advance()


def _table(name: str, dataset: Dataset, workers: int, stage: Stage) -> RecordTable:
    with stage(f"indicators, {name}", dataset.inventory.rows) as advance:
        return record_table(dataset, workers=workers, advance=advance)


def pace(config: Mapping[str, Any], changes: Mapping[str, Any]) -> float:
    """Return how many hours of a configuration of lives wear as much as one with some changes; speeds are alike.

    It is 1 where the configuration gives its load in N m: that of the test part is relative.
    """
    life = config["life"]
    histories = [own or [[1.0, 1.0]] for own in ({**life, **changes.get("life", {})}["history"], life["history"])]
    if any(len(block) > 2 for own in histories for block in own):
        return 1.0
    exponent = life["damage"]["torque_exponent"]
    wear, usual = (sum(h * ratio**exponent for h, ratio in own) / sum(h for h, _ in own) for own in histories)
    return float(wear / usual)


def joined(parts: Sequence[Inspections]) -> Inspections:
    """Return the inspections of several sets, no two of which share a number of a gearbox; without averages."""
    arrays = {
        one.name: np.concatenate([getattr(part, one.name) for part in parts])
        for one in fields(Inspections)
        if one.name not in ("indicators", "averages")
    }
    indicators = {name: np.concatenate([part.indicators[name] for part in parts]) for name in parts[0].indicators}
    return replace(parts[0], **arrays, indicators=indicators, averages=None)
