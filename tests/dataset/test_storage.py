"""Objects in a folder: whole or absent, one writer at a time, leftovers of killed processes removed."""

from __future__ import annotations

import errno
import subprocess
import sys
from pathlib import Path

import pytest

from siggen.dataset import storage as storage_module
from siggen.dataset.storage import LocalFolder
from siggen.errors import DatasetError
from siggen.file_writing import LEFTOVER_SUFFIX


def test_an_object_replaces_an_older_one_and_is_read_back(tmp_path: Path) -> None:
    storage = LocalFolder(tmp_path)
    storage.put("a/b.json", b"old")
    storage.put("a/b.json", b"new one")
    assert storage.get("a/b.json") == b"new one"
    assert storage.sizes() == {"a/b.json": 7}
    assert storage.names() == ["a/b.json"]
    with pytest.raises(DatasetError, match="has 7 bytes instead of 8"):
        storage.get("a/b.json", 8)


def test_a_write_that_fails_leaves_the_old_object_and_no_trace(tmp_path: Path) -> None:
    storage = LocalFolder(tmp_path)
    storage.put("a.json", b"old")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(storage_module, "copyfileobj", lambda content, file: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            storage.put("a.json", b"half")
    assert storage.get("a.json") == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.json"]


def test_leftovers_are_no_objects_and_are_deleted_by_name_only(tmp_path: Path) -> None:
    storage = LocalFolder(tmp_path)
    storage.put("data/a.parquet", b"x")
    (tmp_path / f"data/.b.parquet.0123abcd{LEFTOVER_SUFFIX}").write_bytes(b"half")
    (tmp_path / "notes.txt").write_text("mine")
    assert storage.names() == ["data/a.parquet", "notes.txt"]
    assert storage.delete_leftovers(of_dead=True) == []  # of whom it is, its name does not say
    assert storage.delete_leftovers() == [f"data/.b.parquet.0123abcd{LEFTOVER_SUFFIX}"]
    assert sorted(p.name for p in tmp_path.rglob("*") if p.is_file()) == ["a.parquet", "notes.txt"]


def test_names_below_a_folder_that_does_not_exist_are_none(tmp_path: Path) -> None:
    assert LocalFolder(tmp_path / "nothing").names("data") == []


def test_a_missing_object_says_how_to_restore_it(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match=r"a\.parquet is missing; generating the same set again restores it"):
        LocalFolder(tmp_path).get("a.parquet")


def test_a_second_writer_is_refused_while_the_first_one_lives(tmp_path: Path) -> None:
    code = "import sys, time; from siggen.dataset.storage import LocalFolder\n"
    code += "with LocalFolder(sys.argv[1]).writing(): print('in', flush=True); time.sleep(60)"
    first = subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE)
    try:
        assert first.stdout is not None
        assert first.stdout.readline() == b"in\n"
        for beside_others in (False, True):
            guard = LocalFolder(tmp_path).writing(beside_others=beside_others)
            with pytest.raises(DatasetError, match="another siggen process"), guard:
                pass
    finally:
        first.kill()
        first.communicate()
    with LocalFolder(tmp_path).writing():
        assert list(tmp_path.iterdir()) == []


def test_parts_write_beside_each_other_and_keep_out_whoever_ends_the_set(tmp_path: Path) -> None:
    storage = LocalFolder(tmp_path)
    ends = pytest.raises(DatasetError, match="another siggen process")
    with storage.writing(beside_others=True), storage.writing(beside_others=True), ends, storage.writing():
        pass


def test_a_file_is_not_a_folder(tmp_path: Path) -> None:
    (tmp_path / "set").write_text("x")
    with pytest.raises(DatasetError, match="is a file"), LocalFolder(tmp_path / "set").writing():
        pass


def test_a_disk_that_takes_no_more_is_named_with_how_to_go_on(tmp_path: Path) -> None:
    full = OSError(errno.ENOSPC, "Error writing bytes to file")  # as pyarrow words it
    expected = "No space left on device; finished shards stay, and the same command continues"
    with pytest.raises(DatasetError, match=expected), LocalFolder(tmp_path).writing():
        raise full
    with LocalFolder(tmp_path).writing():
        pass  # the lock is free again


def test_other_failures_of_the_system_stay_what_they_are(tmp_path: Path) -> None:
    with pytest.raises(BrokenPipeError), LocalFolder(tmp_path).writing():
        raise BrokenPipeError(errno.EPIPE, "a worker")
