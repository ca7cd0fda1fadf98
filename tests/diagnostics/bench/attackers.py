"""Numbers of published records as somebody takes them who wants their labels and may look at everything published."""

from __future__ import annotations

import zlib
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

import siggen
from siggen.dataset.reading import as_record

SIGNAL = "signal: "
"""Begins the names of numbers that damage may move."""


def attackers(folder: Path, *, blind: bool = True) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return the numbers of the records to tell, (n,), and what attackers make of each, (n,) by name.

    Of a blind part these are the split test; the split train has references.
    """
    dataset = siggen.open(folder)
    rows = [as_record(batch.slice(k, 1)) for batch in dataset.records() for k in range(batch.num_rows)]
    references = {row["specimen_id"]: row for row in rows if row["split"] == "train" and blind}
    tests = [row for row in rows if row["split"] == "test" or not blind]
    columns = [channel.column for channel in dataset.channels]
    files = {
        path.name: pq.ParquetFile(path)
        for path in sorted((folder / "data").glob("test-*.parquet" if blind else "*.parquet"))
    }
    sizes = np.concatenate([_group_bytes(file) for file in files.values()])
    found: dict[str, list[float]] = {}

    def tell(name: str, value: float) -> None:
        found.setdefault(name, []).append(float(value))

    for place, row in enumerate(tests):
        reference = references.get(row["specimen_id"], row)
        own = sorted(one["record_id"] for one in tests if one["specimen_id"] == row["specimen_id"])
        _tell_keys(tell, row, place, own.index(row["record_id"]), reference["record_id"])
        tell(f"{SIGNAL}bytes of its row group", sizes[place])
        for name, value in row.items():
            if isinstance(value, int | float) and not isinstance(value, bool) and np.isfinite(value):
                tell(f"column {name}", value)
                tell(f"last bits of {name}", np.float64(value).view(np.int64) % 256)
            elif isinstance(value, str):
                tell(f"length of {name}", len(value))
        _tell_signals(tell, row, columns, reference)
    return np.array([row["record_id"] for row in tests]), {name: np.array(values) for name, values in found.items()}


def _tell_keys(tell, row, place: int, order: int, reference: int) -> None:  # type: ignore[no-untyped-def]
    number = row["record_id"]
    for name, value in {
        "place in the file": place,
        "place in its row group": place % 16,
        "row group": place // 16,
        "parity of the number": number % 2,
        "number modulo 4": number % 4,
        "number modulo 5": number % 5,
        "bits of the number": bin(number).count("1"),
        "digits of the number": sum(map(int, str(number))),
        "order among records of its gearbox": order,
        "distance from its reference": number - reference,
        "CRC of the number": zlib.crc32(str(number).encode()),
    }.items():
        tell(name, value)


def _tell_signals(tell, row, columns: list[str], reference) -> None:  # type: ignore[no-untyped-def]
    pulses = row["tacho_s"]
    tell(f"{SIGNAL}pulses", pulses.size)
    tell(f"{SIGNAL}first pulse", pulses[0])
    tell(f"{SIGNAL}last pulse", pulses[-1])
    tell(f"{SIGNAL}jitter of pulses", np.std(np.diff(pulses, 2)) if pulses.size > 2 else 0.0)
    for name in columns:
        values = np.asarray(row[name], dtype=np.float64)
        for what, value in {
            "first sample": values[0],
            "last sample": values[-1],
            "mean": values.mean(),
            "rms": values.std(),
            "peak": np.abs(values).max(),
            "kurtosis": (values**4).mean() / (values**2).mean() ** 2,
            "bytes compressed": len(zlib.compress(row[name].tobytes(), 1)),
            "CRC": zlib.crc32(row[name].tobytes()),
            "zeros": np.count_nonzero(values == 0.0),
            "values twice": values.size - np.unique(values).size,
            "noise, roughness": np.std(np.diff(values, 4)),
            "noise, quietest block": min(block.std() for block in np.array_split(values, 64)),
            "likeness to the reference": np.corrcoef(values, reference[name])[0, 1] if reference is not row else 0.0,
            "level over the reference": values.std() / np.std(reference[name]),
        }.items():
            tell(f"{SIGNAL}{what} of {name}", value)


def permuted_within(positive: np.ndarray, gearbox: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return labels, (n,), in another order within each gearbox."""
    order = np.lexsort((rng.uniform(size=gearbox.size), gearbox))
    found = np.empty_like(positive)
    found[np.argsort(gearbox, kind="stable")] = positive[order]
    return found


def _group_bytes(file: pq.ParquetFile) -> np.ndarray:
    groups = [file.metadata.row_group(k) for k in range(file.metadata.num_row_groups)]
    sizes = [sum(group.column(k).total_compressed_size for k in range(group.num_columns)) for group in groups]
    return np.repeat(sizes, [group.num_rows for group in groups])
