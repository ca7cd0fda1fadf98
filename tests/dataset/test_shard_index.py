"""The index of shards: a set opens and lists its row groups without its shards, and believes no contradiction."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import siggen
from siggen.dataset.object_name import CHECKSUMS, INDEX
from siggen.dataset.object_store import ObjectStore
from siggen.errors import DatasetError
from siggen.sets.verification import verify
from tests.dataset.fake_set import write_fake_set
from tests.dataset.resealed_set import retabled
from tests.dataset.s3_server import BUCKET, s3_server


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "fake"
    write_fake_set(path)
    return path


def test_row_groups_and_owners_are_those_of_the_files_and_no_file_of_a_shard_is_opened(
    folder: Path, tmp_path: Path
) -> None:
    whole = siggen.open(folder)
    rows = [whole.row_group(group).num_rows for group in whole.row_groups()]
    listed = [group.rows for group in whole.row_groups()]
    alone = Path(shutil.copytree(folder, tmp_path / "alone"))
    shutil.rmtree(alone / "data")
    shutil.rmtree(alone / "shards")
    dataset = siggen.open(alone)
    assert dataset.row_groups() == whole.row_groups()
    assert listed == rows
    assert sum(rows) == dataset.inventory.rows
    owners = {i: dataset.index.owner(i) for i in range(-1, 31)}
    assert owners[-1] is owners[30] is None
    for batch in whole.records(columns=["record_id", "split"]):
        for row in batch.to_pylist():
            assert (owner := owners[row["record_id"]]) is not None
            assert owner.split == row["split"]
    with pytest.raises(DatasetError, match=r"data/.* is missing"):
        dataset.record(3)


def changed(name: str, value: Any, shard: str = "train-00001") -> Callable[[dict[str, Any]], dict[str, Any]]:
    return lambda row: row | ({name: value} if row["shard"] == shard else {})


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (changed("shard", "../../secret"), "shard: allowed: a split and at least five digits"),
        (changed("shard", "train-00000"), "shard: received one twice"),
        (changed("shard", "test-00007"), "rows of test: received 12; allowed: those of the manifest"),
        (changed("rows", 5), "rows of train: received 17"),
        (changed("rows", -6), "rows: received -6"),
        (changed("environment", 1), "environment: received 1; allowed: below 1"),
        (changed("records", [9, 6]), "records: allowed: ascending ranges"),
        (changed("records", [6, 7, 7, 9]), "records: allowed: ascending ranges"),
        (changed("records", [6]), "records: allowed: first and last id"),
        (changed("specimens", [-1, 2]), "specimens: allowed: first and last id"),
        (changed("records", [6, 2**60]), "records: allowed: first and last id"),
    ],
)
def test_an_index_that_no_set_can_have_is_refused_although_all_seals_fit(
    folder: Path, tmp_path: Path, change: Callable[[dict[str, Any]], dict[str, Any]], said: str
) -> None:
    stranger = Path(shutil.copytree(folder, tmp_path / "stranger"))
    retabled(stranger, INDEX, change)
    with pytest.raises(DatasetError) as caught:
        siggen.open(stranger)
    assert f"index.parquet: {said}" in str(caught.value)
    assert verify(stranger, 0).mismatches != ()


def test_a_file_of_another_size_or_hash_than_the_index_says_is_named(folder: Path, tmp_path: Path) -> None:
    stranger = Path(shutil.copytree(folder, tmp_path / "stranger"))
    file = stranger / "data/train-00001.parquet"
    file.write_bytes(file.read_bytes() + b"x")
    dataset = siggen.open(stranger)
    with pytest.raises(DatasetError, match=r"data/train-00001\.parquet has \d+ bytes instead of \d+; `siggen verify`"):
        list(dataset.records("train"))
    shutil.copy(folder / "data/train-00001.parquet", file)
    retabled(stranger, CHECKSUMS, changed("data_sha256", bytes(32)))
    assert [m.what for m in verify(stranger, 0).mismatches] == ["data/train-00001.parquet"]


def test_of_a_store_a_row_of_a_shard_read_before_is_one_request(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    asked: list[str] = []
    fetch, size = ObjectStore._fetch, ObjectStore._size

    def fetched(store: ObjectStore, name: str, borders: tuple[int, int] | None) -> bytes:
        asked.append(f"GET {name}")
        return fetch(store, name, borders)

    def sized(store: ObjectStore, name: str) -> int | None:
        asked.append(f"HEAD {name}")
        return size(store, name)

    with s3_server(monkeypatch):
        place = f"s3://{BUCKET}/set"
        write_fake_set(place)
        monkeypatch.setattr(ObjectStore, "_fetch", fetched)
        monkeypatch.setattr(ObjectStore, "_size", sized)
        dataset = siggen.open(place)
        groups = dataset.row_groups("train")
        assert [name for name in asked if "/" in name] == []
        assert len(asked) <= 6
        dataset.row_group(groups[0])
        asked.clear()
        dataset.row_group(groups[0])
        assert asked == [f"GET {groups[0].file}"]
