"""The one way in which a table with texts becomes CSV: fit for spreadsheets, which take some texts for formulas.

A text that begins with =, +, -, @, a tab or a line break is run as a formula where a spreadsheet opens it, whoever made
it up: a file's name, a state's, a column of a recording. Such a text gets an apostrophe in front, by which a
spreadsheet shows it as it is (OWASP, CSV injection). Numbers stay as they are. All texts stand in quotes.
"""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv

from siggen.file_writing import write_file

OPENS_A_FORMULA = r"^([=+\-@\t\r\n])"


def write_csv(table: pa.Table, path: Path | str) -> None:
    """Write a table as CSV in which no text is taken for a formula.

    Parameters
    ----------
    table : pyarrow.Table
        Of numbers and texts.
    path : path

    Raises
    ------
    UsageError
        If it cannot be written.
    """
    columns = [_guarded(column) for column in table.columns]
    names = [_guarded(pa.array([name]))[0].as_py() for name in table.column_names]
    write_file(Path(path), lambda draft: pyarrow.csv.write_csv(pa.table(columns, names=names), draft))


def _guarded(column: pa.ChunkedArray | pa.Array) -> pa.ChunkedArray | pa.Array:
    """Return texts that no spreadsheet takes for formulas; other columns as they are."""
    if pa.types.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    if not (pa.types.is_string(column.type) or pa.types.is_large_string(column.type)):
        return column
    return pc.replace_substring_regex(column, pattern=OPENS_A_FORMULA, replacement=r"'\1")
