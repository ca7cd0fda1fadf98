"""Tables as CSV: texts that a spreadsheet would run are shown, numbers are numbers."""

from __future__ import annotations

import csv
from pathlib import Path

import pyarrow as pa

import siggen


def test_texts_that_begin_a_formula_are_guarded_and_numbers_are_not(tmp_path: Path) -> None:
    texts = ["=1+1", "+A1", "-2", "@SUM(A1)", "\t=1", "healthy", ""]
    table = pa.table({"=cmd": texts, "value": [-1.5, 2.0, 3.0, -4.0, 5.0, 6.0, 7.0]})
    siggen.write_csv(table, tmp_path / "table.csv")
    with (tmp_path / "table.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["'=cmd", "value"]
    assert [row[0] for row in rows] == ["'=1+1", "'+A1", "'-2", "'@SUM(A1)", "'\t=1", "healthy", ""]
    assert [float(row[1]) for row in rows] == table["value"].to_pylist()
