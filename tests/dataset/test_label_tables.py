"""metadata/ and damage/ say what the shards say."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from siggen.columns.record import damage_schema, label_schema
from tests.dataset.fake_set import damage_rows, fake_config, simulate_with_failures, write_fake_set

CONFIG = fake_config()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sets") / "fake"
    write_fake_set(path, simulation=simulate_with_failures)
    return path


@pytest.mark.parametrize("split", ["train", "validation", "test"])
def test_metadata_equals_the_labels_in_the_shards(folder: Path, split: str) -> None:
    metadata = pq.read_table(folder / f"metadata/{split}.parquet")
    assert metadata.schema.equals(label_schema(CONFIG), check_metadata=True)
    shards = sorted((folder / "data").glob(f"{split}-*.parquet"))
    rows = [row for path in shards for row in pq.read_table(path, columns=metadata.column_names).to_pylist()]
    assert metadata.to_pylist() == rows
    assert all(row["split"] == split for row in rows)


@pytest.mark.parametrize("split", ["train", "validation", "test"])
def test_damage_holds_the_rows_of_every_record_that_is_there(folder: Path, split: str) -> None:
    damage = pq.read_table(folder / f"damage/{split}.parquet")
    assert damage.schema.equals(damage_schema(CONFIG), check_metadata=True)
    ids = pq.read_table(folder / f"metadata/{split}.parquet", columns=["record_id"])["record_id"].to_pylist()
    assert damage.to_pylist() == [row for i in ids for row in damage_rows(CONFIG, i)]
