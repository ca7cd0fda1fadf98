"""Objects in a store that speaks S3, served on loopback: whole or absent, failures in words."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from pathlib import Path

import pytest

from siggen.dataset.object_path import object_path
from siggen.dataset.object_store import ObjectStore
from siggen.dataset.storage import LocalFolder
from siggen.dataset.storage_at import storage_at
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import LEFTOVER_SUFFIX
from tests.dataset.s3_server import BUCKET, s3_server

PLACE = f"s3://{BUCKET}/some/set"


@pytest.fixture
def store(monkeypatch: pytest.MonkeyPatch) -> Iterator[ObjectStore]:
    with s3_server(monkeypatch):
        found = storage_at(PLACE)
        assert isinstance(found, ObjectStore)
        yield found


@pytest.mark.parametrize("text", ["s3://b/a/set", "s3:/b/a/set", "s3://b/a/set/"])
def test_a_place_keeps_its_form_as_text_as_path_and_below_another(text: str) -> None:
    place = object_path(Path(text))
    assert place is not None
    assert (str(place), place.bucket, place.key, place.name) == ("s3://b/a/set", "b", "a/set", "set")
    assert str(place / "data/x.parquet") == f"{place}/data/x.parquet"
    assert not isinstance(place, Path)


def test_folders_are_no_places_in_a_store_and_other_stores_are_refused() -> None:
    assert object_path("sets/a") is None
    assert isinstance(storage_at(Path("C:/sets")), LocalFolder)
    for text in ("s3://", "s3:", "s3://bucket", "s3://bucket/a/../b", "gs://bucket/a"):
        with pytest.raises(UsageError, match=r"received .*; allowed: .*s3://bucket/set"):
            storage_at(text)


def test_an_object_is_replaced_read_listed_and_found_by_its_place(store: ObjectStore) -> None:
    store.put("a/b.json", b"old")
    store.put("a/b.json", b"new one")
    store.put("data/c.bin", b"x" * 12_000_000)  # pyarrow sends it in parts, which become one object in the end
    store.put(f".d{LEFTOVER_SUFFIX}", b"never seen")
    assert store.get("a/b.json") == b"new one"
    assert store.get("data/c.bin", 12_000_000) == b"x" * 12_000_000
    assert store.sizes() == {"a/b.json": 7, "data/c.bin": 12_000_000}
    assert (store.exists("a/b.json"), store.exists("a"), store.exists("c")) == (True, False, False)
    assert (store.names("data"), store.names("none")) == (["data/c.bin"], [])
    assert pickle.loads(pickle.dumps(store)).get("a/b.json") == b"new one"
    with pytest.raises(DatasetError, match="has 7 bytes instead of 8"):
        store.get("a/b.json", 8)


def test_a_store_that_is_gone_or_refuses_is_named_with_how_to_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    with s3_server(monkeypatch):
        lost = storage_at("s3://nobody/set")
        with pytest.raises(DatasetError, match="there is no such bucket; make it first"):
            lost.put("a", b"1")
        store = storage_at(PLACE)
        with pytest.raises(DatasetError, match=rf"{PLACE}/a is missing; generating the same set again restores it"):
            store.get("a")
    with pytest.raises(DatasetError, match=r"nobody answers.*; finished shards stay, and the same command continues"):
        store.put("a", b"1")
