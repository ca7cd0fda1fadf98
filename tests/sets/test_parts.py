"""Parts of a set, made by jobs that know nothing of each other in one folder: the bytes of a set made at once."""

from __future__ import annotations

import shutil
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from siggen.errors import DatasetError, EngineError, UsageError
from siggen.sets.generation import generate, part_of
from tests.dataset.fake_set import (
    copy_fake_set,
    fake_config,
    fake_physics,
    file_bytes,
    simulate_with_a_bug,
    simulate_with_failures,
    write_fake_set,
)


@pytest.mark.parametrize("count", [1, 3, 7])
def test_parts_in_any_order_and_a_call_without_give_the_bytes_of_a_set_made_at_once(tmp_path: Path, count: int) -> None:
    failing = {"simulation": simulate_with_failures}
    write_fake_set(tmp_path / "at_once", **failing)
    made = [write_fake_set(tmp_path / "set", part=(n, count), **failing) for n in range(count, 0, -1)]
    assert sum(one.records_made for one in made) == 30
    assert not (tmp_path / "set/manifest.json").exists()
    ended = write_fake_set(tmp_path / "set", **failing)
    assert (ended.rows, len(ended.failures), ended.records_made, ended.shards_taken_over) == (27, 3, 0, 5)
    assert file_bytes(tmp_path / "set") == file_bytes(tmp_path / "at_once")
    assert write_fake_set(tmp_path / "set", part=(1, count)).was_finished


def test_parts_write_at_the_same_time_and_folders_of_parts_are_copied_together(tmp_path: Path) -> None:
    copy_fake_set(tmp_path / "at_once")
    # threads see signals no more than jobs do; in each of them the stand-in would stay when the other one ends first
    with fake_physics(), ThreadPoolExecutor(2) as both:
        list(both.map(lambda number: generate(fake_config(), tmp_path / "set", 0, part=(number, 2)), (1, 2)))
    write_fake_set(tmp_path / "set")
    assert file_bytes(tmp_path / "set") == file_bytes(tmp_path / "at_once")
    for number in (1, 2):
        write_fake_set(tmp_path / str(number), part=(number, 2))
    shutil.copytree(tmp_path / "2", tmp_path / "1", dirs_exist_ok=True)
    assert write_fake_set(tmp_path / "1").records_made == 0
    assert file_bytes(tmp_path / "1") == file_bytes(tmp_path / "at_once")


def test_a_part_that_stopped_or_was_lost_is_made_by_whoever_comes_next(tmp_path: Path) -> None:
    with pytest.raises(EngineError):
        write_fake_set(tmp_path / "set", part=(2, 2), simulation=simulate_with_a_bug)
    write_fake_set(tmp_path / "set", part=(1, 2))
    assert write_fake_set(tmp_path / "set").records_made == 12
    copy_fake_set(tmp_path / "at_once")
    assert file_bytes(tmp_path / "set") == file_bytes(tmp_path / "at_once")


def test_a_set_grows_by_parts(tmp_path: Path) -> None:
    copy_fake_set(tmp_path / "set")
    for number in (1, 2):
        write_fake_set(tmp_path / "set", fake_config(specimens=9), part=(number, 2))
    assert write_fake_set(tmp_path / "set", fake_config(specimens=9)).records_made == 0
    copy_fake_set(tmp_path / "at_once")
    write_fake_set(tmp_path / "at_once", fake_config(specimens=9))
    assert file_bytes(tmp_path / "set") == file_bytes(tmp_path / "at_once")


def test_a_part_of_another_set_is_refused(tmp_path: Path) -> None:
    write_fake_set(tmp_path, part=(1, 2))
    with pytest.raises(DatasetError, match="holds another data set"):
        write_fake_set(tmp_path, fake_config(seed=8), part=(2, 2))


@pytest.mark.parametrize("text", ["", "3", "0/2", "3/2", "1/0", "-1/2", "a/b", "1/2/3", "1.0/2", "1/9999999999"])
def test_what_is_no_part_is_refused(text: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--part: received"):
        part_of(text)
    assert part_of("3/16") == (3, 16)
    with pytest.raises(UsageError, match="part: received 3 of 2"):
        write_fake_set(tmp_path, part=(3, 2))
