"""ModeTable: natural modes of a user's housing as the text of a CSV file, from finite elements or a modal test.

A line per mode, ascending: `frequency_hz`, `damping_ratio`, and a column for every place and axis that counts:
`<place>_<axis>_per_sqrt_kg` holds the mass-normalised shape. Places are `pinion_bearing`, `gear_bearing`,
`auxiliary_drive` and the names of sensors; of a planetary set `sun_bearing`, `carrier_bearing` and `ring`, whose
rotation `ring_turning_per_sqrt_kg_m` holds. `base_horizontal_sqrt_kg`, `base_vertical_sqrt_kg` and
`base_rocking_sqrt_kg_m` hold participation factors, φᵀ M of a body that moves with its base.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.housing_modes import VIBRATING_HZ
from siggen.drivetrain.makers import SEATS_OF_SET
from siggen.keys.data_file import DataRefusal
from siggen.keys.problems import nearest
from siggen.names import PAIR, Names

FREQUENCY, DAMPING = "frequency_hz", "damping_ratio"
SHAPE = re.compile(r"^([A-Za-z][A-Za-z0-9_]*)_(?:(horizontal|vertical|axial)_per_sqrt_kg|(turning)_per_sqrt_kg_m)$")
DRIVE = ("auxiliary_drive/horizontal", "auxiliary_drive/vertical")
BASE = ("base_horizontal_sqrt_kg", "base_vertical_sqrt_kg", "base_rocking_sqrt_kg_m")
COLUMNS_TEXT = f"{FREQUENCY}, {DAMPING}, <place>_<horizontal, vertical or axial>_per_sqrt_kg, {', '.join(BASE)}"
MOST_NUMBERS = 100_000
"""Numbers that a table may have: they become part of the configuration, some 20 characters each."""
MOST_DAMPING = 0.5


@dataclass(frozen=True, slots=True)
class ModeTable:
    """Modes in ascending order.

    Attributes
    ----------
    frequency_hz, damping_ratio : (m,)
    shapes : place/axis -> (m,) [kg^-1/2]
    base : column of `BASE` -> (m,) participation factors
    """

    frequency_hz: FloatArray
    damping_ratio: FloatArray
    shapes: Mapping[str, FloatArray]
    base: Mapping[str, FloatArray]

    @property
    def text(self) -> str:
        """The table as the text of a CSV file; reading it gives the same numbers."""
        columns = {
            FREQUENCY: self.frequency_hz,
            DAMPING: self.damping_ratio,
            **{shape_column(place): shape for place, shape in self.shapes.items()},
            **self.base,
        }
        rows = zip(*(values.tolist() for values in columns.values()), strict=True)
        return "\n".join([",".join(columns), *(",".join(map(repr, row)) for row in rows), ""])

    @property
    def seat_masses_kg(self) -> list[float]:
        """Mass that each seat feels of the six lowest modes, which are those of a body on its feet."""
        central = SEATS_OF_SET[:-1]
        seats = [seat for seat in self.shapes if seat.partition("/")[0].endswith("_bearing") or seat in central]
        return [1.0 / max(float((self.shapes[seat][:6] ** 2).sum()), 1e-12) for seat in seats]


def seats_of(names: Names) -> tuple[str, ...]:
    """Return place/axis of the bearings of all shafts."""
    return tuple(f"{shaft.bearing}/{axis}" for shaft in names.shafts for axis in ("vertical", "horizontal"))


def shape_column(place: str) -> str:
    """Return the column of a place/axis."""
    seat, _, axis = place.partition("/")
    return f"{seat}_{axis}_per_sqrt_kg{'_m' if axis == 'turning' else ''}"


@lru_cache(maxsize=16)
def mode_table(text: str) -> ModeTable:
    """Return the modes that a CSV text holds; lines that begin with # say something to people.

    Raises
    ------
    DataRefusal
        If it holds none; names the line.
    """
    lines = list(_lines(text))
    if not lines:
        raise DataRefusal("no lines", f"allowed: a line of column names ({COLUMNS_TEXT}), then a line per mode")
    names = _names(*lines[0])
    if len(names) * (len(lines) - 1) > MOST_NUMBERS:
        raise DataRefusal(f"{len(lines) - 1} modes in {len(names)} columns", f"allowed: {MOST_NUMBERS} numbers")
    rows = [(number, _numbers(number, row, names)) for number, row in lines[1:]]
    _check_modes([(number, row[names.index(FREQUENCY)], row[names.index(DAMPING)]) for number, row in rows])
    columns = dict(zip(names, np.array([row for _, row in rows]).T.copy(), strict=True))
    return ModeTable(
        frequency_hz=columns[FREQUENCY],
        damping_ratio=columns[DAMPING],
        shapes={
            "/".join(filter(None, found.groups())): columns[name] for name in names if (found := SHAPE.match(name))
        },
        base={name: columns[name] for name in BASE if name in columns},
    )


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield number and cells of the lines that hold something."""
    reader = csv.reader(io.StringIO(text), strict=True)
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells) and not cells[0].lstrip().startswith("#"):
                yield reader.line_num, [cell.strip() for cell in cells]
    except csv.Error as error:
        raise DataRefusal(f"line {reader.line_num}: {error}", "allowed: numbers with commas between") from None


def _names(line: int, names: list[str]) -> list[str]:
    for name in names:
        known = name in {FREQUENCY, DAMPING, *BASE} or SHAPE.match(name)
        if not known:
            close = nearest(name, (FREQUENCY, DAMPING, *BASE, *map(shape_column, (*seats_of(PAIR), *DRIVE))))
            raise DataRefusal(f"line {line}: the column '{name[:100]}'", f"allowed: {COLUMNS_TEXT}{close}")
        if names.count(name) > 1:
            raise DataRefusal(f"line {line}: {names.count(name)} columns {name}", "allowed: one")
    for name in (FREQUENCY, DAMPING):
        if name not in names:
            raise DataRefusal(f"line {line}: no column {name}", f"allowed: {COLUMNS_TEXT}")
    return names


def _numbers(line: int, cells: list[str], names: list[str]) -> list[float]:
    if len(cells) != len(names):
        raise DataRefusal(f"line {line}: {len(cells)} numbers", f"allowed: {len(names)}, one per column")
    found = []
    for name, cell in zip(names, cells, strict=True):
        try:
            number = float(cell)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            allowed = "allowed: a finite number; 0 where a mode does not move a place"
            raise DataRefusal(f"line {line}: {name} '{cell[:40]}'", allowed)
        found.append(number)
    return found


def _check_modes(modes: list[tuple[int, float, float]]) -> None:
    """Refuse modes (line, frequency, damping ratio) that are none, or not in order."""
    for line, frequency, damping in modes:
        if frequency <= 0.0:
            allowed = "allowed: above 0; a housing stands on its feet, so compute or measure it there, not free"
            raise DataRefusal(f"line {line}: {FREQUENCY} {frequency:g}", allowed)
        if not 0.0 < damping < MOST_DAMPING:
            allowed = f"allowed: above 0 and below {MOST_DAMPING}, such as 0.02 for 2 %"
            raise DataRefusal(f"line {line}: {DAMPING} {damping:g}", allowed)
    for (_, lower, _), (line, frequency, _) in pairwise(modes):
        if frequency < lower:
            allowed = f"allowed: at least {lower:g}, that of the line before; sort lines by {FREQUENCY}"
            raise DataRefusal(f"line {line}: {FREQUENCY} {frequency:g}", allowed)
    if not modes or modes[0][1] >= VIBRATING_HZ:
        raise DataRefusal("no mode", f"allowed: at least one below {VIBRATING_HZ:g} Hz")
