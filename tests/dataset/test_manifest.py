"""The manifest: a digest of itself, counts, hashes of every other file, and what a reader is told without it."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import siggen
from siggen.dataset.manifest import read_manifest
from siggen.dataset.seal import sealed, unsealed
from siggen.dataset.storage import LocalFolder
from siggen.errors import DatasetError, VerificationError
from tests.dataset.fake_set import FAKE_FILES, copy_fake_set, fake_config, simulate_with_failures, write_fake_set

SEALED = sealed({"rows": 3, "name": "größe", "nested": {"b": [1.5, None], "a": True}})


@given(place=st.integers(0, len(SEALED) - 1), change=st.integers(1, 255))
def test_any_changed_byte_breaks_the_seal(place: int, change: int) -> None:
    broken = bytearray(SEALED)
    broken[place] ^= change
    with pytest.raises(VerificationError, match=r"x\.json"):
        unsealed("x.json", bytes(broken))


def test_added_or_missing_bytes_break_the_seal() -> None:
    for broken in (SEALED + b" ", SEALED[:-1], b"", b"[]", b"3"):
        with pytest.raises(VerificationError):
            unsealed("x.json", broken)


def test_the_manifest_promises_every_other_file(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    manifest = read_manifest(LocalFolder(tmp_path)).content
    on_disk = sorted(p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*") if p.is_file())
    assert on_disk == FAKE_FILES
    assert sorted([*manifest["files"], "manifest.json"]) == FAKE_FILES
    for name, facts in manifest["files"].items():
        content = (tmp_path / name).read_bytes()
        assert facts == {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}


def test_counts_are_per_split_and_state_and_failures_are_listed(tmp_path: Path) -> None:
    write_fake_set(tmp_path, simulation=simulate_with_failures)
    manifest = read_manifest(LocalFolder(tmp_path)).content
    assert manifest["identity"] == fake_config().identity
    assert manifest["rows"] == 27
    assert [failure["record_id"] for failure in manifest["failures"]] == [3, 8, 10]
    splits = manifest["splits"]
    assert {name: split["specimens"] for name, split in splits.items()} == {"train": 3, "validation": 1, "test": 1}
    assert sum(split["rows"] for split in splits.values()) == 27
    assert sum(split["failed"] for split in splits.values()) == 3
    # record 3 is `slight`, records 8 and 10 are `slight` and `moderate` of specimen 1
    states = {
        name: sum(split["states"][name] for split in splits.values()) for name in ("healthy", "slight", "moderate")
    }
    assert states == {"healthy": 10, "slight": 8, "moderate": 9}


def test_a_folder_without_a_set_an_unfinished_one_and_a_damaged_one_are_told_apart(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="no such folder"):
        read_manifest(LocalFolder(tmp_path / "nothing"))
    (tmp_path / "holiday.jpg").write_bytes(b"x")
    with pytest.raises(DatasetError, match="not a siggen data set"):
        read_manifest(LocalFolder(tmp_path))
    folder = tmp_path / "set"
    copy_fake_set(folder)
    manifest = folder / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"rows": 30', '"rows": 31'))
    with pytest.raises(DatasetError, match="digest"):
        read_manifest(LocalFolder(folder))
    manifest.unlink()
    with pytest.raises(DatasetError, match=r"not finished .* siggen generate .*config\.yaml --out"):
        read_manifest(LocalFolder(folder))


def test_a_mistyped_folder_is_answered_with_the_nearest_one(tmp_path: Path) -> None:
    (tmp_path / "runs" / "quickstart").mkdir(parents=True)
    for mistyped, meant in (("runs/quickstrat", "quickstart"), ("rums/quickstart", "runs")):
        with pytest.raises(DatasetError, match=rf"no such folder, or an empty one\); did you mean '{meant}'\?$"):
            siggen.open(tmp_path / mistyped)
    for other in ("runs/quickstart", "runs/what"):
        with pytest.raises(DatasetError, match=r"or an empty one\)$"):
            siggen.open(tmp_path / other)
