"""Files of numbers into the configuration: measured responses, densities of noise, modes of a housing.

Measured frequency responses: from files into the configuration, so that a set stays a function of it alone.

A file has the column frequency_hz, and for every axis of the sensor and every bearing force two columns named
<axis>_from_<place>_<direction>_<part>_<unit>: real and imag in m_s2_per_n, or magnitude in m_s2_per_n and phase in rad
or deg. Places are those of sensors, in the user's words. Forces along the shafts may be left out: nothing passes then.
The sensor's name and _ may stand before them; then those of other sensors are passed over.
"""

from __future__ import annotations

import csv
import hashlib
import io
import re
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.drivetrain.makers import SEATS_OF_SET
from siggen.errors import Problem
from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable, mode_table, seats_of, shape_column
from siggen.gearbox.possible import PossibleGearbox
from siggen.keys.data_file import DataRefusal, data_file_bytes, named_content, shortened_path
from siggen.keys.problems import nearest, received_text
from siggen.noise.kinds import SOURCES
from siggen.sensing.inputs import MOTION
from siggen.sensing.responses import MEMORY_S, FrequencyResponse, curve_problems, grid_problems
from siggen.sensors.path import MeasuredPath
from siggen.sensors.response_text import SINGLE, decoded_response, encoded_response

UNIT = "m_s2_per_n"
UNITS = {"real": (UNIT,), "imag": (UNIT,), "magnitude": (UNIT,), "phase": ("rad", "deg")}
"""Units that the parts of a complex number may have."""
COLUMN = re.compile(
    r"^(vertical|horizontal|axial)_from_([A-Za-z][A-Za-z0-9_]*_bearing)_(vertical|horizontal|axial)"
    r"_(real|imag|magnitude|phase)_?(.*)$"
)
FREQUENCY = "frequency_hz"
MOST_NUMBERS = 400_000
"""Numbers that a response may have: they become part of the configuration, 11 bytes each."""


NUMBER_BYTES = 8
"""Of a number in a file of numpy."""


def with_measured_responses(raw: Mapping[str, Any], folder: Path) -> tuple[Mapping[str, Any], list[Problem]]:
    """Return a configuration's mapping with the numbers of the response files it names, and what is wrong with them.

    Parameters
    ----------
    raw : mapping, left as it is
    folder : Path from which the paths of the files count
    """
    sensors = raw.get("sensors")
    if not isinstance(sensors, Mapping):
        return raw, []
    problems: list[Problem] = []
    filled = dict(sensors)
    for name, sensor in sensors.items():
        try:
            filled[name] = _filled(str(name), sensor, folder)
        except DataRefusal as refused:
            problems.append(Problem(f"sensors.{name}.path.file", refused.received, refused.allowed))
    return {**raw, "sensors": filled}, problems


def _filled(name: str, sensor: Any, folder: Path) -> Any:
    path = sensor.get("path") if isinstance(sensor, Mapping) else None
    if not isinstance(path, Mapping) or path.get("kind", "measured") != "measured":
        return sensor
    if path.get("response") is not None:
        return sensor
    read = _family if isinstance(path.get("file"), (list, tuple)) else _response_read
    return {**sensor, "path": {**path, **read(path, folder, name)}}


def _family(path: Mapping[str, Any], folder: Path, sensor: str) -> dict[str, list[str]]:
    """Return files and responses of a path section with several files."""
    found = [_response_read({"file": name}, folder, sensor) for name in path["file"]]
    short = [encoded_response(decoded_response(one["response"]), SINGLE) for one in found]
    return {"file": [one["file"] for one in found], "response": short}


def response_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what makes the measured responses of valid sections unusable for their records."""
    config = gearbox.config
    if not gearbox.refused.isdisjoint({"fs_hz", "dynamics", "housing"}):  # which say what is needed
        return
    for sensor in config.sensors:
        if isinstance(sensor.through, MeasuredPath):
            wanted = _Wanted(sensor.axes, config.places.pressed, config.fs_hz)
            for number, text in enumerate(sensor.through.family):
                keys = (f"file.{number}", f"response.{number}") if sensor.through.is_family else ("file", "response")
                file, numbers = (f"sensors.{sensor.name}.path.{key}" for key in keys)
                yield from _text_problems(text, wanted, file, numbers)


@dataclass(frozen=True, slots=True)
class _Wanted:
    """What a response must hold: axes of its sensor, forces, band by the sampling rate [Hz]."""

    axes: tuple[str, ...]
    forces: tuple[str, ...]
    fs_hz: float


def _text_problems(text: str, wanted: _Wanted, where: str, numbers: str) -> Iterator[Problem]:
    """Yield what is wrong with one response."""
    try:
        response = decoded_response(text)
    except DataRefusal as refused:
        yield Problem(numbers, refused.received, refused.allowed)
        return
    wrong = [Problem(where, *found) for found in grid_problems(response.frequency_hz, wanted.fs_hz)]
    yield from wrong or _curves_problems(response, wanted, where)


def _curves_problems(response: FrequencyResponse, wanted: _Wanted, where: str) -> Iterator[Problem]:
    if strange := sorted(key for key in response.curves if key[1] not in wanted.forces):
        known = ", ".join(dict.fromkeys(force.split("/")[0] for force in wanted.forces))
        axis, force = strange[0]
        yield Problem(where, f"columns {axis}_from_{'_'.join(force.split('/'))}_...", f"allowed: forces of {known}")
        return
    for key in ((axis, name) for axis in wanted.axes for name in wanted.forces):
        label = f"{key[0]}_from_{'_'.join(key[1].split('/'))}"
        if key not in response.curves:
            if not key[1].endswith("/axial"):
                allowed = "allowed: two columns for every axis and bearing force; zeros where nothing passes"
                yield Problem(where, f"no columns {label}_...", allowed)
            continue
        for received, allowed in curve_problems(response, *key, MEMORY_S):
            yield Problem(where, f"{received} in {label}", allowed)


def _response_read(path: Mapping[str, Any], folder: Path, sensor: str) -> dict[str, str]:
    """Return file, sha256 and response of a path section whose numbers are still in the file."""
    name = path.get("file")
    if not isinstance(name, str):
        raise DataRefusal(received_text(name), "allowed: the path of a CSV, Parquet or npz file")
    content = named_content(name, folder)
    digest = hashlib.sha256(content).hexdigest()
    expected = path.get("sha256")
    if expected is not None and expected != digest:
        raise DataRefusal(f"'{name}' with SHA-256 {digest}", f"allowed: the file with {expected}, or leave sha256 out")
    text = encoded_response(_response(_own(_columns(content, Path(name).suffix.lower()), sensor)))
    # the folder is no part of the set: the same measurement elsewhere gives the same identity
    return {"file": Path(name).name, "sha256": digest, "response": text}


def _columns(content: bytes, ending: str) -> dict[str, FloatArray]:
    import pyarrow as pa
    import pyarrow.csv
    import pyarrow.parquet

    source = io.BytesIO(content)
    try:
        match ending:
            case ".npz":
                # half as many as the bytes could be: names and headers count as well
                _check_size(sum(one.file_size for one in zipfile.ZipFile(source).infolist()) // (2 * NUMBER_BYTES))
                source.seek(0)
                return {name: _numbers(name, values) for name, values in np.load(source, allow_pickle=False).items()}
            case ".csv":
                table = pyarrow.csv.read_csv(source)
            case ".parquet":
                extent = pyarrow.parquet.read_metadata(io.BytesIO(content))
                _check_size(extent.num_rows * extent.num_columns)
                table = pyarrow.parquet.read_table(source)
            case _:
                raise DataRefusal(f"the ending '{ending}'", "allowed: .csv, .parquet, .npz")
    except (pa.ArrowInvalid, ValueError, OSError, zipfile.BadZipFile) as error:
        raise DataRefusal(
            "a file that cannot be read", f"allowed: a {ending[1:]} file of named columns of numbers"
        ) from error
    return {name: _numbers(name, table[name].to_numpy()) for name in table.column_names}


def _check_size(numbers: int) -> None:
    """Refuse more numbers than a response may have; before they are unpacked, a small file can hold very many."""
    if numbers > MOST_NUMBERS:
        raise DataRefusal(f"{numbers} numbers", f"allowed: at most {MOST_NUMBERS}")


def _own(columns: dict[str, FloatArray], sensor: str) -> dict[str, FloatArray]:
    """Return the columns of one sensor of a file that names sensors, as `siggen inspect path` writes it; else all."""
    own = {name.removeprefix(f"{sensor}_"): v for name, v in columns.items() if COLUMN.match(name) is None}
    own = {name: values for name, values in own.items() if COLUMN.match(name) is not None}
    return {FREQUENCY: columns[FREQUENCY], **own} if own and FREQUENCY in columns else columns


def _numbers(name: str, values: NDArray[Any]) -> FloatArray:
    if values.ndim != 1 or values.dtype.kind not in "iuf":
        raise DataRefusal(f"column {name} of type {values.dtype}, shape {values.shape}", "allowed: a column of numbers")
    return values.astype(np.float64)


def _response(columns: Mapping[str, FloatArray]) -> FrequencyResponse:
    if FREQUENCY not in columns:
        raise DataRefusal(f"the columns {', '.join(columns)}"[:200], f"allowed: a column {FREQUENCY}")
    _check_size(sum(values.size for values in columns.values()))
    parts: dict[tuple[str, str], dict[str, FloatArray]] = {}
    for name, values in columns.items():
        if name == FREQUENCY:
            continue
        key, part, unit = _meaning(name)
        if values.size != columns[FREQUENCY].size:
            raise DataRefusal(f"{values.size} numbers in {name}", f"allowed: {columns[FREQUENCY].size}, as frequencies")
        parts.setdefault(key, {})[part] = np.radians(values) if unit == "deg" else values
    return FrequencyResponse(columns[FREQUENCY], {key: _complex(key, found) for key, found in parts.items()})


def _meaning(column: str) -> tuple[tuple[str, str], str, str]:
    """Return (direction, input), part and unit that a column's name says."""
    found = COLUMN.match(column)
    if found is None:
        allowed = f"allowed: {FREQUENCY}, and columns such as vertical_from_PLACE_bearing_vertical_real_{UNIT}"
        raise DataRefusal(f"the column {column}", allowed)
    direction, place, axis, part, unit = found.groups()
    if unit not in UNITS[part]:
        units = " or ".join(UNITS[part])
        raise DataRefusal(f"the column {column} with {f'the unit {unit}' if unit else 'no unit'}", f"allowed: {units}")
    return (direction, f"{place}/{axis}"), part, unit


def _complex(key: tuple[str, str], parts: Mapping[str, FloatArray]) -> NDArray[np.complex128]:
    match sorted(parts):
        case ["imag", "real"]:
            return parts["real"] + 1j * parts["imag"]
        case ["magnitude", "phase"]:
            return np.asarray(parts["magnitude"] * np.exp(1j * parts["phase"]))
    received = f"{' and '.join(sorted(parts))} of {key[0]}_from_{'_'.join(key[1].split('/'))}"
    raise DataRefusal(received, "allowed: real and imag, or magnitude and phase")


# Densities of noise from files into the configuration, so that a set stays a function of it alone.

COLUMNS = ("frequency_hz", "density")
MOST_KNOTS = 10_000


def with_density_files(raw: Mapping[str, Any], folder: Path) -> tuple[Mapping[str, Any], list[Problem]]:
    """Return a configuration's mapping with the numbers of the density files it names, and what is wrong with them.

    Parameters
    ----------
    raw : mapping, left as it is
    folder : Path from which the paths of the files count
    """
    problems: list[Problem] = []

    def filled(parent: Any, key: str, path: str, columns: tuple[str, ...] = COLUMNS) -> Any:
        table = parent.get(key) if isinstance(parent, Mapping) else None
        if not isinstance(table, Mapping) or "file" not in table:
            return parent
        numbers, problem = _density(folder / str(table["file"]), f"{path}.file", columns)
        problems.extend(problem)
        return {**parent, key: {**{k: v for k, v in table.items() if k != "file"}, **numbers}}

    found = dict(raw)
    if isinstance(sensors := raw.get("sensors"), Mapping):
        for source in (one for one in SOURCES if one.file_columns):
            key, columns = source.key, source.file_columns
            sensors = {name: filled(one, key, f"sensors.{name}.{key}", columns) for name, one in sensors.items()}
        found["sensors"] = sensors
    return found, problems


def _density(file: Path, where: str, columns: tuple[str, ...]) -> tuple[dict[str, list[float]], list[Problem]]:
    """Return the lists of a file; harmless ones with a problem if it cannot be used."""
    harmless = {column: [1.0, 2.0] for column in columns}
    least = 2 if columns == COLUMNS else 1
    allowed = f"allowed: a CSV file with the columns {', '.join(columns)}, {least} to {MOST_KNOTS} rows of numbers"
    try:
        lines = io.StringIO(data_file_bytes(file).decode("utf-8-sig"), newline="")
        rows = list(islice(csv.DictReader(lines), MOST_KNOTS + 1))
        numbers = {column: [float(row[column]) for row in rows] for column in columns}
    except OSError as error:
        return harmless, [Problem(where, f"{shortened_path(file)}: {error.strerror}", allowed)]
    except (KeyError, TypeError, ValueError, csv.Error):
        return harmless, [Problem(where, f"{file}: columns are missing, or not numbers", allowed)]
    if not least <= len(rows) <= MOST_KNOTS:
        return harmless, [Problem(where, f"{file}: {len(rows)} rows", allowed)]
    return numbers, []


# Modes of a user's housing from a file into the configuration, so that a set stays a function of it alone.

KEY = "housing.modes"


def with_mode_file(raw: Mapping[str, Any], folder: Path) -> tuple[Mapping[str, Any], list[Problem]]:
    """Return a configuration's mapping with the modes of the file that its housing names, and what is wrong with them.

    Parameters
    ----------
    raw : mapping, left as it is
    folder : Path from which the file's path counts
    """
    housing = raw.get("housing")
    if not isinstance(housing, Mapping) or housing.get("kind") != "modal":
        return raw, []
    name = housing.get("modes")
    if not isinstance(name, str) or "\n" in name:  # no path: nothing, or what a file held
        return raw, []
    try:
        # neither name nor folder is part of the set: the same modes elsewhere give the same identity
        return {**raw, "housing": {**housing, "modes": _modes(name, folder).text}}, []
    except DataRefusal as refused:
        return raw, [Problem(KEY, refused.received, refused.allowed)]


def _modes(name: str, folder: Path) -> ModeTable:
    try:
        return mode_table(named_content(name, folder).decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise DataRefusal(f"'{shortened_path(name)}', which is no text", "allowed: a CSV file in UTF-8") from None


def mode_problems(gearbox: PossibleGearbox) -> Iterator[Problem]:
    """Yield what the modes of valid sections lack for their records."""
    config = gearbox.config
    if config.housing.kind != "modal" or "\n" not in config.housing.modes:  # a file that was not read
        return
    try:
        table = mode_table(config.housing.modes)
    except DataRefusal as refused:
        yield Problem(KEY, refused.received, refused.allowed)
        return
    present = (*map(shape_column, table.shapes), *table.base)
    for column, use in _needed(gearbox).items():
        if column not in present:
            allowed = f"allowed: a column of this name, for {use}"
            yield Problem(KEY, f"no column {column}", f"{allowed}{nearest(column, present)}")


def _needed(gearbox: PossibleGearbox) -> dict[str, str]:
    """Return the columns of seats, sensors and parts of the background, and what they are for."""
    config, background = gearbox.config, gearbox.config.background
    seats = seats_of(config.names) if config.planetary is None else SEATS_OF_SET
    found = dict.fromkeys(map(shape_column, seats), "the bearing forces")
    for sensor in config.sensors:
        places = (one.name.removeprefix("casing_") for one in sensor.shown_inputs if one.kind == MOTION)
        found |= {shape_column(place): f"the sensor {sensor.name}" for place in sorted(places)}
    if background is not None and background.auxiliary_drive is not None:
        found |= dict.fromkeys(map(shape_column, DRIVE), "background.auxiliary_drive, or leave that out (null)")
    if background is not None and background.base is not None:
        found |= dict.fromkeys(BASE, "background.base, or leave that out (null)")
    return found
