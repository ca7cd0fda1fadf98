"""Tables as bytes: encodings read back from the footer, bytes that follow from the rows, what a shard says it is."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.columns.record import record_batch, record_schema, signal_matrix
from siggen.dataset import shard
from siggen.dataset.shard import PackedTable, about_of, packed, promised, unpacked
from siggen.errors import VerificationError
from siggen.sets.drawn import set_columns
from tests.dataset.fake_set import fake_config, simulate

CONFIG = fake_config()
SCHEMA = record_schema(set_columns(CONFIG))
ROWS = pa.Table.from_batches([record_batch(set_columns(CONFIG), simulate(CONFIG, range(11)))])
SERIES = {
    "accel_bearing_vertical_m_s2.list.element", "accel_bearing_horizontal_m_s2.list.element", "tacho_s.list.element",
}  # fmt: skip


def test_signals_are_byte_split_and_compressed_and_only_labels_have_statistics() -> None:
    footer = pq.read_metadata(pa.BufferReader(packed(ROWS)))
    assert [footer.row_group(g).num_rows for g in range(footer.num_row_groups)] == [11]
    columns = [footer.row_group(0).column(i) for i in range(footer.num_columns)]
    for column in columns:
        is_series = column.path_in_schema in SERIES
        assert ("BYTE_STREAM_SPLIT" in column.encodings) == is_series
        assert column.compression == "ZSTD"
        assert column.is_stats_set == (not is_series)
        assert column.has_offset_index
        if is_series:
            assert not {"PLAIN", "RLE_DICTIONARY", "PLAIN_DICTIONARY"} & set(column.encodings)
    assert {column.path_in_schema for column in columns} >= SERIES


def test_every_row_and_the_schema_come_back_and_written_again_give_the_same_bytes() -> None:
    for rows in (ROWS, ROWS.slice(0, 0)):
        content = packed(rows, {"shard": "train-00000", "größe": [1, None]})
        table = unpacked(content)
        assert table.equals(rows)
        assert about_of(table) == {"shard": "train-00000", "größe": [1, None]}
        assert packed(table) == content
    assert unpacked(packed(ROWS)).schema.equals(SCHEMA, check_metadata=True)
    name = "accel_bearing_vertical_m_s2"
    assert signal_matrix(unpacked(packed(ROWS))[name]).tobytes() == signal_matrix(ROWS[name]).tobytes()


@settings(max_examples=25, deadline=None)
@given(cuts=st.lists(st.integers(0, 11), max_size=6))
def test_bytes_do_not_depend_on_how_rows_arrive(cuts: list[int]) -> None:
    borders = [0, *sorted(cuts), 11]
    pieces = [ROWS.slice(a, b - a) for a, b in pairwise(borders)]
    assert packed(pa.concat_tables(pieces)) == packed(ROWS)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shard, "GROUP_ROWS", 4)
        grown = []
        for parts in (pieces, [ROWS]):
            table = PackedTable(SCHEMA)
            for part in parts:
                for batch in part.to_batches():
                    table.add(batch)
            file, promise = table.finish()
            grown.append(file.read())
            assert promise == promised(grown[-1])
            table.close()
    assert grown[0] == grown[1]
    assert unpacked(grown[0]).equals(ROWS)


def test_no_flipped_bit_of_a_shard_survives_reading_it_and_writing_it_again() -> None:
    """Checksums of pages miss their headers and the footer; what is read wrongly is not written with the same bytes."""
    content = packed(ROWS, {"shard": "train-00000", "failures": [[3, "diverged", "motion"]]})
    chance, footer = np.random.default_rng(1), int.from_bytes(content[-8:-4], "little")
    places = [*chance.integers(0, len(content), 150), *chance.integers(len(content) - footer, len(content), 150)]
    for place in places:
        broken = bytearray(content)
        broken[place] ^= 1 << int(chance.integers(8))
        try:
            table = unpacked(bytes(broken))
            about_of(table)
        except VerificationError:
            continue
        is_as_planned = table.replace_schema_metadata(SCHEMA.metadata).schema.equals(SCHEMA, check_metadata=True)
        assert not is_as_planned or packed(table) != bytes(broken), f"byte {place}"


def test_what_is_no_table_is_refused_in_words() -> None:
    for content in (b"", b"PAR1", packed(ROWS)[:-1], b"x" * 1000):
        with pytest.raises(VerificationError, match="cannot be decoded"):
            unpacked(content)
    with pytest.raises(VerificationError, match="does not say what it is"):
        about_of(ROWS)
