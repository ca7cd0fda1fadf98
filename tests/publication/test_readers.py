"""Other readers read the values of a published folder bit for bit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.publication.conftest import SIGNAL


def test_pyarrow_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    import pyarrow.dataset as ds

    table = ds.dataset(published / "data", format="parquet").to_table().sort_by("record_id")
    signals = table[SIGNAL].combine_chunks().flatten().to_numpy().reshape(4, -1)
    assert signals.tobytes() == expected["signals"].tobytes()
    assert table["tacho_s"].to_pylist() == expected["tacho_s"]


def test_pandas_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.concat(pandas.read_parquet(file) for file in sorted((published / "data").glob("*.parquet")))
    assert np.stack(frame[SIGNAL].tolist()).tobytes() == expected["signals"].tobytes()
    assert frame["state"].tolist() == expected["state"]


def test_polars_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    polars = pytest.importorskip("polars")
    frame = polars.scan_parquet(published / "data" / "*.parquet").sort("record_id").collect()
    assert np.stack(frame[SIGNAL].to_list()).astype(np.float32).tobytes() == expected["signals"].tobytes()
    assert frame["speed_hz"].to_list() == expected["speed_hz"]


def test_duckdb_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    duckdb = pytest.importorskip("duckdb")
    query = f"select {SIGNAL}, state, tacho_s from read_parquet('{published}/data/*.parquet') order by record_id"
    rows = duckdb.sql(query).fetchall()
    assert np.array([row[0] for row in rows], np.float32).tobytes() == expected["signals"].tobytes()
    assert [(row[1], list(row[2])) for row in rows] == list(zip(expected["state"], expected["tacho_s"], strict=True))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("streaming", [False, True])
def test_datasets_reads_the_values_and_the_class_labels(
    published: Path, expected: dict[str, Any], tmp_path: Path, streaming: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    datasets = pytest.importorskip("datasets")
    found = datasets.load_dataset(
        str(published), "signals", split="train", streaming=streaming, cache_dir=str(tmp_path)
    )
    rows = sorted(found, key=lambda row: row["record_id"])
    assert np.array([row[SIGNAL] for row in rows], np.float32).tobytes() == expected["signals"].tobytes()
    state = found.features["state"]
    assert [state.int2str(row["state"]) for row in rows] == expected["state"]


@pytest.mark.filterwarnings("ignore")
def test_croissant_is_without_error_or_warning_and_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    mlcroissant = pytest.importorskip("mlcroissant")
    found = mlcroissant.Dataset(str(published / "croissant.json"), mapping={"repository": str(published)})
    issues = found.metadata.ctx.issues
    assert (set(issues.errors), set(issues.warnings)) == (set(), set())
    rows = sorted(found.records("signals"), key=lambda row: row["signals/record_id"])
    signals = np.array([row[f"signals/{SIGNAL}"] for row in rows], np.float32)
    assert signals.tobytes() == expected["signals"].tobytes()
    assert [row["signals/state"].decode() for row in rows] == expected["state"]
    for view, count in (("labels", 4), ("damage", 2), ("internals", 4)):
        assert len(list(found.records(view))) == count


@pytest.mark.filterwarnings("ignore")
def test_torch_gets_the_values_in_batches(
    published: Path, expected: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HF_HUB_OFFLINE", "1")
    datasets, torch = pytest.importorskip("datasets"), pytest.importorskip("torch")
    found = datasets.load_dataset(str(published), "signals", split="train", cache_dir=str(tmp_path))
    columns = found.select_columns(["record_id", SIGNAL]).with_format("torch")
    batches = list(torch.utils.data.DataLoader(columns, batch_size=2))
    assert torch.cat([batch["record_id"] for batch in batches]).tolist() == [0, 1, 2, 3]
    signals = torch.cat([batch[SIGNAL] for batch in batches])
    assert (signals.dtype, signals.numpy().tobytes()) == (torch.float32, expected["signals"].tobytes())


@pytest.mark.filterwarnings("ignore")
def test_dask_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    pytest.importorskip("distributed")
    pytest.importorskip("pandas")
    frames = pytest.importorskip("dask.dataframe")
    frame = frames.read_parquet(published / "data").compute(scheduler="synchronous").sort_values("record_id")
    assert np.stack(frame[SIGNAL].tolist()).astype(np.float32).tobytes() == expected["signals"].tobytes()
    assert frame["state"].tolist() == expected["state"]


@pytest.mark.slow  # a cluster of one worker has to start
@pytest.mark.filterwarnings("ignore")
def test_ray_data_reads_the_values(published: Path, expected: dict[str, Any]) -> None:
    ray = pytest.importorskip("ray")
    options = {"num_cpus": 1, "include_dashboard": False, "log_to_driver": False, "object_store_memory": 100 << 20}
    ray.init(address="local", configure_logging=False, **options)
    try:
        found = pytest.importorskip("ray.data").read_parquet(str(published / "data"))
        rows = sorted(found.take_all(), key=lambda row: row["record_id"])
    finally:
        ray.shutdown()
    assert np.array([row[SIGNAL] for row in rows], np.float32).tobytes() == expected["signals"].tobytes()
    assert [row["state"] for row in rows] == expected["state"]
