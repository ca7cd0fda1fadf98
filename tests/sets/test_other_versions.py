"""Shards that another version of siggen made are never mixed with those of this one."""

from __future__ import annotations

import shutil
from pathlib import Path
from unittest.mock import patch

import pytest

from siggen.dataset.environment import environment, fingerprint
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.gearbox import plan
from siggen.sets.extension import extend
from siggen.sets.parts import generate_part, merge
from siggen.sets.set_run import Generation
from siggen.sets.verification import EXACT
from tests.dataset.fake_set import (
    copy_fake_set,
    fake_config,
    fake_physics,
    file_bytes,
    verify_fake_set,
    write_fake_set,
)

OTHER = {"siggen": "0.0.9", "fingerprint": "0123456789abcdef"}
WITHOUT = {"siggen": "0.0.8"}


def made_by(folder: Path, version: dict[str, str]) -> None:
    """Let all shards of a folder say that another version made them."""
    for file in sorted((folder / "shards").glob("*.json")):
        content = unsealed(file.name, file.read_bytes())
        there = {k: v for k, v in content["environment"].items() if k not in ("fingerprint", "sources")}
        file.write_bytes(sealed({**content, "environment": {**there, **version}}))


def half_made(folder: Path, version: dict[str, str]) -> None:
    """Leave what an interrupted run of another version leaves: three of five shards, and no manifest."""
    copy_fake_set(folder)
    for name in ("manifest.json", "run.json", "README.md", "shards/test-00000.json", "shards/train-00002.json"):
        (folder / name).unlink()
    for tables in ("metadata", "damage"):
        shutil.rmtree(folder / tables)
    made_by(folder, version)


@pytest.mark.parametrize("version", [OTHER, WITHOUT])
def test_shards_of_another_version_are_made_again_and_said_by_whom_they_were(
    tmp_path: Path, version: dict[str, str]
) -> None:
    half_made(tmp_path / "begun", version)
    resumed = write_fake_set(tmp_path / "begun")
    copy_fake_set(tmp_path / "at_once")
    assert file_bytes(tmp_path / "begun") == file_bytes(tmp_path / "at_once")
    assert (resumed.records_made, resumed.shards_taken_over, len(resumed.notes)) == (30, 0, 3)
    told = f"made by siggen {version['siggen']} ("
    assert all(f"is made again: {told}" in note for note in resumed.notes)
    assert version.get("fingerprint", "without fingerprint") in resumed.notes[0]


def test_a_set_of_one_version_is_compared_to_the_bit_whatever_cannot_change_one(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    with patch("siggen.sets.verification.environment", lambda: {**environment(), "pyarrow": "0", "siggen": "9"}):
        assert verify_fake_set(tmp_path, 3).comparison == EXACT


def test_a_finished_set_of_another_version_is_not_extended(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    made_by(tmp_path, OTHER)
    reseal_manifest(tmp_path)
    before = file_bytes(tmp_path)
    with pytest.raises(DatasetError, match=r"(?s)made by siggen 0\.0\.9 .*This is siggen.*generate a new one"):
        extended(tmp_path)
    assert file_bytes(tmp_path) == before


def test_parts_of_two_versions_are_not_merged(tmp_path: Path) -> None:
    parts = [tmp_path / "1", tmp_path / "2"]
    for number, path in enumerate(parts, start=1):
        with fake_physics(), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
            generate_part(fake_config(), path, (number, 2), 0)
    made_by(parts[1], OTHER)
    with (
        fake_physics(),
        patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096),
        pytest.raises(DatasetError, match=r"(?s)not mixed.*by siggen 0\.0\.9 .*Make parts again"),
    ):
        merge(parts, tmp_path / "merged")
    assert not list((tmp_path / "merged").glob("data/*"))


def test_the_fingerprint_stands_in_every_sidecar_and_in_the_manifest(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    own = environment()["fingerprint"]
    for file in (tmp_path / "shards").glob("*.json"):
        assert fingerprint(unsealed(file.name, file.read_bytes())["environment"]) == own
    manifest = unsealed("manifest.json", (tmp_path / "manifest.json").read_bytes())
    assert [fingerprint(one) for one in manifest["environments"]] == [own]


def extended(folder: Path) -> Generation:
    with fake_physics(), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
        return extend(folder, "+2", 0)


def reseal_manifest(folder: Path) -> None:
    """Let the manifest promise the sidecars that are there, as the other version would have."""
    from tests.dataset.resealed_set import facts

    manifest = unsealed("manifest.json", (folder / "manifest.json").read_bytes())
    for name in manifest["files"]:
        if name.startswith("shards/"):
            manifest["files"][name] = facts(folder, name, blocks=False)
    there = {k: v for k, v in manifest["environments"][0].items() if k not in ("fingerprint", "sources")}
    (folder / "manifest.json").write_bytes(sealed({**manifest, "environments": [{**there, **OTHER}]}))
