"""Sets at s3://...: the bytes of those in folders, whatever makes, interrupts, extends, reads or shows them."""

from __future__ import annotations

import pickle
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest

import siggen
from siggen.dataset.object_store import ObjectStore
from siggen.dataset.storage import LocalFolder
from siggen.dataset.storage_at import storage_at
from siggen.errors import DatasetError, EngineError
from siggen.sets.generation import generate
from siggen.sets.verification import verify
from tests.dataset.fake_set import (
    FAKE_FILES,
    copy_fake_set,
    fake_config,
    fake_physics,
    file_bytes,
    simulate,
    simulate_with_a_bug,
    write_fake_set,
)
from tests.dataset.s3_server import BUCKET, digests, object_bytes, s3_server

PLACE = f"s3://{BUCKET}/a/set"
SHORT = ("duration_s=0.5", "specimens=1", "states={healthy: {}}", "repeats=1")


@pytest.fixture(autouse=True)
def served(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with s3_server(monkeypatch):
        yield


def write(place: str, simulation=simulate, **changes):
    with fake_physics(simulation):
        return generate(fake_config(**changes), place, 0)


def test_a_set_has_the_bytes_of_one_in_a_folder_and_is_verified_and_read_there(tmp_path: Path) -> None:
    puts: list[str] = []
    real = ObjectStore.put

    def counted(store: ObjectStore, name: str, content: bytes) -> None:
        puts.append(name)
        real(store, name, content)

    with patch.object(ObjectStore, "put", counted):
        made = write(PLACE)
    assert str(made.path) == PLACE
    assert sorted(puts) == sorted([*FAKE_FILES, "config.yaml"])  # one each; config.yaml begins and ends the work
    assert puts[-1] == "manifest.json"
    copy_fake_set(tmp_path / "set")
    assert digests(object_bytes(PLACE)) == digests(file_bytes(tmp_path / "set"))
    with fake_physics():
        found = verify(PLACE, 2, workers=0)
    assert (found.mismatches, len(found.records), found.path) == ((), 2, PLACE)
    here, there = siggen.open(tmp_path / "set"), siggen.open(PLACE)
    assert there.labels().equals(here.labels())
    assert there.record(7)["tacho_s"].tolist() == here.record(7)["tacho_s"].tolist()
    assert [str(batch.schema) for batch in there.records()] == [str(batch.schema) for batch in here.records()]
    assert write(PLACE).was_finished


def test_a_run_that_stopped_is_continued_and_a_damaged_shard_is_made_again(tmp_path: Path) -> None:
    with pytest.raises(EngineError):
        write(PLACE, simulate_with_a_bug)
    store = storage_at(PLACE)
    assert not store.exists("manifest.json")
    whole = store.get("data/train-00000.parquet")
    store.put("data/train-00000.parquet", whole[:100] + bytes([whole[100] ^ 1]) + whole[101:])
    kept = len(store.names("data"))
    assert write(PLACE).shards_taken_over == kept - 1
    copy_fake_set(tmp_path / "set")
    assert digests(object_bytes(PLACE)) == digests(file_bytes(tmp_path / "set"))


def test_a_changed_bit_is_found_by_the_reader_in_words() -> None:
    write(PLACE)
    store = storage_at(PLACE)
    whole = store.get("data/train-00001.parquet")
    store.put("data/train-00001.parquet", whole[:500] + bytes([whole[500] ^ 4]) + whole[501:])
    with pytest.raises(DatasetError, match=rf"{PLACE}/data/train-00001.parquet is not the promised file .*SHA-256"):
        list(siggen.open(PLACE).records())


def test_parts_make_a_set_that_grows_there(tmp_path: Path) -> None:
    for number in (1, 2):
        write_fake_set(PLACE, part=(number, 2))
    assert write_fake_set(PLACE).records_made == 0
    for place in (PLACE, tmp_path / "set"):
        write_fake_set(place)
        write_fake_set(place, fake_config(specimens=6))
    assert digests(object_bytes(PLACE)) == digests(file_bytes(tmp_path / "set"))


def test_a_random_record_is_one_request(monkeypatch: pytest.MonkeyPatch) -> None:
    write(PLACE)
    dataset, asked = siggen.open(PLACE), []
    dataset.labels()
    real = ObjectStore.get
    monkeypatch.setattr(ObjectStore, "get", lambda store, *said: asked.append(said[0]) or real(store, *said))
    for record_id in (7, 8, 20):
        dataset.record(record_id)
    assert len(asked) == 2  # 7 and 8 are of one gearbox, whose shard stays decoded


def upload(folder: Path, place: str) -> str:
    source, target = LocalFolder(folder), storage_at(place)
    for name in source.names():
        target.put(name, source.get(name))
    return place


def run(main, monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr(sys, "argv", ["command", *arguments])
    try:
        main()
    except SystemExit as stop:
        return int(stop.code or 0)
    return 0


def test_commands_take_a_place_for_a_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import diagnostics.cli.app
    import siggen.cli.app

    kept = tmp_path / "kept"
    generate(siggen.load_config("quickstart", SHORT), kept, 0)
    place = upload(kept, PLACE)
    monkeypatch.chdir(tmp_path)
    assert run(siggen.cli.app.main, monkeypatch, "verify", place, "--sample", "0") == 0
    assert f"{PLACE}: " in capsys.readouterr().out
    assert run(siggen.cli.app.main, monkeypatch, "show", place, "--record", "0") == 0
    assert f"Record 0 of {PLACE}" in capsys.readouterr().out
    assert run(diagnostics.cli.app.main, monkeypatch, "indicators", place, "--out", "there.csv") == 0
    assert run(diagnostics.cli.app.main, monkeypatch, "indicators", str(kept), "--out", "here.csv") == 0
    assert (tmp_path / "there.csv").read_bytes() == (tmp_path / "here.csv").read_bytes()
    assert run(diagnostics.cli.app.main, monkeypatch, "explore", place) == 0
    assert (tmp_path / "set_explore.html").stat().st_size > 10_000
    capsys.readouterr()
    assert run(siggen.cli.app.main, monkeypatch, "show", f"s3://{BUCKET}/none", "--record", "1") == 2
    assert f"s3://{BUCKET}/none: there is no data set here" in capsys.readouterr().err


def test_a_set_that_went_to_a_worker_gives_its_shards_there(tmp_path: Path) -> None:
    """What the loader does: `WindowStream` sends the set to processes, which read shards in any order."""
    write(str(tmp_path / "set"))
    here = siggen.open(tmp_path / "set")
    there = pickle.loads(pickle.dumps(siggen.open(upload(tmp_path / "set", PLACE))))
    assert here.shards() == there.shards()
    for shard in here.shards("train")[::-1]:
        assert there.shard_rows(shard).equals(here.shard_rows(shard))
