"""Generation: bytes that depend on the configuration alone, failures that are listed, work that is never done twice."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

from siggen.dataset.environment import environment
from siggen.dataset.reading import open as open_set
from siggen.dataset.shard import about_of, unpacked
from siggen.errors import EngineError
from siggen.file_writing import LEFTOVER_SUFFIX
from siggen.sets.generation import generate
from siggen.sets.loss_limit import LossError
from tests.dataset.fake_set import (
    FAKE_FILES,
    copy_fake_set,
    fake_config,
    fake_physics,
    file_bytes,
    simulate_none,
    simulate_with_a_bug,
    simulate_with_failures,
    write_fake_set,
)


@pytest.fixture(scope="module")
def reference(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "reference"
    write_fake_set(path)
    return path


def test_bytes_do_not_depend_on_the_number_of_workers(reference: Path, tmp_path: Path) -> None:
    assert write_fake_set(tmp_path, workers=2).records_made == 30  # none twice
    assert file_bytes(tmp_path) == file_bytes(reference)


def test_a_finished_set_is_left_alone(reference: Path, tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    times = {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*")}
    again = write_fake_set(tmp_path)
    assert again.was_finished
    assert (again.rows, again.records_made) == (30, 0)
    assert {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*")} == times


LOST = [name for name in FAKE_FILES if name != "config.yaml"]
ONE_OF_EACH = sorted({name.split("/")[0]: name for name in LOST}.values())


@pytest.mark.parametrize("name", ONE_OF_EACH)
def test_a_lost_file_is_made_again_with_the_same_bytes(reference: Path, tmp_path: Path, name: str) -> None:
    copy_fake_set(tmp_path)
    (tmp_path / name).unlink()
    again = write_fake_set(tmp_path)
    assert not again.was_finished
    assert again.records_made == (6 if name.startswith("data/") else 0)
    assert again.shards_taken_over == 5 - again.records_made // 6
    assert file_bytes(tmp_path) == file_bytes(reference)


def damaged(shard: Path) -> None:
    content = bytearray(shard.read_bytes())
    content[len(content) // 2] ^= 1
    shard.write_bytes(content)


def torn(shard: Path) -> None:
    shard.write_bytes(shard.read_bytes()[:-100])


def of_another_record(shard: Path) -> None:
    shard.write_bytes(shard.with_name("train-00002.parquet").read_bytes())


def strange(shard: Path) -> None:
    shard.write_bytes(b"PAR1 and nothing else")


@pytest.mark.parametrize("change", [damaged, torn, of_another_record, strange])
def test_a_shard_that_is_not_as_it_was_made_is_made_again_and_that_is_said(
    reference: Path, tmp_path: Path, change: Any
) -> None:
    copy_fake_set(tmp_path)
    (tmp_path / "manifest.json").unlink()
    change(tmp_path / "data/train-00001.parquet")
    again = write_fake_set(tmp_path)
    assert (again.records_made, again.shards_taken_over) == (6, 4)
    assert [note.partition(":")[0] for note in again.notes] == ["train-00001 is made again"]
    assert file_bytes(tmp_path) == file_bytes(reference)


def test_shards_of_another_version_are_made_again_and_said_by_whom_they_were(reference: Path, tmp_path: Path) -> None:
    other = {**environment(), "siggen": "0.0.9", "fingerprint": "0123456789abcdef"}
    with patch("siggen.sets.set_run.environment", lambda: other), pytest.raises(EngineError):
        write_fake_set(tmp_path, simulation=simulate_with_a_bug)
    resumed = write_fake_set(tmp_path)
    assert (resumed.records_made, resumed.shards_taken_over) == (30, 0)
    assert resumed.notes == ("train-00000 is made again: made by siggen 0.0.9 (fingerprint 0123456789abcdef)",)
    assert file_bytes(tmp_path) == file_bytes(reference)


def test_the_maker_stands_in_every_shard_and_in_the_manifest(reference: Path) -> None:
    own = environment()["fingerprint"]
    for file in (reference / "data").iterdir():
        assert about_of(unpacked(file.read_bytes()))["fingerprint"] == own
    assert open_set(reference).manifest["environment"]["fingerprint"] == own


def test_half_written_files_of_a_killed_run_are_removed(tmp_path: Path) -> None:
    leftover = tmp_path / f"data/.train-00000.parquet.0123abcd{LEFTOVER_SUFFIX}"
    leftover.parent.mkdir()
    leftover.write_bytes(b"half")
    write_fake_set(tmp_path)
    assert not leftover.exists()


def test_failed_records_are_no_rows_but_listed_everywhere(tmp_path: Path) -> None:
    generation = write_fake_set(tmp_path, simulation=simulate_with_failures)
    assert [failure.record_id for failure in generation.failures] == [3, 8, 10]
    assert generation.rows == 27
    dataset = open_set(tmp_path)
    assert sorted(dataset.labels()["record_id"].to_pylist()) == [i for i in range(30) if i not in (3, 8, 10)]
    assert len(dataset.manifest["failures"]) == 3
    again = write_fake_set(tmp_path, simulation=simulate_with_failures)
    assert again.was_finished
    assert again.failures == generation.failures


def test_a_set_of_which_every_record_fails_is_still_a_set(tmp_path: Path) -> None:
    generation = write_fake_set(tmp_path, simulation=simulate_none)
    assert generation.rows == 0
    assert len(generation.failures) == 30
    assert open_set(tmp_path).labels().num_rows == 0


def test_a_fault_of_the_program_names_the_record_and_keeps_what_is_committed(tmp_path: Path) -> None:
    with pytest.raises(EngineError, match=r"record 8 raised ZeroDivisionError"):
        write_fake_set(tmp_path, simulation=simulate_with_a_bug)
    assert not (tmp_path / "manifest.json").exists()
    assert not list(tmp_path.rglob(f"*{LEFTOVER_SUFFIX}"))
    again = write_fake_set(tmp_path)
    assert again.shards_taken_over == len(again.failures) + (30 - again.records_made) // 6


def test_progress_counts_every_record_once(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []

    def show(done: int, total: int) -> None:
        seen.append((done, total))

    with fake_physics():
        generate(fake_config(), tmp_path, 0, show)
    assert seen[-1] == (30, 30)
    assert [done for done, _ in seen] == sorted({done for done, _ in seen})


@pytest.mark.parametrize("threads", [1, 3])
def test_a_set_does_not_depend_on_the_executor(reference: Path, tmp_path: Path, threads: int) -> None:
    with ThreadPoolExecutor(threads) as mine:
        write_fake_set(tmp_path, executor=mine)
        assert mine.submit(abs, -1).result() == 1  # whoever gave it ends it
    assert file_bytes(tmp_path) == file_bytes(reference)


def test_a_run_that_loses_more_of_a_state_than_allowed_stops_keeps_its_shards_and_goes_on_when_told(
    reference: Path, tmp_path: Path
) -> None:
    """Of 10 records of `slight` the second failure, record 8, is one too many for a tenth; both shards stay."""
    with pytest.raises(LossError, match=r"of the 10 records of state slight 2 could not.*share of 0\.1.*Record 3: div"):
        write_fake_set(tmp_path, simulation=simulate_with_failures, allowed_loss=0.1)
    assert (tmp_path / "data/train-00000.parquet").exists()
    assert not (tmp_path / "manifest.json").exists()
    # resumed with the same share it stops again
    with pytest.raises(LossError, match="state slight 2"):
        write_fake_set(tmp_path, simulation=simulate_with_failures, allowed_loss=0.1)
    generation = write_fake_set(tmp_path, simulation=simulate_with_failures, allowed_loss=0.2)
    assert (len(generation.failures), generation.shards_taken_over) == (3, 2)


def test_an_extension_stops_at_the_loss_of_the_whole_set(tmp_path: Path) -> None:
    with fake_physics(simulate_with_failures):
        generate(fake_config(), tmp_path, 0, allowed_loss=1.0)
    with fake_physics(simulate_none):
        with pytest.raises(LossError, match="of the 12 records of state slight 4"):
            generate(fake_config(specimens=6), tmp_path, 0, allowed_loss=0.3)
        assert len(generate(fake_config(specimens=6), tmp_path, 0, allowed_loss=0.4).failures) == 9
