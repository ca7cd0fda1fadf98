"""Parquet files: encodings read back from the footer, bytes that depend on the rows alone, nothing half written."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.columns.record import record_batch, record_schema, signal_matrix
from siggen.dataset.shard import write_table
from siggen.dataset.storage import LocalFolder
from siggen.sets.drawn import set_columns
from tests.dataset.fake_set import fake_config, simulate

CONFIG = fake_config()
SCHEMA = record_schema(set_columns(CONFIG))
ROWS = record_batch(set_columns(CONFIG), simulate(CONFIG, range(11)))
SERIES = {
    "accel_bearing_vertical_m_s2.list.element", "accel_bearing_horizontal_m_s2.list.element", "tacho_s.list.element",
}  # fmt: skip


def written(folder: Path, batches: list[pa.RecordBatch], group_rows: int = 4) -> Path:
    write_table(LocalFolder(folder), "data/a.parquet", SCHEMA, batches, group_rows)
    return folder / "data/a.parquet"


def test_signals_are_byte_split_and_compressed_and_only_labels_have_statistics(tmp_path: Path) -> None:
    footer = pq.read_metadata(written(tmp_path, [ROWS]))
    assert [footer.row_group(g).num_rows for g in range(footer.num_row_groups)] == [4, 4, 3]
    for group in range(footer.num_row_groups):
        columns = [footer.row_group(group).column(i) for i in range(footer.num_columns)]
        for column in columns:
            is_series = column.path_in_schema in SERIES
            assert ("BYTE_STREAM_SPLIT" in column.encodings) == is_series
            assert column.compression == "ZSTD"
            assert column.is_stats_set == (not is_series)
            assert column.has_offset_index
            if is_series:
                assert not {"PLAIN", "RLE_DICTIONARY", "PLAIN_DICTIONARY"} & set(column.encodings)
        assert {column.path_in_schema for column in columns} >= SERIES


def test_every_row_and_the_schema_come_back(tmp_path: Path) -> None:
    table = pq.read_table(written(tmp_path, [ROWS]))
    assert table.schema.equals(SCHEMA, check_metadata=True)
    assert table.to_batches()[0].num_rows <= 11
    assert table.equals(pa.Table.from_batches([ROWS]))
    name = "accel_bearing_vertical_m_s2"
    assert signal_matrix(table[name]).tobytes() == signal_matrix(ROWS[name]).tobytes()


@settings(max_examples=25, deadline=None)
@given(cuts=st.lists(st.integers(0, 11), max_size=6))
def test_bytes_do_not_depend_on_how_rows_arrive(tmp_path_factory: pytest.TempPathFactory, cuts: list[int]) -> None:
    borders = [0, *sorted(cuts), 11]
    pieces = [ROWS.slice(a, b - a) for a, b in pairwise(borders)]
    folder = tmp_path_factory.mktemp("cut")
    assert written(folder, pieces).read_bytes() == written(folder / "whole", [ROWS]).read_bytes()


def test_a_shard_of_which_every_record_failed_is_an_empty_file_with_the_schema(tmp_path: Path) -> None:
    table = pq.read_table(written(tmp_path, []))
    assert table.num_rows == 0
    assert table.schema.equals(SCHEMA)


def test_rows_that_stop_coming_leave_nothing_behind(tmp_path: Path) -> None:
    def broken():
        yield ROWS
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_table(LocalFolder(tmp_path), "data/a.parquet", SCHEMA, broken(), 4)
    assert [p for p in tmp_path.rglob("*") if p.is_file()] == []
