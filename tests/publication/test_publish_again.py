"""`publish` that is stopped: the folder has no name before it is whole, and the same call ends with the same bytes."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest

import siggen
from siggen import file_writing
from siggen.dataset.manifest import MANIFEST
from siggen.dataset.storage_at import storage_at
from siggen.errors import DatasetError, UsageError
from siggen.publication import publish as publication_module
from siggen.publication.publish import publish
from tests.dataset.fake_set import file_bytes, write_fake_set
from tests.dataset.s3_server import BUCKET, object_bytes, s3_server
from tests.publication.conftest import facts_file

MOMENTS = 5
PICTURES = {f"previews/{name}.png": name.encode() for name in ("healthy", "slight", "moderate")}
"""Drawn elsewhere: of a whole `publish` they take nearly all the time."""
PUBLISHED = f"""
import os, signal, sys
from pathlib import Path
from siggen import file_writing
from siggen.publication import publish as publication_module
from siggen.publication.publish import publish
publication_module._previews = lambda dataset: {PICTURES}
folder, moments = Path(sys.argv[1]), sys.argv[2:]
flush, flushed = file_writing._flush, 0
def dies(path):
    global flushed
    flushed += 1
    if flushed == moment:
        os.kill(os.getpid(), signal.SIGKILL)
    flush(path)
file_writing._flush = dies
for moment in map(int, moments):
    child = os.fork()
    if child == 0:
        publish(folder / "set", folder / "upload", folder / "publication.yaml")
        os._exit(0)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), (folder / "upload").exists(), flush=True)
"""


@pytest.fixture(autouse=True, scope="module")
def pictures() -> Iterator[None]:
    with patch.object(publication_module, "_previews", lambda dataset: PICTURES):
        yield


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a set whose shard is a link within it, and the authors' facts."""
    folder = tmp_path_factory.mktemp("again")
    write_fake_set(folder / "set")
    facts_file(folder)
    shard = next((folder / "set" / "data").glob("*.parquet"))
    moved = shard.rename(folder / "set" / "data" / f".{shard.name}")
    shard.symlink_to(moved.absolute())
    return folder


@pytest.fixture(scope="module")
def whole(place: Path) -> dict[str, bytes]:
    publish(place / "set", place / "whole", place / "publication.yaml")
    return file_bytes(place / "whole")


def test_killed_at_five_moments_and_run_again_it_ends_with_the_same_bytes(place: Path, whole: dict[str, bytes]) -> None:
    moments = np.linspace(1, 2 * len(whole), MOMENTS).round().astype(int).tolist()  # two flushes for every file
    done = subprocess.run(
        [sys.executable, "-P", "-c", PUBLISHED, place, *map(str, moments), "0"],
        capture_output=True, text=True, timeout=500, check=False,
    )  # fmt: skip
    assert done.stdout.splitlines() == [f"{-signal.SIGKILL} False"] * MOMENTS + ["0 True"], done.stderr
    assert file_bytes(place / "upload") == whole
    assert not list(place.glob(f".upload*{file_writing.LEFTOVER_SUFFIX}"))


def test_ctrl_c_leaves_nothing(place: Path, tmp_path: Path) -> None:
    with patch.object(publication_module, "sealed", side_effect=KeyboardInterrupt), pytest.raises(KeyboardInterrupt):
        publish(place / "set", tmp_path / "upload", place / "publication.yaml")
    assert not list(tmp_path.iterdir())


def test_what_is_published_is_a_copy_without_links(place: Path, whole: dict[str, bytes]) -> None:
    files = [path for path in (place / "whole").rglob("*") if not path.is_dir()]
    assert len(files) == len(whole)
    assert all(not path.is_symlink() and path.stat().st_nlink == 1 for path in files)
    assert siggen.open(place / "whole").labels().equals(siggen.open(place / "set").labels())


def test_generate_on_a_damaged_published_set_says_what_is_lost(place: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(place / "whole", tmp_path / "upload"))
    (folder / "README.md").unlink()
    (note,) = write_fake_set(folder).notes
    assert note.startswith("croissant.json, previews and the card of `siggen publish` are no part of the set now")
    assert (folder / "README.md").read_bytes() == (place / "set/README.md").read_bytes()


def test_a_folder_that_holds_something_is_never_touched(place: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(UsageError, match="is not empty"):
        publish(place / "set", tmp_path, place / "publication.yaml")
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
    (tmp_path / "empty").mkdir()
    publish(place / "set", tmp_path / "empty", place / "publication.yaml")
    assert siggen.open(tmp_path / "empty").labels().num_rows


def test_in_a_store_the_manifest_comes_last_and_a_stopped_publish_goes_on(
    place: Path, whole: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    upload, facts = f"s3://{BUCKET}/some/upload", place / "publication.yaml"
    with s3_server(monkeypatch):
        with (
            patch.object(publication_module, "sealed", side_effect=KeyboardInterrupt),
            pytest.raises(KeyboardInterrupt),
        ):
            publish(place / "set", upload, facts)
        assert set(object_bytes(upload)) == set(whole) - {MANIFEST}
        with pytest.raises(DatasetError, match="is not finished"):
            siggen.open(upload)
        publish(place / "set", upload, facts)
        assert object_bytes(upload) == whole
        assert siggen.open(upload).labels().equals(siggen.open(place / "set").labels())
        other = f"s3://{BUCKET}/other"
        storage_at(other).put("mine.txt", b"mine")
        with pytest.raises(UsageError, match="is not empty"):
            publish(place / "set", other, facts)
        assert object_bytes(other) == {"mine.txt": b"mine"}
