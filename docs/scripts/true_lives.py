"""The true state as an entry of a benchmark of lives: `python docs/scripts/true_lives.py BENCH sealed.json ENTRY`.

Writes the quantiles of `outlook`, which are sealed, as an entry for `siggen-diagnostics bench board`: no model can know
more than the true state of a gearbox.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pyarrow as pa
from pyarrow import parquet

from diagnostics.scoring.benchmark import open_benchmark
from diagnostics.scoring.remaining_life import COLUMNS
from diagnostics.scoring.sealed_labels import labelled, labels_of
from diagnostics.training.life_baselines import OUTLOOK


def main() -> None:
    """Write the entry."""
    benchmark, entry = open_benchmark(Path(sys.argv[1])), Path(sys.argv[3])
    labels = labels_of(benchmark, Path(sys.argv[2]))
    parts = [labelled(benchmark.part(name), labels, name).life("outlook", "test") for name in benchmark.parts]
    told = pa.concat_tables([one.select(["record_id", "rul_q10_h", "rul_q50_h", "rul_q90_h"]) for one in parts])
    told = told.rename_columns(["record_id", *COLUMNS])
    entry.parent.mkdir(parents=True, exist_ok=True)
    parquet.write_table(told.append_column("classifier", pa.array([OUTLOOK] * len(told))), entry)
    print(f"{entry}: {len(told)} gearboxes")


if __name__ == "__main__":
    main()
