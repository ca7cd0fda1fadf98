"""Files of arrays and samples that say little about themselves: NumPy, MATLAB, WAV, text and Parquet."""

from __future__ import annotations

import re
import warnings
import zipfile
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, numbered, refuse_many, refuse_twice
from siggen.errors import UsageError

SEPARATORS = ("\t", ";", ",")
COMMENTS = ("#", "%")

UNIT = re.compile(r"[\[(].*[\])]|(m/s(2|²|\^2|\*\*2)|g|[mµu]?V|[mµun]?s|sec|k?Hz|-|)", re.IGNORECASE)
"""Cell of a row of units: anything in brackets, or one of the units that an acceleration or its time comes in."""

IDENTITY = b"siggen.identity"
"""Key of the schema's metadata in every file that siggen writes."""


def read_csv(path: Path) -> Columns:
    """Read a text file; with semicolons or tabs a comma is a decimal comma.

    Lines that start with # or % and empty ones above the first row are skipped, and below a line of names one line of
    units.

    Raises
    ------
    UsageError
        If it holds no samples, a cell is not a number, rows differ in length or two columns have one name.
    """
    import pyarrow as pa
    from pyarrow import csv

    try:
        lines = _first_lines(path)
        if not lines:
            raise UsageError(f"{path}: holds no samples: nothing but comments or empty lines")
        first = lines[0][1]
        separator = next((mark for mark in SEPARATORS if mark in first), ",")
        decimal = "," if separator != "," and any("," in text for _, text in lines[1:]) else "."
        refuse_many(path, first.count(separator) + 1)
        rows = [_cells(text, separator) for _, text in lines]
        named = not all(_is_number(cell, decimal) for cell in rows[0])
        above = int(named) + int(named and len(rows) > 1 and _are_units(rows[1], len(rows[0]), decimal))
        if above == len(rows):
            raise UsageError(f"{path}: holds no samples, only a header ({first})")
        names = rows[0] if named else [str(k) for k in range(1, len(rows[0]) + 1)]
        refuse_twice(path, names)
        table = csv.read_csv(
            path,
            read_options=csv.ReadOptions(column_names=names, skip_rows=lines[above][0]),
            parse_options=csv.ParseOptions(delimiter=separator),
            convert_options=csv.ConvertOptions(decimal_point=decimal, column_types=dict.fromkeys(names, pa.float64())),
        )
    except (UnicodeDecodeError, pa.ArrowInvalid) as error:
        raise UsageError(
            f"{path}: cannot be read as a table of numbers ({error}); one row per sample, please, and text "
            f"above the names begins with {' or '.join(COMMENTS)}"
        ) from error
    filled = (np.asarray(column.to_numpy(), dtype=np.float64) for column in table.columns)
    units = {name: unit.strip("[]() ") for name, unit in zip(names, rows[1], strict=True)} if above == 2 else {}
    columns = dict(zip(names, filled, strict=True))
    return Columns(columns, units={name: unit for name, unit in units.items() if unit not in ("", "-")})


def _first_lines(path: Path) -> list[tuple[int, str]]:
    """Return up to three lines that hold something, with their number from zero: names, units, first samples."""
    with path.open(encoding="utf-8-sig") as file:
        numbered = ((number, line.rstrip("\r\n")) for number, line in enumerate(file))
        held = ((number, text) for number, text in numbered if text.strip() and not text.startswith(COMMENTS))
        return list(islice(held, 3))


def _cells(text: str, separator: str) -> list[str]:
    return [cell.strip().strip('"') for cell in text.split(separator)]


def _are_units(cells: list[str], columns: int, decimal: str) -> bool:
    """Return whether a row holds units only, one at least; a row with any number or word is for the reader to judge."""
    return (
        len(cells) == columns
        and any(cells)
        and not any(_is_number(cell, decimal) for cell in cells)
        and all(UNIT.fullmatch(cell) for cell in cells)
    )


def _is_number(cell: str, decimal: str) -> bool:
    try:
        float(cell.replace(decimal, "."))
    except ValueError:
        return False
    return True


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
        schema = parquet.read_schema(path)
        refuse_twice(path, schema.names)
        lists = [field.name for field in schema if _is_list(field.type)]
        numbers = [
            field.name for field in schema if pa.types.is_floating(field.type) or pa.types.is_integer(field.type)
        ]
        table = parquet.read_table(path, columns=lists or numbers)
    except (OSError, pa.ArrowInvalid) as error:
        raise UsageError(f"{path}: cannot be read as Parquet ({error})") from error
    about: Any = {"simulated": IDENTITY in (schema.metadata or {}), **_channels(schema)}
    if not lists:
        return Columns({name: _numbers(table.column(name).combine_chunks()) for name in numbers}, **about)
    chosen = 0 if row is None and table.num_rows == 1 else row
    if chosen is None or not 0 <= chosen < table.num_rows:
        raise UsageError(
            f"{path}: holds {table.num_rows} records, one per row; received row {row}. Choose one as "
            f"{path.name}:ROW, from 0 to {table.num_rows - 1}."
        )
    return Columns({name: _numbers(table.column(name)[chosen].values) for name in lists}, **about)


def _channels(schema: Any) -> dict[str, dict[str, str]]:
    """Return the columns of channels, and their units, of fields that say which sensor and axis they are."""
    said = {field.name: {k: v.decode(errors="replace") for k, v in (field.metadata or {}).items()} for field in schema}
    facts = {name: found for name, found in said.items() if {b"sensor", b"axis", b"unit"} <= found.keys()}
    own = {f"{found[b'sensor']}_{found[b'axis']}": name for name, found in facts.items()}
    return {"own": own, "units": {name: found[b"unit"] for name, found in facts.items()}}


def _is_list(kind: Any) -> bool:
    import pyarrow as pa

    listed = pa.types.is_list(kind) or pa.types.is_large_list(kind) or pa.types.is_fixed_size_list(kind)
    return bool(listed and (pa.types.is_floating(kind.value_type) or pa.types.is_integer(kind.value_type)))


def _numbers(array: Any) -> np.ndarray:
    return np.asarray(array.to_numpy(zero_copy_only=False), dtype=np.float64)


def read_mat(path: Path) -> Columns:
    """Read the numeric vectors and matrices of a MAT file; structures, cells and text are passed over.

    Raises
    ------
    UsageError
        If it cannot be read, or is of version 7.3, which is another format.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        found = loadmat(path)
    except NotImplementedError as error:
        raise UsageError(f"{path}: is a MAT file of version 7.3; save it with `save(..., '-v7')`") from error
    except (MatReadError, ValueError, OSError) as error:
        raise UsageError(f"{path}: cannot be read as a MAT file ({error})") from error
    values: dict[str, np.ndarray] = {}
    for name, array in found.items():
        is_array = not name.startswith("__") and isinstance(array, np.ndarray)
        if is_array and array.ndim == 2 and array.dtype.kind in "biuf" and array.size > 1:
            values |= numbered(array, name)
    return Columns(values)


def read_wav(path: Path) -> Columns:
    """Read the channels of a WAV file, called "1", "2" ...

    Raises
    ------
    UsageError
        If it is not one.
    """
    from scipy.io import wavfile

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # chunks of notes that are passed over
            fs_hz, samples = wavfile.read(path)
    except (ValueError, OSError, EOFError) as error:
        raise UsageError(f"{path}: cannot be read as WAV ({error})") from error
    if samples.dtype.kind == "f":
        return Columns(numbered(samples), float(fs_hz))
    middle = 128.0 if samples.dtype == np.uint8 else 0.0  # 8-bit WAV is unsigned
    # 24 bits come shifted up into 32, so that the type's range is the full scale in every case
    scale = 128.0 if samples.dtype == np.uint8 else float(np.iinfo(samples.dtype).max) + 1.0
    return Columns(numbered((samples.astype(np.float64) - middle) / scale), float(fs_hz), full_scale=True)


def read_numpy(path: Path) -> Columns:
    """Read the arrays of a NumPy file.

    Raises
    ------
    UsageError
        If it is not one, or holds objects (which only unpickling could read) or arrays of more than two dimensions.
    """
    try:
        found = np.load(path, allow_pickle=False)
        if isinstance(found, np.ndarray):
            return Columns(numbered(found))
        with found as archive:
            arrays = {name: archive[name] for name in archive.files}
        values: dict[str, np.ndarray] = {}
        for name, array in arrays.items():
            if array.size > 1:  # a single number is a note, such as the rate, not a signal
                values |= numbered(array, name)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        why = "it holds objects, or is no NumPy file" if "pickle" in str(error) else error
        raise UsageError(
            f"{path}: cannot be read as arrays of numbers ({why}); save float arrays with numpy.save or numpy.savez"
        ) from error
    return Columns(values)
