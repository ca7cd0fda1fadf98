"""Text files of loggers: which lines are samples, what parts cells, which mark stands in decimals, what columns are.

The layout that makes most cells of lines in the middle numbers is taken; the block of such lines is the recording.
Names and units are looked for above it, notes below it are left out. Every decision is kept, to be shown.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from diagnostics.recordings.recorded_columns import Columns, as_numbers, refuse_many
from diagnostics.recordings.units import known_unit
from siggen.errors import UsageError, counted

LAYOUTS = tuple((mark, decimal) for mark in ("\t", ";", "|", ",", " ", "") for decimal in (".", ","))
SHOWN = {"\t": "tab", ";": "semicolon", "|": "stroke", ",": "comma", " ": "blanks", "": "none"}
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.IGNORECASE)
DATE = r"(?P<date>\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{2,4})"
CLOCK = (
    r"(?:(?P<hours>\d{1,3}):(?P<minutes>\d{2}):(?P<seconds>\d{2})(?:[.,:](?P<parts>\d{1,9}))?|"
    r"(?P<long>\d{1,3}):(?P<short>\d{2})[.,](?P<rest>\d{1,9}))"
    r"\s*(?P<half>[AaPp][Mm])?\s*(?:Z|UTC|[+-]\d{2}:?\d{2})?"
)
STAMP = re.compile(rf"(?:{DATE}[T ]\s*)?{CLOCK}")
ONLY_DATE = re.compile(DATE)
COMMENTS = ("#", "%", "//", "!")
SAMPLE, FEWEST, HEAD = 60, 3, 5
LINES_IN_A_ROW = 3
DAY_S = 86_400.0
MOST_HEAD = 5_000

_RATE = re.compile(
    r"(?:sampl\w*|rate|freq\w*|\bfs\b|abtast\w*)[^0-9\n]{0,30}?(?P<number>\d+(?:[.,]\d+)?)\s*(?P<kilo>k?)(?:hz|s/s|sps)?\b",
    re.IGNORECASE,
)


class TextLayout(NamedTuple):
    """What parts cells, and the decimal mark."""

    separator: str
    decimal: str


class TextBlock(NamedTuple):
    """Lines of samples, `lines[start:end]`; their cells, and which columns hold numbers, stamps or nothing."""

    layout: TextLayout
    start: int
    end: int
    kinds: tuple[str, ...]


def read_text(path: Path) -> Columns:
    """Read a text file of any of the usual layouts.

    Raises
    ------
    UsageError
        If it is none, or holds no samples; if text stands among numbers, a name stands twice, or a comma may be
        separator or decimal mark. Names line and column.
    """
    text, encoding = decoded(path)
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    notes: list[str] = []
    whole = lines.pop() == "" if lines else True
    if lines and lines[0].lower().startswith("sep="):
        lines[0] = ""
    if not any(line.strip() and not line.startswith(COMMENTS) for line in lines):
        raise UsageError(f"{path}: holds no samples: nothing but comments or empty lines")
    if not whole:
        notes.append("the last line has no end and may be cut: left out")
    block = _block(path, lines)
    names, units, head = _named(path, lines, block)
    block, names = _unambiguous(path, lines, block, names)
    left = sum(bool(line.strip()) for line in lines[: block.start]) - head
    if left > 0:
        notes.append(f"{counted(left, 'line')} above the names or samples left out")
    if behind := len(lines) - block.end:
        notes.append(f"{counted(behind, 'line')} behind the data left out")
    values, stamped = _values(path, lines, block, names)
    held, kept_units = _kept(path, values, names, units, notes)
    kept_units |= {name: "s" for name in held if name in stamped}
    is_lvm = lines[0].startswith("LabVIEW Measurement")
    stated, y_units = _lvm_facts(lines[: block.start], list(held)) if is_lvm else (None, {})
    shown = {
        "format": "LVM" if is_lvm else "text",
        "encoding": encoding,
        "separator": SHOWN[block.layout.separator],
        "decimal mark": "comma" if block.layout.decimal == "," else "point",
    }
    hint = None if is_lvm else _rate_hint(lines[: block.start])
    rate = None if any(name.lower() == "x_value" for name in held) else stated
    return Columns(held, rate, units=y_units | kept_units, layout=shown, notes=tuple(notes), hint_hz=hint)


def decoded(path: Path) -> tuple[str, str]:
    """Return the text of a file, and its encoding.

    Raises
    ------
    UsageError
        If it is none.
    """
    content = path.read_bytes()
    for mark, encoding in ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16")):
        if content.startswith(mark):
            odd = len(content) % 2 if encoding == "utf-16" else 0
            return content[: len(content) - odd].decode(encoding, "replace"), encoding.replace("-sig", " with mark")
    zeros = content[:4096].count(0), content[1:4096:2].count(0)
    if zeros[0] > 0.2 * len(content[:4096]):
        encoding = "utf-16-le" if zeros[1] > 0.5 * zeros[0] else "utf-16-be"
        return content[: len(content) & ~1].decode(encoding, "replace"), encoding
    if b"\x00" in content:
        raise UsageError(f"{path}: cannot be read as text: it holds bytes of zero; is it damaged, or another format?")
    try:
        return content.decode("utf-8"), "utf-8"
    except UnicodeDecodeError as error:
        if error.start >= len(content) - 3:
            return content[: error.start].decode("utf-8"), "utf-8"
        return content.decode("cp1252", "replace"), "windows-1252"


def split_cells(line: str, separator: str) -> list[str]:
    """Return the cells of a line."""
    if separator == " ":
        return line.replace('"', "").split()
    if separator == "":
        return [line.strip().strip('"')]
    if '"' in line:
        try:
            return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True))]
        except (csv.Error, StopIteration):
            pass
    return [cell.strip() for cell in line.split(separator)]


def _kind(cell: str, decimal: str) -> str:
    """Return number, blank, stamp, date or text."""
    if not cell:
        return "blank"
    if decimal == "," and "." in cell and "," not in cell and NUMBER.fullmatch(cell):
        return "text"  # in a file of decimal commas a point marks thousands, or a mixture
    if NUMBER.fullmatch(cell.replace(",", ".") if decimal == "," else cell):
        return "number"
    if STAMP.fullmatch(cell):
        return "stamp"
    return "date" if ONLY_DATE.fullmatch(cell) else "text"


def _block(path: Path, lines: list[str]) -> TextBlock:
    """Return the lines of samples and their layout."""
    held = [k for k, line in enumerate(lines) if line.strip() and not line.lstrip().startswith(COMMENTS)]
    if not held:
        raise UsageError(f"{path}: holds no samples: nothing but comments or empty lines")
    # lines of the middle are samples, whatever stands above and below; of a short file the last ones
    first = max(0, len(held) // 2 - SAMPLE // 2) if len(held) > 2 * SAMPLE else len(held) // 2
    sample = [lines[k] for k in held[first : first + SAMPLE]]
    best: tuple[float, int, TextLayout, tuple[str, ...]] | None = None
    for separator, decimal in LAYOUTS:
        layout = TextLayout(separator, decimal)
        kinds, share = _sampled(sample, layout)
        if share > 0.0 and not (separator and len(kinds) == 1):
            rank = (round(share, 3), len(kinds) if separator != "" else 1)
            if best is None or rank > best[:2]:
                best = (*rank, layout, kinds)
    if best is None:
        shown = next((lines[k] for k in held), "")[:60]
        raise UsageError(
            f"{path}: holds no samples, only a header ({shown}); cannot be read as a table of numbers: one row per "
            "sample, please"
        )
    _, _, layout, kinds = best
    refuse_many(path, len(kinds))
    good = partial(_is_sample, layout=layout, kinds=kinds)
    start = next((k for k in held if _run(lines, held, k, good, 1)), None)
    end = next((k for k in reversed(held) if _run(lines, held, k, good, -1)), None)
    if start is None or end is None or sum(good(lines[k]) for k in held[-2 * SAMPLE :]) < 1:
        raise UsageError(
            f"{path}: holds no samples, no three lines with {len(kinds)} numbers each; cannot be read as a table of "
            "numbers: one row per sample, please"
        )
    return TextBlock(layout, start, end + 1, kinds)


def _run(lines: list[str], held: list[int], at: int, good: partial[bool], step: int) -> bool:
    """Return whether a line and those behind it (or before it) are samples."""
    place = int(np.searchsorted(held, at))
    chosen = held[place : place + LINES_IN_A_ROW] if step > 0 else held[max(0, place - LINES_IN_A_ROW + 1) : place + 1]
    return len(chosen) == min(LINES_IN_A_ROW, len(held)) and all(good(lines[k]) for k in chosen)


def _sampled(sample: Sequence[str], layout: TextLayout) -> tuple[tuple[str, ...], float]:
    """Return the kinds of columns that a layout gives lines, and the share of cells it explains; 0 if it cannot be."""
    rows = [split_cells(line, layout.separator) for line in sample]
    size, often = Counter(len(row) for row in rows).most_common(1)[0]
    same = [row for row in rows if len(row) == size]
    if often < min(LINES_IN_A_ROW, len(rows)) or often < 0.6 * len(rows):
        return (), 0.0
    columns = [Counter(_kind(row[k], layout.decimal) for row in same) for k in range(size)]
    kinds = tuple(_column_kind(counts) for counts in columns)
    if "number" not in kinds:
        return (), 0.0
    cells = sum(kinds[k] in ("number", "stamp", "date") for k in range(size))
    filled = sum(kind != "blank" for kind in kinds)
    return kinds, often / len(rows) * cells / filled


def _column_kind(counts: Counter[str]) -> str:
    filled = {kind: number for kind, number in counts.items() if kind != "blank"}
    if not filled:
        return "blank"
    kind = max(filled, key=lambda one: filled[one])
    return kind if filled[kind] >= 0.8 * sum(filled.values()) else "text"


def _is_sample(line: str, layout: TextLayout, kinds: tuple[str, ...]) -> bool:
    cells = split_cells(line, layout.separator)
    if len(cells) != len(kinds):
        return False
    found = [_kind(cell, layout.decimal) for cell in cells]
    return "number" in found and all(
        kind in (wanted, "blank") or wanted == "text" for kind, wanted in zip(found, kinds, strict=True)
    )


def _named(path: Path, lines: list[str], block: TextBlock) -> tuple[list[str], list[str], int]:
    """Return names and units of the columns, empty where there are none, and how many lines they took."""
    size = len(block.kinds)
    plain = [""] * size
    first = [split_cells(line, block.layout.separator)[0] for line in lines[block.start : block.start + 2]]
    counted_rows = len(first) == 2 and all(cell.isdigit() for cell in first) and int(first[1]) - int(first[0]) == 1
    rows: list[tuple[int, list[str]]] = []
    for k in range(block.start - 1, max(-1, block.start - 1 - MOST_HEAD), -1):
        line = lines[k].strip("\n")
        if not line.strip() or not re.search(r"\w|[°%]", line):
            if rows:
                break
            continue
        row = _header_row(line, block, counted_rows=counted_rows)
        if row is None:
            if rows or not line.startswith(COMMENTS):
                break
            continue
        if any(_kind(cell, ".") == "number" for cell in row) and any(_kind(cell, ".") == "text" for cell in row):
            bad = next(k for k, cell in enumerate(row) if _kind(cell, ".") == "text")
            if not rows and block.layout.separator != " ":
                raise UsageError(
                    f"{path}: cannot be read as a table of numbers: line {k + 1}, column {bad + 1}: "
                    f"{row[bad][:40]!r} is no number; delete the line, or mark it as a note with #"
                )
            break
        rows.append((k, row))
        if len(rows) == HEAD or lines[k].startswith(COMMENTS):
            break
    if not rows:
        counted_off = split_cells(lines[block.start], block.layout.separator)
        return _numbers_as_names(counted_off) or plain, plain, 0
    units = next((row for _, row in rows[:2] if _are_units(row)), None)
    names = [row for _, row in rows if not _are_units(row)]
    nearest = [row for _, row in rows[: 3 if units else 2] if not _are_units(row)]
    mixed = [k for k, row in rows[:1] if units is None and len(names) > 1 and any(map(known_unit, row))]
    if (mixed or len(nearest) > 1) and block.layout.separator != " " and size > 1:
        listed = " and ".join(str(k + 1) for k, row in sorted(rows)[-len(nearest) :])
        raise UsageError(
            f"{path}: cannot be read as a table of numbers: lines {listed} could both be names of the columns; delete "
            "one, or mark it as a note with #"
        )
    if names:
        where = next(k for k, row in rows if row is names[0])
        doubled = Counter(name for name in names[0] if name)
        if again := [name for name, times in doubled.items() if times > 1 and name.lower() != "x_value"]:
            places = [str(k + 1) for k, name in enumerate(names[0]) if name == again[0]]
            raise UsageError(
                f"{path}: line {where + 1}: {doubled[again[0]]} columns are called {again[0]} (columns "
                f"{', '.join(places)}); rename them in the file"
            )
    return (names[0] if names else plain), (units or plain), bool(names) + bool(units)


def _header_row(line: str, block: TextBlock, *, counted_rows: bool = False) -> list[str] | None:
    """Return the cells of a line above the samples that has one for each column."""
    size, text = len(block.kinds), line
    for mark in COMMENTS:
        if line.startswith(mark):
            text = line.lstrip(mark)
    if "***" in text or (size <= 2 and re.search(r"[:=]", text)):
        return None
    # a column that is always empty, such as behind the last separator, need not be named
    full = size if block.kinds[-1] != "blank" else size - 1
    order = dict.fromkeys((block.layout.separator, "\t", ";", ",", " "))
    for separator in order:
        cells = split_cells(text, separator)
        if len(cells) in (size, full):
            return [*cells, *[""] * (size - len(cells))] if any(cells) else None
        if counted_rows and len(cells) == full - 1 and separator == block.layout.separator:
            return ["", *cells, *[""] * (size - full)]
    return None


def _numbers_as_names(row: list[str]) -> list[str]:
    """Return a first row that counts the columns: these are their names, not samples."""
    return (
        row
        if len(row) > 2 and row in ([str(k) for k in range(len(row))], [str(k + 1) for k in range(len(row))])
        else []
    )


def _are_units(row: list[str]) -> bool:
    """Return whether a row holds units only, one known at least."""
    filled = [cell for cell in row if cell and cell != "-"]
    bracketed = [cell for cell in filled if re.fullmatch(r"[\[(].*[\])]", cell)]
    return any(map(known_unit, filled)) and all(known_unit(cell) or cell in bracketed for cell in filled)


def _unambiguous(path: Path, lines: list[str], block: TextBlock, names: list[str]) -> tuple[TextBlock, list[str]]:
    """Refuse commas that may stand in decimals as well as between cells; one column of them is read as such."""
    if block.layout.separator != "," or len(block.kinds) < 2:
        return block, names
    rows = [split_cells(line, ",") for line in lines[block.start : block.start + SAMPLE] if line.strip()]
    cells = [cell for row in rows for cell in row if cell]
    if not all(re.fullmatch(r"[+-]?\d+", cell) for cell in cells) or any(names):
        half = [_header_row(lines[k], TextBlock(block.layout, 0, 0, block.kinds[::2])) for k in range(block.start)[-1:]]
        whole = all(re.fullmatch(r"[+-]?\d+", cell) for cell in cells)
        if not (whole and len(block.kinds) % 2 == 0 and half and half[0] and not any(names)):
            return block, names
    behind = [row[k] for row in rows for k in range(1, len(row), 2) if row[k]]
    signed = any(cell[0] in "+-" for cell in behind)
    if signed or len(block.kinds) % 2:
        return block, names
    padded = any(len(cell) > 1 and cell[0] == "0" for cell in behind)
    if len(block.kinds) == 2 and (padded or block.start):
        kept = _header_row(lines[block.start - 1], TextBlock(block.layout, 0, 0, ("number",))) if block.start else None
        return TextBlock(TextLayout("", ","), block.start, block.end, ("number",)), kept or [""]
    raise UsageError(
        f"{path}: line {block.start + 1}: a comma stands between whole numbers only: it may be separator or decimal "
        "mark. Save the file with semicolons between the cells, or with names above the columns"
    )


def _values(
    path: Path, lines: list[str], block: TextBlock, names: list[str]
) -> tuple[list[np.ndarray | None], set[str]]:
    """Return the columns, None for those of text, and the names of those that were stamps."""
    import pyarrow as pa
    from pyarrow import csv as arrow

    first = block.start + bool(_numbers_as_names(split_cells(lines[block.start], block.layout.separator)))
    rows = lines[first : block.end]
    mark, size = block.layout.separator or "\x1f", len(block.kinds)
    if block.layout.separator == " ":
        rows = [" ".join(line.split()) for line in rows]
    text = "\n".join(rows) + "\n"
    if re.search(r"\d[dD][+-]?\d", rows[0]):
        text = re.sub(r"(?<=[\d.])[dD](?=[+-]?\d)", "E", text)
    if "+" in text:
        text = re.sub(r"(?<![eE\d])\+(?=[\d.,])", "", text)
    called = [str(k) for k in range(size)]
    kinds = {str(k): pa.float64() if kind == "number" else pa.string() for k, kind in enumerate(block.kinds)}
    try:
        table = arrow.read_csv(
            io.BytesIO(text.encode()),
            read_options=arrow.ReadOptions(column_names=called, use_threads=False),
            parse_options=arrow.ParseOptions(delimiter=mark),
            convert_options=arrow.ConvertOptions(decimal_point=block.layout.decimal, column_types=kinds),
        )
    except pa.ArrowInvalid as error:
        raise UsageError(
            _first_bad(path, lines, first, block, names) or f"{path}: cannot be read as lines of numbers"
        ) from error
    found: list[np.ndarray | None] = []
    stamped = set()
    for k, kind in enumerate(block.kinds):
        if kind == "number":
            found.append(as_numbers(table.column(k).combine_chunks()))
        elif kind == "stamp":
            found.append(stamps_s(path, names[k] or str(k + 1), table.column(k).to_pylist(), first))
            stamped.add(names[k] or str(k + 1))
        else:
            found.append(None)
    return found, stamped


def _first_bad(path: Path, lines: list[str], first: int, block: TextBlock, names: list[str]) -> str:
    """Return the sentence on the first line that is none of samples."""
    for k in range(first, block.end):
        line = lines[k]
        if not line.strip() or _is_sample(line, block.layout, block.kinds):
            continue
        cells = split_cells(line, block.layout.separator)
        if len(cells) != len(block.kinds):
            return (
                f"{path}: cannot be read as a table of numbers: line {k + 1} has {counted(len(cells), 'cell')}, those "
                f"around it {len(block.kinds)} ({line.strip()[:60]!r})"
            )
        bad = next(
            (n for n, cell in enumerate(cells) if _kind(cell, block.layout.decimal) not in (block.kinds[n], "blank")), 0
        )
        return (
            f"{path}: cannot be read as a table of numbers: line {k + 1}, column {names[bad] or bad + 1}: "
            f"{cells[bad][:40]!r} is no number; delete all lines before or behind it"
        )
    return ""


def stamps_s(path: Path, name: str, cells: Sequence[str], first: int = 0) -> np.ndarray:
    """Return clock stamps and date-times (n,) as seconds; a change of date, or a clock that wraps, is one day.

    Raises
    ------
    UsageError
        If a cell is no stamp; names its line.
    """
    found, day, last_date, before = np.empty(len(cells)), 0, None, -math.inf
    for k, cell in enumerate(cells):
        parts = STAMP.fullmatch((cell or "").strip())
        if parts is None:
            raise UsageError(f"{path}: line {first + k + 1}, column {name}: {(cell or '')[:40]!r} is no time of day")
        got = parts.groupdict()
        if got["long"]:
            seconds = 60.0 * int(got["long"]) + float(f"{got['short']}.{got['rest']}")
        else:
            seconds = 3600.0 * int(got["hours"]) + 60.0 * int(got["minutes"])
            seconds += float(f"{got['seconds']}.{got['parts'] or '0'}")
        if got["half"]:
            hours = int(got["hours"] or 0)
            seconds += 43_200.0 * ((got["half"][0] in "pP") - (hours == 12))
        if got["date"] is None and seconds < before - 0.5 * DAY_S:
            day += 1
        day += last_date is not None and got["date"] != last_date
        last_date, before = got["date"], seconds
        found[k] = seconds + DAY_S * day
    return found


def _kept(
    path: Path, values: list[np.ndarray | None], names: list[str], units: list[str], notes: list[str]
) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Return columns of numbers by name, and their units; equal ones of one name count once, empty ones not."""
    held: dict[str, np.ndarray] = {}
    stated: dict[str, str] = {}
    for k, column in enumerate(values):
        name = names[k] or str(k + 1)
        if column is None or not np.isfinite(column).any():
            if names[k]:
                notes.append(f"column {name[:40]} holds no numbers: left out")
            continue
        if name in held:
            if not np.array_equal(held[name], column):
                raise UsageError(f"{path}: two times: columns called {name} differ; save one time for all channels")
            continue
        last = int(np.flatnonzero(np.isfinite(column))[-1]) + 1
        held[name] = column[:last]
        if units[k] and units[k] != "-":
            stated[name] = units[k].strip("[]() ")
    return held, stated


def _lvm_facts(head: list[str], names: list[str]) -> tuple[float | None, dict[str, str]]:
    """Return rate and units of the header of a LabVIEW measurement."""
    rate, units = None, {}
    for line in head:
        cells = [cell.strip() for cell in re.split(r"\t|;|,(?=[A-Za-z])", line)]
        if cells[0] == "Delta_X" and len(cells) > 1:
            step = cells[1].replace(",", ".")
            rate = 1.0 / float(step) if NUMBER.fullmatch(step) and float(step) > 0.0 else None
        if cells[0] == "Y_Unit_Label":
            channels = [name for name in names if name.lower() != "x_value"]
            units = {name: unit for name, unit in zip(channels, cells[1:], strict=False) if unit}
    if rate is not None and abs(round(rate) / rate - 1.0) < 1e-6:
        rate = float(round(rate))
    return rate, units


def _rate_hint(head: list[str]) -> float | None:
    """Return the rate that a header may state in words; it is never taken without being asked for."""
    for line in head:
        if found := _RATE.search(line):
            return float(found["number"].replace(",", ".")) * (1000.0 if found["kilo"] else 1.0)
    return None
