"""Parts of a set, made apart and put together: the bytes of a set generated at once, whatever was lost on the way."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from siggen.errors import DatasetError, EngineError, UsageError
from siggen.gearbox import plan
from siggen.sets.parts import generate_part, merge, part_of
from siggen.sets.set_run import Generation
from tests.dataset.fake_set import (
    copy_fake_set,
    fake_config,
    fake_physics,
    file_bytes,
    simulate,
    simulate_with_a_bug,
    simulate_with_failures,
    write_fake_set,
)


def write_part(path: Path, part: tuple[int, int], simulation: Any = simulate, **changes: Any) -> Generation:
    with fake_physics(simulation), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
        return generate_part(fake_config(**changes), path, part, 0, allowed_loss=1.0)


def merge_fake(parts: list[Path], out: Path) -> Generation:
    with fake_physics(), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
        return merge(parts, out)


@pytest.mark.parametrize("count", [1, 2, 3, 7])
def test_parts_and_merge_give_the_bytes_of_a_set_generated_at_once(tmp_path: Path, count: int) -> None:
    write_fake_set(tmp_path / "at_once", simulation=simulate_with_failures)
    parts = [tmp_path / f"part{number}" for number in range(1, count + 1)]
    made = [write_part(path, (n, count), simulate_with_failures) for n, path in enumerate(parts, start=1)]
    assert sum(one.records_made for one in made) == 30
    assert not any((path / "manifest.json").exists() for path in parts)
    before = [file_bytes(path) for path in parts]
    merged = merge_fake(parts[::-1], tmp_path / "merged")
    assert (merged.rows, len(merged.failures), merged.records_made) == (27, 3, 0)
    assert file_bytes(tmp_path / "merged") == file_bytes(tmp_path / "at_once")
    assert [file_bytes(path) for path in parts] == before
    assert merge_fake(parts, tmp_path / "merged").was_finished


@pytest.mark.parametrize("can_link", [True, False])
def test_merged_shards_take_no_second_place_and_one_that_is_made_again_leaves_its_part(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, can_link: bool
) -> None:
    def refused(*_: object) -> None:
        raise OSError(errno.EXDEV, "another file system")

    if not can_link:
        monkeypatch.setattr(os, "link", refused)
    write_part(tmp_path / "1", (1, 1))
    merge_fake([tmp_path / "1"], tmp_path / "out")
    name = "data/train-00001.parquet"
    assert (tmp_path / "1" / name).samefile(tmp_path / "out" / name) == can_link
    before = file_bytes(tmp_path / "1")
    (tmp_path / "out" / name).unlink()
    assert write_fake_set(tmp_path / "out").records_made == 6
    assert file_bytes(tmp_path / "1") == before
    assert (tmp_path / "out" / name).read_bytes() == before[name]


def test_a_part_that_stopped_continues_and_a_folder_of_parts_can_become_the_set(tmp_path: Path) -> None:
    with pytest.raises(EngineError):
        write_part(tmp_path / "2", (2, 2), simulate_with_a_bug)
    write_part(tmp_path / "2", (2, 2))
    write_part(tmp_path / "1", (1, 2))
    merge_fake([tmp_path / "1", tmp_path / "2"], tmp_path / "1")
    copy_fake_set(tmp_path / "at_once")
    assert file_bytes(tmp_path / "1") == file_bytes(tmp_path / "at_once")


def test_a_missing_or_damaged_part_is_named_by_its_shards(tmp_path: Path) -> None:
    write_part(tmp_path / "1", (1, 2))
    write_part(tmp_path / "2", (2, 2))
    with pytest.raises(DatasetError, match=r"3 shards of 5 are missing or damaged in all parts \(train-00000"):
        merge_fake([tmp_path / "2"], tmp_path / "out")
    shard = tmp_path / "1/data/train-00000.parquet"
    content = bytearray(shard.read_bytes())
    content[len(content) // 2] ^= 1
    shard.write_bytes(content)
    with pytest.raises(DatasetError, match=r"1 shard of 5 is missing or damaged in all parts \(train-00000\)"):
        merge_fake([tmp_path / "1", tmp_path / "2"], tmp_path / "out")
    assert not (tmp_path / "out/manifest.json").exists()
    assert write_part(tmp_path / "1", (1, 2)).records_made == 6
    merge_fake([tmp_path / "1", tmp_path / "2"], tmp_path / "out")


def test_parts_of_different_sets_are_refused(tmp_path: Path) -> None:
    write_part(tmp_path / "1", (1, 2))
    write_part(tmp_path / "2", (2, 2), seed=8)
    with pytest.raises(DatasetError, match="a part of another set"):
        merge_fake([tmp_path / "1", tmp_path / "2"], tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("text", ["", "3", "0/2", "3/2", "1/0", "-1/2", "a/b", "1/2/3", "1.0/2", "1/9999999999"])
def test_what_is_no_part_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--part: received"):
        part_of(text)
    assert part_of("3/16") == (3, 16)
