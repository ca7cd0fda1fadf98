"""The questions that a benchmark can ask, told apart by its configuration; and the predictions of its baselines."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyarrow import parquet

from diagnostics.base.extras import require_packages
from diagnostics.base.single_thread import single_thread
from diagnostics.bench.damage_question import DAMAGE_QUESTION
from diagnostics.bench.life_question import LIFE_QUESTION
from diagnostics.bench.question import Question
from diagnostics.scoring.benchmark import BASELINES, open_benchmark
from diagnostics.scoring.prediction_file import IDENTITY_KEY, PREDICTIONS_FILE
from siggen.file_writing import write_file


def question_of(config: Mapping[str, Any]) -> Question:
    """Return what a benchmark with this configuration to learn from asks: of lives how long they last."""
    return DAMAGE_QUESTION if config.get("life") is None else LIFE_QUESTION


@single_thread()
def benchmark_baselines(folder: str | Path, seed: int = 0, workers: int = 1) -> Path:
    """Learn the baselines on the part to learn from, write what they say of all test parts; return the file."""
    require_packages("baselines", "sklearn")
    benchmark = open_benchmark(folder)
    rows = list(question_of(benchmark.learn().config).predictions(benchmark, seed, workers))
    table = pa.concat_tables(rows).replace_schema_metadata({IDENTITY_KEY: benchmark.digest.encode()})
    path = benchmark.path / BASELINES / PREDICTIONS_FILE
    write_file(path, lambda draft: parquet.write_table(table, draft, compression="zstd"))
    return path
