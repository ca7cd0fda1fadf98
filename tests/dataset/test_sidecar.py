"""Sidecars: id ranges, and which shards of an earlier run are taken over."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from siggen.dataset.id_ranges import IdRanges, id_ranges, in_ranges
from siggen.dataset.sidecar import Sidecar, committed, read_sidecar
from siggen.dataset.storage import LocalFolder
from tests.dataset.fake_set import fake_config, simulate_with_failures, write_fake_set

IDENTITY = fake_config().identity


@pytest.fixture
def storage(tmp_path: Path) -> LocalFolder:
    write_fake_set(tmp_path)
    return LocalFolder(tmp_path)


@given(st.sets(st.integers(0, 60)))
def test_ranges_hold_exactly_the_ids_and_never_touch(ids: set[int]) -> None:
    ranges = id_ranges(sorted(ids))
    assert {i for i in range(61) if in_ranges(i, ranges)} == ids
    assert all(a[1] + 1 < b[0] for a, b in pairwise(ranges))


@given(st.sets(st.integers(0, 60)), st.integers(1, 5))
def test_ranges_of_groups_are_those_of_their_ids(groups: set[int], size: int) -> None:
    ids = [one * size + i for one in sorted(groups) for i in range(size)]
    assert IdRanges(sorted(groups), size) == id_ranges(ids)
    assert id_ranges(ids) == IdRanges(sorted(groups), size)


def test_a_sidecar_tells_what_its_shard_holds(storage: LocalFolder) -> None:
    sidecar = read_sidecar(storage, "train-00000")
    assert sidecar.data.bytes == storage.size("data/train-00000.parquet")
    assert sidecar.data.rows == 6
    assert sidecar.rows_per_state == {"healthy": 2, "slight": 2, "moderate": 2}
    assert sidecar.records == ((sidecar.specimens[0][0] * 6, sidecar.specimens[0][0] * 6 + 5),)
    assert sidecar.environment["siggen"]


def test_failures_are_listed_with_their_reason(tmp_path: Path) -> None:
    write_fake_set(tmp_path, simulation=simulate_with_failures)
    found = [read_sidecar(LocalFolder(tmp_path), p.stem) for p in sorted((tmp_path / "shards").iterdir())]
    failures = sorted((f.record_id, f.status) for sidecar in found for f in sidecar.failures)
    assert failures == [(3, "diverged"), (8, "diverged"), (10, "not_finite")]
    for sidecar in found:
        planned = sum(last - first + 1 for first, last in sidecar.records)
        assert sidecar.data.rows + len(sidecar.failures) == planned


def first_specimen(storage: LocalFolder) -> int:
    return json.loads(storage.get("shards/train-00000.json"))["specimens"][0][0]


def test_a_whole_shard_of_the_same_set_is_taken_over(storage: LocalFolder) -> None:
    first = first_specimen(storage)
    assert isinstance(committed(storage, "train-00000", IDENTITY, ((first, first),)), Sidecar)
    assert "another set" in str(committed(storage, "train-00000", "0" * 64, ((first, first),)))
    assert "another set" in str(committed(storage, "train-00000", IDENTITY, ((first, first + 1),)))
    assert committed(storage, "train-00009", IDENTITY, ((first, first),)) == ""


@pytest.mark.parametrize("damage", ["flip", "truncate", "delete rows", "delete sidecar", "break sidecar"])
def test_a_damaged_shard_is_not_taken_over(storage: LocalFolder, damage: str) -> None:
    first = first_specimen(storage)
    rows, sidecar = storage.path / "data/train-00000.parquet", storage.path / "shards/train-00000.json"
    content = bytearray(rows.read_bytes())
    match damage:
        case "flip":
            content[len(content) // 2] ^= 1
            rows.write_bytes(content)
        case "truncate":
            rows.write_bytes(content[:-1])
        case "delete rows":
            rows.unlink()
        case "delete sidecar":
            sidecar.unlink()
        case "break sidecar":
            sidecar.write_text(sidecar.read_text()[:-20])
    found = committed(storage, "train-00000", IDENTITY, ((first, first),))
    assert isinstance(found, str)
    assert ("train-00000" in found) == (damage != "delete sidecar"), "an absent shard needs no reason"
