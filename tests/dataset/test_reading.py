"""Reading a set: the same rows by every door, clear refusals, and no physics."""

from __future__ import annotations

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from siggen.columns.record import signal_matrix
from siggen.dataset import reading
from siggen.dataset.reading import Dataset
from siggen.dataset.reading import open as open_set
from siggen.errors import DatasetError, UsageError
from siggen.gearbox.plan import planned_record, split_of
from tests.dataset.fake_set import copy_fake_set, fake_config, fake_record, simulate_with_failures, write_fake_set

CONFIG = fake_config()
SIGNAL = "accel_bearing_vertical_m_s2"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "fake"
    write_fake_set(path)
    return path


@pytest.fixture(scope="module")
def dataset(folder: Path) -> Dataset:
    return open_set(folder)


def test_every_record_is_read_back_bit_for_bit(dataset: Dataset) -> None:
    for record_id in range(30):
        expected = fake_record(CONFIG, planned_record(CONFIG, record_id))
        found = dataset.record(record_id)
        for channel in dataset.channels:
            assert found[channel.column].tobytes() == expected.channels[channel.name].tobytes()
            assert found[channel.column].dtype == np.float32
        assert {name: found[name] for name in expected.labels} == dict(expected.labels)
        assert found["tacho_s"].tolist() == expected.tacho_s.tolist()
        assert found["split"] == split_of(CONFIG, found["specimen_id"])


def test_labels_and_records_come_in_the_same_order(dataset: Dataset) -> None:
    for split in (None, *dataset.splits):
        ids = dataset.labels(split, ["record_id"])["record_id"].to_pylist()
        batches = list(dataset.records(split, ["record_id", SIGNAL]))
        assert [i for batch in batches for i in batch["record_id"].to_pylist()] == ids
    assert sorted(dataset.labels()["record_id"].to_pylist()) == list(range(30))
    assert set(dataset.labels("test")["split"].to_pylist()) == {"test"}


@pytest.mark.parametrize("batch_rows", [1, 2, 5, None])
def test_batches_have_at_most_the_rows_asked_for_and_lose_none(dataset: Dataset, batch_rows: int | None) -> None:
    batches = list(dataset.records("train", [SIGNAL], batch_rows))
    assert max(batch.num_rows for batch in batches) <= (batch_rows or 6)
    signals = np.concatenate([signal_matrix(batch[SIGNAL]) for batch in batches])
    assert signals.shape == (18, 512)
    first = dataset.labels("train")["record_id"][0].as_py()
    assert np.array_equal(signals[0], dataset.record(first)[SIGNAL])


def test_row_groups_of_what_was_read_are_known_without_a_second_reading(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, asked, content = open_set(folder).row_groups(), list[str](), Dataset.content

    def counted(self: Dataset, name: str) -> bytes:
        asked.append(name)
        return content(self, name)

    monkeypatch.setattr(Dataset, "content", counted)
    read = open_set(folder)
    assert sum(batch.num_rows for batch in read.records()) == sum(map(sum, whole))
    assert read.row_groups() == whole == tuple((shard.rows,) for shard in read.shards())
    assert len(asked) == len(set(asked)) == 1 + len(whole)  # config.yaml, and every shard once


def test_columns_are_those_asked_for(dataset: Dataset) -> None:
    assert dataset.labels(columns=["state", "record_id"]).column_names == ["state", "record_id"]
    assert SIGNAL not in dataset.labels().column_names
    assert next(dataset.records(columns=["mesh_hz"])).schema.names == ["mesh_hz"]


def test_a_split_is_records_by_number_and_arrays_for_a_fit(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "KEPT_BYTES", 1)  # the shard that was asked for last alone
    dataset = open_set(folder)
    train = dataset["train"]
    assert (len(dataset), len(train)) == (30, 18)
    values, states, groups = train.arrays("bearing_vertical")
    assert (values.shape, values.dtype) == ((18, 512), np.float32)
    for number in (17, 0, 9, -1):
        record = train[number]
        assert np.array_equal(record[SIGNAL], values[number])
        assert (record["state"], record["specimen_id"]) == (states[number], groups[number])
        record[SIGNAL][:] = 0.0  # an own copy: what is read again is as it was
        assert np.array_equal(train[number][SIGNAL], values[number])
    assert [record["record_id"] for record in train] == dataset.record_ids("train").tolist()
    assert pickle.loads(pickle.dumps(train))[3]["record_id"] == train[3]["record_id"]
    with pytest.raises(IndexError, match="record 18 of 18 of the split train"):
        train[18]
    with pytest.raises(UsageError, match="no split 0; it has train, validation, test"):
        dataset[0]  # type: ignore[index]
    with pytest.raises(UsageError, match="received 'lid'; allowed are bearing_vertical, bearing_horizontal"):
        train.arrays("lid")


def test_damage_has_one_row_per_pit(dataset: Dataset) -> None:
    damage = dataset.damage()
    labels = dataset.labels()
    assert isinstance(damage, pa.Table)
    assert damage.num_rows == sum(labels["damage_count"].to_pylist()) == 10 * (0 + 2 + 6)
    assert dataset.damage("test").num_rows == sum(dataset.labels("test")["damage_count"].to_pylist())


def test_wrong_names_are_answered_with_the_right_ones(dataset: Dataset) -> None:
    with pytest.raises(UsageError, match="no split 'training'; it has train, validation, test"):
        dataset.labels("training")
    with pytest.raises(UsageError, match="colour"):
        dataset.labels(columns=["colour"])
    with pytest.raises(UsageError, match="colour"):
        next(dataset.records(columns=["colour"]))
    with pytest.raises(UsageError, match="no record 30; it has records 0 to 29"):
        dataset.record(30)


def test_a_failed_record_is_answered_with_its_reason(tmp_path: Path) -> None:
    write_fake_set(tmp_path, simulation=simulate_with_failures)
    dataset = open_set(tmp_path)
    with pytest.raises(UsageError, match=r"record 8 could not be simulated: diverged \(motion left the backlash\)"):
        dataset.record(8)
    assert 8 not in dataset.labels()["record_id"].to_pylist()


def test_reading_loads_neither_physics_nor_the_configuration_model(folder: Path) -> None:
    code = """
import sys, siggen
dataset = siggen.open(sys.argv[1])
dataset.labels(), dataset.damage(), dataset.record(0), next(dataset.records())
slow = {"numba", "scipy", "matplotlib", "torch", "siggen.config", "siggen.gearbox.plan"}
print(sorted(slow & set(sys.modules)))
"""
    done = subprocess.run([sys.executable, "-c", code, str(folder)], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_damaged_shard_is_named_with_the_way_to_mend_it(tmp_path: Path) -> None:
    copy_fake_set(tmp_path / "set")
    shard = tmp_path / "set" / "data" / "train-00000.parquet"
    content = bytearray(shard.read_bytes())
    content[len(content) // 3 : len(content) // 3 + 200] = bytes(200)
    shard.write_bytes(bytes(content))
    with pytest.raises(DatasetError, match=r"(?s)train-00000\.parquet is not the promised file .*`siggen verify"):
        list(open_set(tmp_path / "set").records("train"))


def test_what_cannot_be_read_is_refused_by_the_name_of_its_argument(tmp_path: Path) -> None:
    copy_fake_set(tmp_path / "set")
    dataset = open_set(tmp_path / "set")
    with pytest.raises(UsageError, match=r"^path: received 3; allowed: "):
        open_set(3)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match=r"^shard: received 3; allowed: one of `shards"):
        dataset.shard_rows(3)  # type: ignore[arg-type]
    for rows in (0, -1, 1.5):
        with pytest.raises(UsageError, match=r"^batch_rows: received .*; allowed: 1, 2"):
            next(dataset.records(batch_rows=rows))  # type: ignore[arg-type]
