"""Objects in a store that speaks S3, served on loopback: whole or absent, one writer, failures in words."""

from __future__ import annotations

import pickle
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from siggen.dataset import object_store
from siggen.dataset.object_path import object_path
from siggen.dataset.object_store import LOCK, ObjectStore
from siggen.dataset.storage import LocalFolder, sha256
from siggen.dataset.storage_at import storage_at
from siggen.errors import DatasetError, UsageError
from siggen.file_writing import LEFTOVER_SUFFIX
from tests.dataset.s3_server import BUCKET, s3_server

PLACE = f"s3://{BUCKET}/some/set"


@pytest.fixture
def store(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[ObjectStore]:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    with s3_server(monkeypatch):
        found = storage_at(PLACE)
        assert isinstance(found, ObjectStore)
        yield found


def client(store: ObjectStore):
    return store._client


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
    with store.draft("data/c.bin") as path:
        path.write_bytes(b"x" * 10)
    store.put(f".d{LEFTOVER_SUFFIX}", b"never seen")
    assert store.get("a/b.json") == b"new one"
    assert store.sizes() == {"a/b.json": 7, "data/c.bin": 10}
    assert (store.size("a/b.json"), store.exists("a/b.json"), store.exists("a")) == (7, True, False)
    assert store.names("data") == ["data/c.bin"]
    assert sha256(store, "a/b.json") == "20a96de1d7f9c25045cc7e54a249e23a8129c6ad5bb98888895e28be303334e6"
    assert pickle.loads(pickle.dumps(store)).get("a/b.json") == b"new one"


def test_a_draft_that_fails_leaves_the_old_object_and_no_trace(store: ObjectStore, tmp_path: Path) -> None:
    store.put("a.json", b"old")

    def fail() -> None:
        with store.draft("a.json") as path:
            path.write_bytes(b"half")
            raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        fail()
    assert store.get("a.json") == b"old"
    assert list(tmp_path.iterdir()) == []


def test_temporary_files_of_a_killed_writer_are_deleted_and_only_those_of_this_set(
    store: ObjectStore, tmp_path: Path
) -> None:
    code = "import os, sys; from siggen.dataset.storage_at import storage_at\n"
    code += "with storage_at(sys.argv[1]).draft('data/a') as path: path.write_bytes(b'half'); os.kill(os.getpid(), 9)"
    for place in (PLACE, f"{PLACE}2"):
        subprocess.run([sys.executable, "-c", code, place], check=False)
    assert len(list(tmp_path.iterdir())) == 2
    assert len(store.delete_leftovers()) == 1
    assert len(list(tmp_path.iterdir())) == 1
    assert store.names() == []
    assert "Uploads" not in client(store).list_multipart_uploads(Bucket=BUCKET)


HOLDER = """
import sys, time
from siggen.dataset.storage_at import storage_at
with storage_at(sys.argv[1]).writing():
    print("in", flush=True)
    time.sleep(60)
"""


def test_a_second_writer_is_refused_while_the_first_lives_and_goes_on_once_it_is_dead(store: ObjectStore) -> None:
    first = subprocess.Popen([sys.executable, "-c", HOLDER, PLACE], stdout=subprocess.PIPE)
    try:
        assert first.stdout is not None
        assert first.stdout.readline() == b"in\n"
        with pytest.raises(DatasetError, match=rf"by another siggen process \(process {first.pid} on"), store.writing():
            pass
    finally:
        first.kill()
        first.communicate()
    with store.writing():
        assert store.names() == []
    assert not store.exists(LOCK)


def test_a_store_that_is_gone_or_refuses_is_named_with_how_to_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(object_store, "BODY_ATTEMPTS", 2)
    with s3_server(monkeypatch):
        lost = storage_at("s3://nobody/set")
        with pytest.raises(DatasetError, match="there is no such bucket; make it first"):
            lost.put("a", b"1")
        store = storage_at(PLACE)
        with pytest.raises(DatasetError, match=rf"{PLACE}/a is missing; generating the same set again restores it"):
            store.get("a")
    with pytest.raises(
        DatasetError, match=r"Could not connect.*; finished shards stay, and the same command continues"
    ):
        store.put("a", b"1")


def test_an_answer_that_breaks_off_is_asked_for_again(store: ObjectStore, monkeypatch: pytest.MonkeyPatch) -> None:
    from botocore.exceptions import ResponseStreamingError

    store.put("a", b"whole")
    monkeypatch.setattr("time.sleep", lambda _: None)
    broken = [True, True]
    real = client(store).get_object

    class Body:
        def read(self) -> bytes:
            broken.pop()
            raise ResponseStreamingError(error="connection reset")

    monkeypatch.setattr(client(store), "get_object", lambda **asked: {"Body": Body()} if broken else real(**asked))
    assert store.get("a") == b"whole"
    broken[:] = [True] * 10
    with pytest.raises(DatasetError, match=r"cannot be read: .*connection reset"):
        store.get("a")
