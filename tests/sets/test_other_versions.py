"""Shards that another version of siggen made are taken over only if their records are equal to the bit."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from siggen.columns.record import Record, RecordFailure
from siggen.config import Config
from siggen.dataset.environment import environment, fingerprint
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.planning import plan
from siggen.sets.extension import extend
from siggen.sets.parts import generate_part, merge
from siggen.sets.set_run import Generation
from siggen.sets.verification import CLOSE, EXACT
from tests.dataset.fake_set import (
    fake_config,
    fake_physics,
    file_bytes,
    simulate,
    simulate_with_failures,
    verify_fake_set,
    write_fake_set,
)

OTHER = {"siggen": "0.0.9", "fingerprint": "0123456789abcdef"}
WITHOUT = {"siggen": "0.0.8"}


def simulate_otherwise(config: Config, record_ids: Sequence[int]) -> list[Record | RecordFailure]:
    """Give the mildest damage at the second operating point the last bit of one label otherwise."""
    results = simulate(config, record_ids)
    return [
        replace(one, labels={**one.labels, "damaged_area_share": 0.0010000000000000002})
        if isinstance(one, Record) and (one.planned.state_id, one.planned.operating_point_id) == (1, 1)
        else one
        for one in results
    ]


def made_by(folder: Path, version: dict[str, str]) -> None:
    """Let all shards of a folder say that another version made them."""
    for file in sorted((folder / "shards").glob("*.json")):
        content = unsealed(file.name, file.read_bytes())
        there = {k: v for k, v in content["environment"].items() if k not in ("fingerprint", "sources")}
        file.write_bytes(sealed({**content, "environment": {**there, **version}}))


def half_made(folder: Path, version: dict[str, str], simulation: Any = simulate) -> None:
    """Leave what an interrupted run of another version leaves: three of five shards, and no manifest."""
    write_fake_set(folder, simulation=simulation)
    for name in ("manifest.json", "run.json", "README.md", "shards/test-00000.json", "shards/train-00002.json"):
        (folder / name).unlink()
    for tables in ("metadata", "damage"):
        shutil.rmtree(folder / tables)
    made_by(folder, version)


@pytest.mark.parametrize("version", [OTHER, WITHOUT])
def test_shards_with_other_records_are_made_again_and_said_by_whom_they_were(
    tmp_path: Path, version: dict[str, str]
) -> None:
    half_made(tmp_path / "begun", version, simulate_otherwise)
    resumed = write_fake_set(tmp_path / "begun")
    write_fake_set(tmp_path / "at_once")
    assert file_bytes(tmp_path / "begun") == file_bytes(tmp_path / "at_once")
    assert (resumed.records_made, resumed.shards_taken_over) == (30, 0)
    (note,) = resumed.notes
    assert note.startswith(f"3 shards made by siggen {version['siggen']} (")
    assert version.get("fingerprint", "without fingerprint") in note
    assert "damaged_area_share" in note
    assert note.endswith("they are made again")


def test_shards_with_equal_records_are_taken_over_and_keep_who_made_them(tmp_path: Path) -> None:
    half_made(tmp_path, OTHER, simulate_with_failures)
    resumed = write_fake_set(tmp_path, simulation=simulate_with_failures)
    assert resumed.shards_taken_over == 3
    assert "6 records, simulated again, equal to the bit; they are taken over" in resumed.notes[0]
    found = verify_fake_set(tmp_path, 27, simulation=simulate_with_failures)
    assert (found.mismatches, found.comparison[: len(CLOSE)]) == ((), CLOSE)
    assert len(found.made_by) == 2
    assert f"siggen 0.0.9 (fingerprint {OTHER['fingerprint']})" in found.made_by
    assert found.here in found.made_by


def test_a_set_of_one_version_is_compared_to_the_bit_whatever_cannot_change_one(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    with patch("siggen.sets.verification.environment", lambda: {**environment(), "pyarrow": "0", "siggen": "9"}):
        assert verify_fake_set(tmp_path, 3).comparison == EXACT


def test_a_finished_set_of_another_version_is_extended_only_if_its_records_are_equal(tmp_path: Path) -> None:
    for name, simulation in (("other", simulate_otherwise), ("equal", simulate)):
        write_fake_set(tmp_path / name, simulation=simulation)
        made_by(tmp_path / name, OTHER)
        reseal_manifest(tmp_path / name)
    before = file_bytes(tmp_path / "other")
    with pytest.raises(DatasetError, match=r"(?s)made by siggen 0\.0\.9 .*damaged_area_share.*This is siggen"):
        extended(tmp_path / "other")
    assert file_bytes(tmp_path / "other") == before
    assert extended(tmp_path / "equal").rows == 42


def test_parts_of_two_versions_are_merged_only_if_their_records_are_equal(tmp_path: Path) -> None:
    parts = [tmp_path / "1", tmp_path / "2"]
    for number, (path, simulation) in enumerate(zip(parts, (simulate, simulate_otherwise), strict=True), start=1):
        with fake_physics(simulation), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
            generate_part(fake_config(), path, (number, 2), 0)
    made_by(parts[1], OTHER)
    with fake_physics(), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
        with pytest.raises(DatasetError, match=r"(?s)not mixed.*made by siggen 0\.0\.9 .*Make these parts again"):
            merge(parts, tmp_path / "merged")
        assert not list((tmp_path / "merged").glob("data/*"))
    with fake_physics(simulate_otherwise), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
        generate_part(fake_config(), tmp_path / "again", (1, 2), 0)
        assert merge([tmp_path / "again", parts[1]], tmp_path / "merged").rows == 30


def test_the_fingerprint_stands_in_every_sidecar_and_in_the_manifest(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
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
