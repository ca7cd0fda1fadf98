"""Extended sets: the records of a set generated at once, shards that stay as they are, and no way to lose either."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pyarrow as pa
import pytest

from siggen.dataset.reading import open as open_set
from siggen.errors import ConfigError, DatasetError, EngineError, UsageError
from siggen.gearbox import plan
from siggen.sets.extension import extend
from siggen.sets.set_run import Generation
from tests.dataset.fake_set import (
    fake_config,
    fake_physics,
    file_bytes,
    simulate,
    simulate_with_a_bug,
    verify_fake_set,
)


def extend_fake_set(path: Path, specimens: int | str, simulation: Any = simulate, group: int = 30_000) -> Generation:
    """Extend with the stand-in; two gearboxes per full shard, so that sets end in partial ones."""
    with fake_physics(simulation), patch.multiple(plan, SHARD_BYTES=group, GROUP_CHANNEL_BYTES=4_096):
        return extend(path, specimens, 0)


def write(path: Path, specimens: int) -> Path:
    from siggen.sets.generation import generate

    with fake_physics(), patch.multiple(plan, SHARD_BYTES=30_000, GROUP_CHANNEL_BYTES=4_096):
        generate(fake_config(specimens=specimens), path, 0)
    return path


@pytest.fixture(scope="module")
def seven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set of seven gearboxes; tests that change it copy it."""
    return write(tmp_path_factory.mktemp("seven") / "set", 7)


@pytest.fixture(scope="module")
def thirteen(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set of thirteen, made at once."""
    return write(tmp_path_factory.mktemp("thirteen") / "set", 13)


@pytest.fixture(scope="module")
def extended(seven: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The set of seven, extended by six."""
    folder = shutil.copytree(seven, tmp_path_factory.mktemp("extended") / "set")
    extend_fake_set(folder, "+6")
    return folder


def rows(path: Path) -> dict[str, list[dict[str, Any]]]:
    """Return everything a reader sees, by record: signals, labels, damage."""
    dataset = open_set(path)
    found = pa.concat_tables([pa.Table.from_batches([batch]) for batch in dataset.records()]).sort_by("record_id")
    damage = dataset.damage().sort_by([("record_id", "ascending"), ("face_mm", "ascending")])
    return {
        "records": found.to_pylist(),
        "labels": dataset.labels().sort_by("record_id").to_pylist(),
        "damage": damage.to_pylist(),
    }


@pytest.mark.parametrize("steps", [["+6"], ["+1", "+2", 13]], ids=str)
def test_an_extended_set_holds_the_records_of_one_generated_at_once(
    seven: Path, thirteen: Path, tmp_path: Path, steps: list[Any]
) -> None:
    shutil.copytree(seven, tmp_path / "grown")
    for step in steps:
        before = file_bytes(tmp_path / "grown")
        made = extend_fake_set(tmp_path / "grown", step)
        after = file_bytes(tmp_path / "grown")
        kept = [name for name in before if name.startswith(("data/", "shards/"))]
        assert {name: after[name] for name in kept} == {name: before[name] for name in kept}
        assert made.records_made < 6 * 13
    assert rows(tmp_path / "grown") == rows(thirteen)
    grown, at_once = open_set(tmp_path / "grown").manifest, open_set(thirteen).manifest
    assert (grown["specimens"], grown["rows"], grown["identity"]) == (13, 78, at_once["identity"])
    assert verify_fake_set(tmp_path / "grown", 5).mismatches == ()
    assert "13 specimens" in (tmp_path / "grown/README.md").read_text()


def test_the_set_stays_readable_while_it_grows_and_the_same_call_continues(
    seven: Path, thirteen: Path, tmp_path: Path
) -> None:
    shutil.copytree(seven, tmp_path / "set")

    def fails_late(config: Any, ids: Any) -> Any:
        if 6 * 10 in ids:
            raise ZeroDivisionError("a bug")
        return simulate(config, ids)

    before = rows(tmp_path / "set")
    with pytest.raises(EngineError, match="record 60"):
        extend_fake_set(tmp_path / "set", "+6", fails_late)
    assert rows(tmp_path / "set") == before
    with pytest.raises(UsageError, match="an extension to 13 specimens was begun"):
        extend_fake_set(tmp_path / "set", "+3")
    again = extend_fake_set(tmp_path / "set", "+6")
    assert again.records_made < 36
    assert rows(tmp_path / "set") == rows(thirteen)


@pytest.mark.parametrize("name", ["manifest.json", "metadata/train.parquet", "data/train-00001.parquet", "README.md"])
def test_a_lost_file_of_an_extended_set_is_made_again_by_generate(extended: Path, tmp_path: Path, name: str) -> None:
    from siggen.sets.generation import generate

    shutil.copytree(extended, tmp_path / "set")
    before = file_bytes(tmp_path / "set")
    (tmp_path / "set" / name).unlink()
    with fake_physics(), patch.multiple(plan, SHARD_BYTES=30_000, GROUP_CHANNEL_BYTES=4_096):
        generate(fake_config(specimens=13), tmp_path / "set", 0)
    assert file_bytes(tmp_path / "set") == before


def test_a_damaged_set_is_not_extended(seven: Path, tmp_path: Path) -> None:
    shutil.copytree(seven, tmp_path / "set")
    shard = tmp_path / "set/data/train-00000.parquet"
    content = bytearray(shard.read_bytes())
    content[len(content) // 2] ^= 1
    shard.write_bytes(content)
    with pytest.raises(DatasetError, match=r"1 of its \d shards are missing, damaged .*train-00000"):
        extend_fake_set(tmp_path / "set", "+6")


@pytest.mark.parametrize("wrong", ["", "+0", "7", "-3", "many", "+1e3", 3, "+" + "9" * 40, "+99999999"])
def test_a_wrong_number_is_refused_before_anything_is_written(seven: Path, wrong: Any) -> None:
    before = file_bytes(seven)
    with pytest.raises((UsageError, ConfigError), match=r"--specimens: received|specimens"):
        extend_fake_set(seven, wrong, simulate_with_a_bug)
    assert file_bytes(seven) == before


def test_generate_names_the_way_to_a_larger_set(seven: Path) -> None:
    with pytest.raises(DatasetError, match=r"`siggen extend \S+ --specimens 9` adds"):
        write(seven, 9)
