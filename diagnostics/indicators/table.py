"""One table of everything that is taken of the records of a set, from one pass by any number of workers.

`report`, `indicators`, `audit` and the card read named sets of its columns (`classifier_table`,
`ranking_table`, `audit.measured_set`). Values do not depend on the number of workers: records are handed out in the
order of the files and come back in it. Functions of the user are called anew each time, since their code may change.

Where the table of a set is kept: `DIR_table/` beside the set's folder, one Parquet file per settings and channels. Of a
part of a benchmark, which is published as a whole: `BENCH_table/PART/` beside the benchmark.

A file's name carries what its numbers depend on: the set (digest of its manifest, size and time of its files), the
source code of signals, records and indicators, the settings, the channels. So nothing has to be declared out of date;
files of another state of the set are deleted where a new one is written. The folder can be deleted at any time.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from diagnostics.base.beside import beside
from diagnostics.base.progress import Advance
from diagnostics.indicators.line_levels import LEVELS
from diagnostics.indicators.own_indicator import OwnIndicator, named_once, own_columns
from diagnostics.indicators.record import RecordResult, record_result
from diagnostics.indicators.registry import IndicatorColumn, check_quantity, columns, indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.workers import mapped
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import PAIR, GearNames, in_column
from diagnostics.records.recording import Recording, label_names, names_of, pair_teeth, recordings
from diagnostics.records.sample_bytes import BYTES
from diagnostics.records.usable_records import RecordProblem
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import write_file

CODE = ("signal", "records", "indicators")
DIGITS = 12
WHOLE = "benchmark.json"
"""Lies one or two folders above the parts of a benchmark."""

PULSE_CONDITIONS = ("pulses_per_s", "speed_variation_percent", "start_turn")
SAMPLE_CONDITIONS = ("checksum", "samples", *BYTES)
COMPLEX = pa.list_(pa.float32())


def table_file(dataset: Dataset, settings: IndicatorSettings, channels: Sequence[str]) -> Path | None:
    """Return the file of a set's table, whether it exists or not; None for a set that is no folder.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    settings : IndicatorSettings
        How values are taken.
    channels : sequence of str
        Channels of the table.
    """
    folder = Path(dataset.path)
    if not (folder / "manifest.json").is_file():
        return None
    folder = folder.resolve()
    files = sorted(name for name in dataset.files if name.startswith(("data/", "labels.")))
    facts = [(name, *_stat(folder / name)) for name in files]
    state = _digest([dataset.manifest, facts, _code_digest()])
    chosen = _digest([asdict(settings), list(channels)])
    return _table_folder(folder) / f"{state}-{chosen}.parquet"


def _table_folder(folder: Path) -> Path:
    whole = next((one for one in folder.parents[:2] if (one / WHOLE).is_file()), folder)
    return beside(whole, "_table") / folder.relative_to(whole)


def _stat(path: Path) -> tuple[int, int]:
    try:
        found = path.stat()
    except OSError:  # reading the set says which file is missing, and what to do
        return 0, 0
    return found.st_size, found.st_mtime_ns


def _digest(content: Any) -> str:
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:DIGITS]


@lru_cache(maxsize=1)
def _code_digest() -> str:
    """Return the digest of the code that makes the numbers: another version of it never takes over old ones."""
    package = Path(__file__).resolve().parents[1]
    files = sorted(file for folder in CODE for file in (package / folder).glob("*.py"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def is_readable(path: Path) -> bool:
    """Return whether a table lies there as it was written; one that was changed since is computed again."""
    try:
        return _hash_file(path).read_text(encoding="ascii") == _sha256(path)
    except (OSError, UnicodeDecodeError):
        return False


def keep_table(table: pa.Table, path: Path) -> str:
    """Write a table and delete those of other states of the set; return why it could not be kept, or an empty text."""

    def fill(draft: Path) -> None:
        pq.write_table(table, draft, compression="zstd")
        write_file(_hash_file(path), _sha256(draft))

    try:
        write_file(path, fill)
        for other in path.parent.glob("*-*.parquet"):
            if other.name.split("-")[0] != path.name.split("-")[0]:
                other.unlink(missing_ok=True)
                _hash_file(other).unlink(missing_ok=True)
    except (OSError, UsageError) as error:
        return f"the table of indicators could not be kept ({error}); the next command computes it again"
    return ""


def _hash_file(path: Path) -> Path:
    return path.with_suffix(".sha256")


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@dataclass(frozen=True, slots=True)
class RecordTable:
    """Everything that was taken of the records of a set.

    Attributes
    ----------
    source : pyarrow.Table or Path
        One row per record, in memory or as Parquet.
    settings : IndicatorSettings
    channels : tuple of str
    own : dict of str to (records,) float64
        Columns of the user's indicators.
    own_problems : tuple of RecordProblem
        Where those failed.
    note : str
        Why the table could not be kept on disk, or empty.
    quantities : dict of str to str
        What channels hold.
    named : GearNames
        What columns are called after.
    label_names : tuple of str
        Columns that go along.
    teeth : (str, str)
        Those with the teeth of the first and the last gear of the first mesh.
    """

    source: pa.Table | Path
    settings: IndicatorSettings
    channels: tuple[str, ...]
    label_names: tuple[str, ...]
    teeth: tuple[str, str]
    own: dict[str, np.ndarray] = field(default_factory=dict)
    own_problems: tuple[RecordProblem, ...] = ()
    note: str = ""
    quantities: dict[str, str] = field(default_factory=dict)
    named: GearNames = PAIR

    def select(self, names: Sequence[str]) -> pa.Table:
        """Return the named columns."""
        if isinstance(self.source, Path):
            return pq.read_table(self.source, columns=list(names))
        return self.source.select(list(names))

    def labels(self) -> dict[str, np.ndarray]:
        """Return the label columns, (records,) each."""
        return {name: np.asarray(column.to_pylist()) for name, column in _named(self.select(self.label_names)).items()}

    @property
    def columns(self) -> dict[str, IndicatorColumn]:
        """What its columns hold, without the channel's name."""
        return indicator_columns(self.settings, self.named)

    def values(self, names: Sequence[str]) -> np.ndarray:
        """Return the named columns as numbers, (records, columns), the user's among them; NaN where undefined.

        Raises
        ------
        UsageError
            If an indicator is not taken of what its channel holds.
        """
        for name in names:
            check_quantity(name, self.columns, self.quantities)
        table = _named(self.select([name for name in names if name not in self.own]))
        found = [self.own[name] if name in self.own else _numbers(table[name]) for name in names]
        return np.stack(found, axis=1) if found else np.empty((self.rows, 0))

    @property
    def rows(self) -> int:
        """Number of records."""
        return int(self.select(["record_id"]).num_rows)

    def texts(self, name: str) -> list[Any]:
        """Return what a column of texts or lists holds, record by record: `problems`, `refused`, `clipped`, `notes`."""
        rows = self.select([name]).column(name).to_pylist()
        return rows if name == "notes" else [json.loads(text) for text in rows]

    def complex_rows(self, name: str) -> list[list[np.ndarray]]:
        """Return waveforms or sketches, (k,) complex64 by record and channel."""
        table = self.select([f"{name}.{channel}" for channel in self.channels])
        columns = [[np.asarray(row.values, np.float32).view(np.complex64) for row in found] for found in table.columns]
        return [list(row) for row in zip(*columns, strict=True)]

    def moments(self, channel: str) -> dict[str, np.ndarray]:
        """Return what indicators with a history need of a channel, (records,) each by name."""
        schema = pq.read_schema(self.source) if isinstance(self.source, Path) else self.source.schema
        start, end = "moment.", f"__{channel}"
        stored = [name for name in schema.names if name.startswith(start) and name.endswith(end)]
        found = _named(self.select(stored))
        return {name.removeprefix(start).removesuffix(end): _numbers(found[name]) for name in stored}

    def names(self) -> tuple[str, ...]:
        """Return all indicators of one record by column, the user's last."""
        per_channel = [
            f"{name}__{channel}"
            for channel in self.channels
            for name in columns(self.settings, self.quantities.get(channel, RECORDED.word), self.named)
        ]
        return (*per_channel, *self.own)


def revolution_columns(named: GearNames) -> tuple[str, str]:
    """Return the columns with the revolutions of the first and the last gear of the first mesh that were averaged."""
    gears = named[0].gears
    return f"revolutions_{in_column(gears[0])}", f"revolutions_{in_column(gears[-1])}"


def _named(table: pa.Table) -> dict[str, pa.ChunkedArray]:
    return dict(zip(table.column_names, table.columns, strict=True))


def _numbers(column: pa.ChunkedArray) -> np.ndarray:
    return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)


def record_table(
    dataset: Dataset,
    settings: IndicatorSettings | None = None,
    own: Sequence[OwnIndicator] = (),
    *,
    workers: int = 1,
    advance: Advance | None = None,
) -> RecordTable:
    """Return the table of a set, as kept beside it or from one pass over its records.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    settings : IndicatorSettings, optional
        Default: `IndicatorSettings()`.
    own : sequence of OwnIndicator
        The user's.
    workers : int
        Processes; 1 computes in this one.
    advance : callable, optional
        Called after every record of a pass.

    Raises
    ------
    DatasetError
        If the set holds no records.
    UsageError
        If two indicators have one name, or one has the name of a column.
    """
    chosen, mine = settings or IndicatorSettings(), named_once(own)
    channels = tuple(channel.name for channel in dataset.channels)
    every = tuple(str(channel["name"]) for channel in dataset.manifest.get("channels", ()))
    files = [table_file(dataset, chosen, names) for names in dict.fromkeys((every, channels)) if names]
    kept = next((file for file in files if file is not None and is_readable(file)), None)
    note, source = "", kept
    if kept is None:
        source = _computed(dataset, chosen, channels, workers, advance)
        note = keep_table(source, files[-1]) if files and files[-1] is not None else ""
    held = {channel.name: channel.quantity for channel in dataset.channels}
    labels, teeth, named = label_names(dataset), pair_teeth(dataset), names_of(dataset)
    table = RecordTable(source, chosen, channels, labels, teeth, note=note, quantities=held, named=named)
    if taken := sorted({one.name for one in mine} & table.columns.keys()):
        raise UsageError(f"indicators: {', '.join(taken)}: names of columns that the set has already; choose others")
    pulses = [np.asarray(row.values, np.float64) for row in table.select(["pulses_s"]).column("pulses_s")]
    refused = table.texts("refused")
    found, problems = own_columns(dataset, mine, pulses, refused, workers=workers, advance=advance if kept else None)
    return replace(table, own=found, own_problems=tuple(problems))


def _computed(
    dataset: Dataset, settings: IndicatorSettings, channels: tuple[str, ...], workers: int, advance: Advance | None
) -> pa.Table:
    results = list(_results(dataset, settings, workers, advance))
    if not results:
        raise DatasetError(f"{dataset.path}: no records to take indicators of; received splits {list(dataset.splits)}")
    held = {channel.name: channel.quantity for channel in dataset.channels}
    return _as_table(results, settings, {name: held[name] for name in channels}, dataset)


def _results(
    dataset: Dataset, settings: IndicatorSettings, workers: int, advance: Advance | None
) -> Iterator[RecordResult]:
    for result in mapped(recordings(dataset), partial(_record_result, settings), workers):
        yield result
        if advance:
            advance()


def _record_result(settings: IndicatorSettings, record: Recording) -> RecordResult:
    """Return the result of one record; a function that other processes can take."""
    return record_result(record, settings)


def _as_table(
    results: list[RecordResult], settings: IndicatorSettings, held: Mapping[str, str], dataset: Dataset
) -> pa.Table:
    named, labels = names_of(dataset), label_names(dataset)
    found: dict[str, Any] = {name: [result.labels[name] for result in results] for name in labels}
    found |= {name: [result.revolutions[k] for result in results] for k, name in enumerate(revolution_columns(named))}
    found |= {
        "notes": [result.shaft_notes for result in results],
        "problems": [json.dumps([(p.channel, p.text) for p in result.problems]) for result in results],
        "refused": [json.dumps(result.refused) for result in results],
        "clipped": [json.dumps(result.clipped) for result in results],
        "pulses_s": pa.array([result.pulses_s for result in results], pa.list_(pa.float64())),
        **{name: [float(result.conditions[name]) for result in results] for name in PULSE_CONDITIONS},
    }
    for channel, quantity in held.items():
        names = columns(settings, quantity, named)
        found |= _channel_columns([result.channels[channel] for result in results], names, channel)
    return pa.table(found)


def _channel_columns(results: list[Any], names: Sequence[str], channel: str) -> dict[str, Any]:
    found: dict[str, Any] = {
        f"{name}__{channel}": _finite([own.values.get(name, np.nan) for own in results], keep_infinite=name in LEVELS)
        for name in (*names, *LEVELS)
    }
    moments = dict.fromkeys(name for own in results for name in own.moments)
    found |= {f"moment.{name}__{channel}": [own.moments.get(name, np.nan) for own in results] for name in moments}
    found |= {f"{name}.{channel}": [own.conditions[name] for own in results] for name in SAMPLE_CONDITIONS}
    for name in ("waveform", "sketch"):
        rows = [np.ascontiguousarray(getattr(own, name), np.complex64).view(np.float32) for own in results]
        found[f"{name}.{channel}"] = pa.array(rows, COMPLEX)
    return found


def _finite(values: list[float], *, keep_infinite: bool) -> np.ndarray:
    """Return values with everything infinite undefined, but for levels: minus infinity says that no line is there."""
    found = np.asarray(values, dtype=np.float64)
    return found if keep_infinite else np.where(np.isfinite(found), found, np.nan)
