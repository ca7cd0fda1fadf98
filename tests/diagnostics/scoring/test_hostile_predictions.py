"""Files of predictions as a stranger may send them: scored or refused in words, without a hang or much memory."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import siggen
from siggen.errors import UsageError
from tests.command import command
from tests.diagnostics.cli.test_bad_sets import good_set

__all__ = ("good_set",)
Write = Callable[[Path, pa.Table], object]


def written(change: Callable[[pa.Table], pa.Table]) -> Write:
    return lambda path, table: pq.write_table(change(table), path)


def renamed(table: pa.Table) -> pa.Table:
    doubled = table.append_column("second", table["damage"])
    return doubled.rename_columns(["record_id", "damage", "damage"])


def short_and_misspelt(table: pa.Table) -> pa.Table:
    """Give a probability of one class only, under a name that is none, and leave out a record."""
    half = pa.array(np.full(table.num_rows, 0.5))
    return table.append_column("p_healthy", half).append_column("p_sevre", half).slice(1)


def bomb(path: Path, _table: pa.Table) -> None:
    """Write a file of a hundred kilobytes that claims 40 million rows."""
    group = pa.table({"record_id": pa.array(np.zeros(4_000_000, np.int64)), "damage": np.zeros(4_000_000)})
    with pq.ParquetWriter(path, group.schema, compression="zstd") as file:
        for _ in range(10):
            file.write_table(group, row_group_size=4_000_000)


def long_text(path: Path, table: pa.Table) -> None:
    """Write one text of 8 MB in all of 100 000 rows: 800 GB where each row had its own."""
    rows = 100_000
    names = pa.DictionaryArray.from_arrays(pa.array(np.zeros(rows, np.int32)), pa.array(["x" * 8_000_000]))
    pq.write_table(pa.table({"record_id": np.arange(rows), "classifier": names}), path, compression="zstd")


def wrong_text(path: Path, table: pa.Table) -> None:
    wrong = pa.Array.from_buffers(
        pa.string(), table.num_rows, [None, pa.py_buffer(np.arange(table.num_rows + 1, dtype=np.int32)),
                                      pa.py_buffer(b"\xff" * table.num_rows)],
    )  # fmt: skip
    pq.write_table(table.append_column("classifier", wrong), path)


def with_classifier(names: Callable[[int], list[object]]) -> Write:
    return written(lambda table: table.append_column("classifier", pa.array(names(table.num_rows))))


HOSTILE: dict[str, tuple[Write, str]] = {
    "a record and a class missing": (written(short_and_misspelt), "column p_sevre is of no class"),
    "a doubled column": (written(renamed), "the column damage is there more than once"),
    "a bomb": (bomb, "40000000 rows of 2 columns"),
    "one long text": (long_text, "longer than any names"),
    "a text that is none": (wrong_text, "UTF"),
    "metadata that is no text": (
        written(lambda table: table.replace_schema_metadata({b"diagnostics.identity": b"\xff\xfe\x1b"})),
        "holds predictions of the set",
    ),
    "classes that are no text": (
        written(lambda table: table.replace_schema_metadata({b"diagnostics.classes": b"\xff\x1b"})),
        "its classes are",
    ),
    "empty classifiers": (with_classifier(lambda rows: [None] * rows), "allowed: a name in each row"),
    "a classifier for each row": (with_classifier(lambda rows: [f"c{k}" for k in range(rows)]), "records missing"),
    "nested numbers": (
        written(lambda table: table.set_column(1, "damage", pa.array([[1.0]] * table.num_rows))),
        "damage is nan",
    ),
    "no rows": (written(lambda table: table.slice(0, 0)), "missing"),
    "a pipe": (lambda path, _: os.mkfifo(path), "allowed: a regular file"),
    "a folder": (lambda path, _: path.mkdir(), "allowed: a regular file"),
    "nothing": (lambda path, _: None, "no such file"),
    "no bytes": (lambda path, _: path.write_bytes(b""), "is empty (0 bytes); allowed: a row per record"),
    "a beginning": (lambda path, _: path.write_bytes(b"PAR1" + bytes(20)), "is no Parquet file, or a damaged one"),
    "ragged lines": (
        lambda path, _: path.with_suffix(".csv").write_text("record_id,damage\n3,0.5\n4,0.5,1\n"),
        "is no table; received 3 values under 2 names: 4,0.5,1; allowed: names in the first line",
    ),
    "an empty line": (lambda path, _: path.with_suffix(".csv").write_text("\n"), "is no table; allowed: names in"),
}


@pytest.fixture
def predictions(good_set: Path) -> pa.Table:
    records = siggen.open(good_set).labels(columns=["record_id"])["record_id"].to_pylist()
    return pa.table({"record_id": records, "damage": [float(record) for record in records]})


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_file_is_refused_in_words(what: str, good_set: Path, predictions: pa.Table, tmp_path: Path) -> None:
    write, words = HOSTILE[what]
    file = tmp_path / "mine.parquet"
    write(file, predictions)
    plain = file.with_suffix(".csv")
    done = command("diagnostics", "score", str(good_set), str(plain if plain.exists() else file))
    assert done.returncode == 2, done.stderr
    assert not re.search("unexpected|Arrow|CSV|Error", done.stderr)
    assert "\x1b" not in done.stderr
    assert words in done.stderr


def test_whole_numbers_name_classifiers_too(good_set: Path, predictions: pa.Table, tmp_path: Path) -> None:
    file = tmp_path / "mine.parquet"
    both = pa.concat_tables([predictions.append_column("classifier", pa.array([k] * len(predictions))) for k in (7, 8)])
    pq.write_table(both, file)
    done = command("diagnostics", "score", str(good_set), str(file))
    assert done.returncode == 0, done.stderr
    assert "\n  7 " in done.stdout
    assert "7 minus this" in done.stdout


def test_columns_given_in_python_are_held_to_the_same(good_set: Path, predictions: pa.Table) -> None:
    import diagnostics

    with pytest.raises(UsageError, match="predictions: the column damage is there more than once"):
        diagnostics.score(siggen.open(good_set), renamed(predictions))
