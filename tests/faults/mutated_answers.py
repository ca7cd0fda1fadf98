"""Predictions and models with bytes that are wrong: each is taken or refused in words, by `score` and `predict`.

A stranger who changes a file of a model writes its hash anew, so that the file is read and not just compared.
"""

from __future__ import annotations

import os
import resource
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from random import Random

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from pyarrow import csv

import siggen
from benchmarks.row import Row
from diagnostics.base import reading_process
from diagnostics.prediction.model_facts import FACTS_FILE, MODEL_FILES, file_hashes
from diagnostics.prediction.released_model import load_model
from diagnostics.scoring.score import score
from siggen.dataset.reading import Dataset
from siggen.dataset.seal import sealed, unsealed
from tests.faults.mutations import Case, judged, mutated_bytes, outcomes_row
from tests.faults.victims import small_model, small_set

COUNT, QUICK_COUNT = 300, 30
MOST_BYTES = 1 << 30


def rows(*, quick: bool) -> Iterator[Row]:
    """Yield a row for predictions, one for models, and one for the memory of all."""
    count = QUICK_COUNT if quick else COUNT
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        victim = small_set(place / "set")
        dataset = siggen.open(victim)
        cases = mutated_predictions(count, dataset, place)
        yield outcomes_row(f"{count} mutated predictions", cases, count, "scored", "CPU beside the reader's process")
        cases = mutated_models(count, small_model(victim, place / "model"))
        yield outcomes_row(f"{count} mutated models", cases, count, "loaded", "CPU beside the reader's process")
        yield memory_row()


def memory_row() -> Row:
    """Return the most memory of this process and of those that read for it."""
    if (process := reading_process._started.pop(os.getpid(), None)) is not None:
        reading_process._stop(process)
    unit = 1 if sys.platform == "darwin" else 1024
    most = max(unit * resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return Row("memory of all of them", f"{most / 1e6:.0f} MB", "", None, "1 GiB", most <= MOST_BYTES)


def whole_predictions(dataset: Dataset, folder: Path) -> list[Path]:
    """Write predictions of a set in each form that is read."""
    labels = dataset.labels(columns=["record_id", "state"])
    records = labels["record_id"].to_numpy()
    table = pa.table({
        "record_id": records, "damage": np.sin(records), "class": labels["state"],
        "classifier": ["mine"] * records.size, "area_mm2": np.abs(np.cos(records)),
    })  # fmt: skip
    files = [folder / name for name in ("0.parquet", "1.parquet", "2.csv")]
    pq.write_table(table, files[0])
    own = table.replace_schema_metadata({b"diagnostics.identity": str(dataset.manifest["identity"]).encode()})
    pq.write_table(own, files[1], compression="zstd", row_group_size=7)
    csv.write_csv(table, files[2])
    return files


def mutated_predictions(count: int, dataset: Dataset, folder: Path, seed: int = 0) -> Iterator[Case]:
    """Yield what comes of each of `count` mutations of predictions for a set."""
    chance, files = Random(seed), whole_predictions(dataset, folder)
    contents = [file.read_bytes() for file in files]
    for number in range(count):
        file = files[number % len(files)]
        file.write_bytes(mutated_bytes(contents[number % len(files)], chance))
        yield judged(f"{number} {file.name}", lambda file=file: score(dataset, file))


def mutated_models(count: int, folder: Path, seed: int = 0) -> Iterator[Case]:
    """Yield what comes of each of `count` mutations of the files of a model, which is whole again behind each."""
    chance = Random(seed)
    files = [folder / name for name in MODEL_FILES if name.endswith((".skops", ".json", ".safetensors"))]
    files = [folder / FACTS_FILE, *(file for file in files if file.is_file())]
    facts = files[0].read_bytes()
    for number in range(count):
        file = files[number % len(files)]
        whole = file.read_bytes()
        file.write_bytes(mutated_bytes(whole, chance))
        if file.name != FACTS_FILE:
            content = {**unsealed(FACTS_FILE, facts), "files": file_hashes(folder)}
            files[0].write_bytes(sealed(content))
        yield judged(f"{number} {file.name}", lambda: load_model(folder))
        file.write_bytes(whole)
        files[0].write_bytes(facts)
