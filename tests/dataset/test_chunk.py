"""Chunks: every record once and in order, specimens whole where they fit, faults named."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.dataset.chunk import Chunk, ChunkSimulation, chunks
from siggen.errors import EngineError
from siggen.planning.plan import record_ids_of
from tests.dataset.fake_set import fake_config, simulate, simulate_none, simulate_with_a_bug, simulate_with_failures

CONFIG = fake_config()


@given(st.lists(st.integers(0, 50), unique=True, max_size=12), st.integers(1, 40), st.integers(1, 32))
def test_chunks_hold_every_record_once_in_order(specimens: list[int], per_specimen: int, group_rows: int) -> None:
    ids = [range(s * per_specimen, (s + 1) * per_specimen) for s in specimens]
    found = list(chunks("train-00000", ids, group_rows))
    assert [i for chunk in found for i in chunk.records] == [i for r in ids for i in r]
    assert all(len(chunk.records) <= 2 * group_rows for chunk in found)
    if per_specimen <= 2 * group_rows:
        assert [chunk.records for chunk in found] == ids


def test_a_chunk_gives_its_rows_and_its_failures() -> None:
    result = ChunkSimulation(CONFIG, simulate_with_failures)(Chunk("train-00000", range(12)))
    assert result.batch()["record_id"].to_pylist() == [0, 1, 2, 4, 5, 6, 7, 9, 11]
    assert [(f.record_id, f.status) for f in result.failures] == [(3, "diverged"), (8, "diverged"), (10, "not_finite")]
    assert "bearing_vertical has 1 value not finite" in result.failures[2].reason


def test_a_chunk_of_failures_has_no_rows() -> None:
    result = ChunkSimulation(CONFIG, simulate_none)(Chunk("train-00000", range(6)))
    assert result.batch().num_rows == 0
    assert len(result.failures) == 6


def test_an_exception_names_the_record_that_raises_it() -> None:
    with pytest.raises(EngineError, match=r"record 8 raised ZeroDivisionError"):
        ChunkSimulation(CONFIG, simulate_with_a_bug)(Chunk("train-00000", record_ids_of(CONFIG, 1)))


def test_results_for_other_records_than_asked_for_are_refused() -> None:
    with pytest.raises(EngineError, match="record 0 returned record 5"):
        ChunkSimulation(CONFIG, lambda config, ids: simulate(config, ids)[::-1])(Chunk("train-00000", range(6)))
