"""The plan: indices, splits, shards and row groups of a set, whatever its size."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.config import BLOCK
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import (
    SPLITS,
    plan,
    planned_record,
    record_ids_of,
    shard_count,
    shards,
    specimen_count,
    specimens_per_shard,
    split_of,
)
from tests.config.minimal import design

SEEDS = st.integers(0, 2**128 - 1)


@st.composite
def splits(draw):
    train = draw(st.integers(0, BLOCK))
    validation = draw(st.integers(0, BLOCK - train))
    return {"train": train, "validation": validation, "test": BLOCK - train - validation}


@given(splits(), SEEDS, st.integers(0, 10**6))
def test_every_block_of_20_holds_exactly_the_splits(counts, seed, block):
    made = design(seed=seed, splits=counts)
    labels = Counter(split_of(made, i) for i in range(block * BLOCK, (block + 1) * BLOCK))
    assert {name: labels[name] for name in SPLITS} == counts


def test_splits_are_shuffled_by_the_seed():
    orders = {tuple(split_of(design(seed=seed), i) for i in range(BLOCK)) for seed in range(50)}
    assert (
        len(orders) > 40
    )  # 20^4 orders of 3 + 1 + 1 in four sub-blocks: 50 draws coincide with a probability below 1 %


def test_a_split_depends_on_nothing_but_seed_splits_and_specimen():
    first = design()
    other = design(
        specimens=10**6,
        repeats=4,
        gears__module_mm=[2, 4],
        states={"healthy": {}},
    )
    assert [split_of(first, i) for i in range(100)] == [split_of(other, i) for i in range(100)]


@given(st.integers(1, 5), st.integers(1, 4), st.integers(1, 7), st.data())
def test_an_index_and_its_place_determine_each_other(points, repeats, specimens, data):
    made = design(
        specimens=specimens,
        repeats=repeats,
        operating_points=[{"speed_hz": 30, "torque_nm": 60}] * points,
    )
    record_id = data.draw(st.integers(0, len(plan(made)) - 1))
    found = planned_record(made, record_id)
    assert found.specimen_id < specimens
    assert found.state_id < 2
    assert found.operating_point_id < points
    assert found.repeat < repeats
    again = ((found.specimen_id * 2 + found.state_id) * points + found.operating_point_id) * repeats + found.repeat
    assert again == record_id
    assert record_id in record_ids_of(made, found.specimen_id)
    assert found.split == split_of(made, found.specimen_id)


def specimens_of(made: SetDesign, split: str) -> tuple[int, ...]:
    return tuple(i for i in range(made.specimens) if split_of(made, i) == split)


@given(st.integers(1, 1000))
def test_more_specimens_leave_existing_records_where_they_are(specimens):
    small, large = design(specimens=specimens), design(specimens=specimens + 17)
    last = len(plan(small)) - 1
    assert plan(small)[last] == plan(large)[last]
    assert specimens_of(small, "test") == tuple(i for i in specimens_of(large, "test") if i < specimens)


def test_a_negative_index_is_refused():
    with pytest.raises(IndexError, match="begin at 0"):
        planned_record(design(), -1)


def test_ten_million_records_are_planned_without_listing_them():
    made = design(specimens=5_000_000)
    records = plan(made)
    assert len(records) == 10_000_000
    assert records[9_999_999].specimen_id == 4_999_999


@settings(max_examples=30)
@given(st.integers(1, 1000), st.sampled_from([0.5, 1.0, 10.0]))
def test_shards_hold_whole_specimens_of_a_split_in_order(specimens, duration_s):
    made = design(specimens=specimens, duration_s=duration_s, repeats=3)
    per_shard = specimens_per_shard(made, specimens)
    seen: list[int] = []
    for split in SPLITS:
        found = shards(made, split)
        assert [shard.key for shard in found] == [f"{split}-{i:05d}" for i in range(len(found))]
        members = [specimen for shard in found for specimen in shard.specimens]
        assert tuple(members) == specimens_of(made, split)
        assert all(len(shard.specimens) == per_shard for shard in found[:-1])
        for shard in found:
            assert 1 <= len(shard.specimens) <= per_shard
            ids = list(shard.record_ids)
            assert ids == [i for s in shard.specimens for i in record_ids_of(made, s)]
            assert len(ids) == shard.record_count
            assert all(a < b for a, b in pairwise(ids))
            seen += ids
    assert sorted(seen) == list(range(len(plan(made))))


def test_a_set_has_a_shard_of_each_gearbox_or_256_and_more_of_16_mb_at_most():
    counts = [sum(shard_count(design(specimens=n), split) for split in SPLITS) for n in (1, 24, 256, 511)]
    assert counts == [1, 24, 256, 511]
    assert specimens_per_shard(design(duration_s=10.0), 10**7) == specimens_per_shard(design(duration_s=10.0), 10**6)
    assert specimens_per_shard(design(duration_s=1000.0), 10**6) == 1


def test_shards_follow_from_what_is_made_at_once_and_an_extension_leaves_those_that_are_there():
    small, large = design(specimens=600), design(specimens=3000)
    for split in SPLITS:
        before = shards(small, split)
        assert {len(one.specimens) for one in before[:-1]} == {2}
        grown = shards(large, split, (600,))
        assert grown[: len(before)] == before
        assert {len(one.specimens) for one in grown[len(before) : -1]} == {2400 // 256}


@pytest.mark.parametrize("specimens", [1, 7, 20, 39, 100, 401])
@pytest.mark.parametrize(
    "splits", [{}, {"train": 20, "validation": 0, "test": 0}, {"train": 7, "validation": 6, "test": 7}]
)
def test_counts_of_splits_and_shards_are_those_of_the_lists(specimens: int, splits: dict[str, int]) -> None:
    made = design(specimens=specimens, **({"splits": splits} if splits else {}))
    for split in SPLITS:
        assert specimen_count(made, split) == len(specimens_of(made, split))
        assert shard_count(made, split) == len(shards(made, split))
