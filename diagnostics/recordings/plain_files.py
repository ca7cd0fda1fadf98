"""Files of arrays and samples: NumPy, MATLAB, WAV and Parquet."""

from __future__ import annotations

import io
import warnings
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, as_numbers, numbered, refuse_twice
from diagnostics.recordings.recorder_files import (
    UNITS,
    StatedSignal,
    read_hdf5,
    stated_columns,
    stated_rate_hz,
)
from siggen.errors import UsageError

IDENTITY, RATE, SIGNAL = b"siggen.identity", b"fs_hz", b"signal"
"""Key of the schema's metadata in every file that siggen writes."""
MOST_DEPTH = 8
"""Of structures within structures in a MAT file."""


def read_parquet(path: Path, row: int | None = None) -> Columns:
    """Read the numeric columns of a Parquet file.

    Parameters
    ----------
    path : Path
        The file.
    row : int, optional
        Which record, from zero, where every cell holds a list.

    Raises
    ------
    UsageError
        If it is not one, or the row is missing or not there.
    """
    import pyarrow as pa
    from pyarrow import parquet

    try:
        with parquet.ParquetFile(path) as file:
            schema = file.schema_arrow
            refuse_twice(path, schema.names)
            audio = [field.name for field in schema if _is_audio(field.type)]
            lists = [field.name for field in schema if _is_list(field.type) and _is_signal(field)]
            numbers = [field.name for field in schema if _is_number(field.type) or pa.types.is_timestamp(field.type)]
            table = file.read([*audio, *lists] or numbers, use_threads=False)
    except (OSError, pa.ArrowInvalid) as error:
        raise UsageError(f"{path}: cannot be read as Parquet: it is none, or damaged") from error
    facts = schema.metadata or {}
    about: Any = {"simulated": IDENTITY in facts, "layout": {"format": "Parquet"}}
    if about["simulated"] and RATE in facts:
        about["fs_hz"] = float(facts[RATE])
    about |= _channels(schema)
    if not (lists or audio):
        return Columns({name: _numbers(table.column(name).combine_chunks()) for name in numbers}, **about)
    chosen = 0 if row is None and table.num_rows == 1 else row
    if chosen is None or not 0 <= chosen < table.num_rows:
        raise UsageError(
            f"{path}: holds {table.num_rows} records, one per row; received row {row}. Choose one as "
            f"{path.name}:ROW, from 0 to {table.num_rows - 1}."
        )
    if audio:
        return _audio(path, {name: table.column(name)[chosen].as_py() or {} for name in audio})
    return Columns({name: _numbers(table.column(name)[chosen].values) for name in lists}, **about)


def _audio(path: Path, cells: Mapping[str, Mapping[str, Any]]) -> Columns:
    """Return audio cells: an array with its rate, or a WAV file within the cell."""
    signals, scaled = [], False
    for name, cell in cells.items():
        content = cell.get("bytes")
        if content:
            found = _wav(path, io.BytesIO(content))
            many = len(found.values) > 1
            scaled |= found.full_scale
            for part, values in found.values.items():
                signals.append(StatedSignal((f"{name}:{part}" if many else name,), values, found.fs_hz))
        elif cell.get("array") is not None:
            values = np.asarray(cell["array"], dtype=np.float64)
            signals.append(StatedSignal((name,), values, float(cell.get("sampling_rate") or 0.0) or None))
    return stated_columns(signals, "Parquet", full_scale=scaled)


def _is_audio(kind: Any) -> bool:
    import pyarrow as pa

    if not pa.types.is_struct(kind):
        return False
    names = {kind.field(k).name for k in range(kind.num_fields)}
    return {"array", "sampling_rate"} <= names or {"bytes", "path"} <= names


def _is_number(kind: Any) -> bool:
    import pyarrow as pa

    return bool(pa.types.is_floating(kind) or pa.types.is_integer(kind) or pa.types.is_boolean(kind))


def _channels(schema: Any) -> dict[str, dict[str, str]]:
    """Return the columns of channels, and their units, of fields that say which sensor and axis they are."""
    said = {field.name: {k: v.decode(errors="replace") for k, v in (field.metadata or {}).items()} for field in schema}
    facts = {name: found for name, found in said.items() if {b"sensor", b"axis", b"unit"} <= found.keys()}
    own = {f"{found[b'sensor']}_{found[b'axis']}": name for name, found in facts.items()}
    clocks = {field.name: "s" for field in schema if str(field.type).startswith("timestamp")}
    return {"own": own, "units": clocks | {name: found[b"unit"] for name, found in facts.items()}}


def _is_signal(field: Any) -> bool:
    """Return whether a field is a signal; those of siggen say what they are, such as which teeth are damaged."""
    return bool((field.metadata or {}).get(b"role", SIGNAL) == SIGNAL)


def _is_list(kind: Any) -> bool:
    import pyarrow as pa

    listed = pa.types.is_list(kind) or pa.types.is_large_list(kind) or pa.types.is_fixed_size_list(kind)
    return bool(listed and (pa.types.is_floating(kind.value_type) or pa.types.is_integer(kind.value_type)))


def _numbers(array: Any) -> np.ndarray:
    """Return a column as numbers; times of a calendar in seconds from the first one."""
    import pyarrow as pa
    import pyarrow.compute as pc

    if pa.types.is_timestamp(array.type):
        ticks = array.cast(pa.int64())
        unit = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[array.type.unit]
        return as_numbers(pc.subtract(ticks, ticks[0])) * unit
    return as_numbers(array)


def read_mat(path: Path) -> Columns:
    """Read the vectors and matrices of numbers of a MAT file, those in structures and cells as `a.b`.

    A single number called as a rate or a step is one, for what lies beside and below it; so is a text called unit.

    Raises
    ------
    UsageError
        If it cannot be read, or h5py is missing for version 7.3.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        found = loadmat(path, simplify_cells=True)
    except NotImplementedError:
        return read_hdf5(path)
    except (MatReadError, ValueError, OSError) as error:
        raise UsageError(f"{path}: cannot be read as a MAT file ({error})") from error
    held = {name: value for name, value in found.items() if not name.startswith("__")}
    return stated_columns(list(_tree_signals(held)), "MAT 5")


def _tree_signals(
    tree: Mapping[str, Any], prefix: str = "", rate_hz: float | None = None, unit: str | None = None, depth: int = 0
) -> Iterator[StatedSignal]:
    """Yield the signals of structures, each with the rate and unit that stand nearest."""
    stated = {name.lower(): value for name, value in tree.items()}
    rate_hz = stated_rate_hz(stated) or rate_hz
    said = next((stated[name] for name in UNITS if isinstance(stated.get(name), str)), None)
    unit = said or unit
    for name, item in tree.items():
        long, value = f"{prefix}{name}", item
        if isinstance(value, (list, tuple)):
            value = {str(k): part for k, part in enumerate(value, start=1)}
        elif isinstance(value, np.ndarray) and value.dtype == object and value.ndim <= 2:
            value = {str(k): part for k, part in enumerate(value.ravel().tolist(), start=1)}
        if isinstance(value, Mapping):
            if depth < MOST_DEPTH:
                yield from _tree_signals(value, f"{long}.", rate_hz, unit, depth + 1)
        elif isinstance(value, np.ndarray) and value.ndim in (1, 2) and value.dtype.kind in "biuf" and value.size > 1:
            for called, signal in numbered(value, long).items():
                yield StatedSignal((called,), signal, rate_hz, unit)


def read_wav(path: Path) -> Columns:
    """Read the channels of a WAV file, called "1", "2" ...

    Raises
    ------
    UsageError
        If it is not one.
    """
    return _wav(path, path)


def _wav(path: Path, source: Path | BinaryIO) -> Columns:
    from scipy.io import wavfile

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # chunks of notes that are passed over
            fs_hz, samples = wavfile.read(source)
    except (ValueError, OSError, EOFError) as error:
        raise UsageError(f"{path}: cannot be read as WAV ({error})") from error
    layout = {"format": "WAV"}
    if samples.dtype.kind == "f":
        return Columns(numbered(samples), float(fs_hz), layout=layout)
    middle = 128.0 if samples.dtype == np.uint8 else 0.0  # 8-bit WAV is unsigned
    # 24 bits come shifted up into 32, so that the type's range is the full scale in every case
    scale = 128.0 if samples.dtype == np.uint8 else float(np.iinfo(samples.dtype).max) + 1.0
    values = numbered((samples.astype(np.float64) - middle) / scale)
    return Columns(values, float(fs_hz), full_scale=True, layout=layout)


def read_numpy(path: Path) -> Columns:
    """Read the arrays of a NumPy file.

    Raises
    ------
    UsageError
        If it is not one, or holds objects (which only unpickling could read) or arrays of more than two dimensions.
    """
    try:
        with path.open("rb") as file:  # a broken archive would stay open
            found = np.load(file, allow_pickle=False)
            if isinstance(found, np.ndarray):
                return Columns(numbered(found), layout={"format": "NumPy"})
            with found as archive:
                arrays = {name: archive[name] for name in archive.files}
        if wrong := [name for name, array in arrays.items() if array.size > 1 and array.ndim > 2]:
            raise ValueError(f"array {wrong[0]} has {arrays[wrong[0]].ndim} dimensions")
        # a single number is a note, such as the rate, not a signal
        notes = {name: array.item() if array.ndim == 0 else array for name, array in arrays.items()}
        signals = list(_tree_signals(notes))
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        why = "it holds objects, or is no NumPy file" if "pickle" in str(error) else error
        raise UsageError(
            f"{path}: cannot be read as arrays of numbers ({why}); save float arrays with numpy.save or numpy.savez"
        ) from error
    return stated_columns(signals, "NumPy")
