"""Extended sets: the records of a set generated at once, shards that stay as they are, and no way to lose either."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pyarrow as pa
import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.dataset.environment import environment
from siggen.dataset.reading import open as open_set
from siggen.errors import EXIT_MISMATCH, DatasetError, EngineError
from siggen.gearbox import plan
from siggen.sets.generation import generate
from siggen.sets.set_run import Generation
from tests.dataset.fake_set import (
    fake_config,
    fake_physics,
    file_bytes,
    simulate,
    verify_fake_set,
)


def write(path: Path, specimens: int, simulation: Any = simulate, workers: int = 0) -> Generation:
    """Generate with the stand-in; two gearboxes per full shard, so that sets end in partial ones."""
    with fake_physics(simulation), patch.object(plan, "SHARDS", 3):
        return generate(fake_config(specimens=specimens), path, workers)


@pytest.fixture(scope="module")
def seven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set of seven gearboxes; tests that change it copy it."""
    path = tmp_path_factory.mktemp("seven") / "set"
    write(path, 7)
    return path


@pytest.fixture(scope="module")
def thirteen(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A set of thirteen, made at once."""
    path = tmp_path_factory.mktemp("thirteen") / "set"
    write(path, 13)
    return path


@pytest.fixture(scope="module")
def extended(seven: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The set of seven, extended by six."""
    folder = shutil.copytree(seven, tmp_path_factory.mktemp("extended") / "set")
    write(folder, 13)
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


@pytest.mark.parametrize("steps", [[13], [8, 10, 13]], ids=str)
def test_an_extended_set_holds_the_records_of_one_generated_at_once(
    seven: Path, thirteen: Path, tmp_path: Path, steps: list[int]
) -> None:
    shutil.copytree(seven, tmp_path / "grown")
    for step in steps:
        before = file_bytes(tmp_path / "grown")
        made = write(tmp_path / "grown", step)
        after = file_bytes(tmp_path / "grown")
        kept = [name for name in before if name.startswith("data/")]
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
        write(tmp_path / "set", 13, fails_late)
    assert rows(tmp_path / "set") == before
    for other in (7, 8):
        (tmp_path / "set/README.md").unlink(missing_ok=True)  # so that there is something to do
        with pytest.raises(DatasetError, match=r"holds \d files? that a set of \d gearboxes does not have"):
            write(tmp_path / "set", other)
    again = write(tmp_path / "set", 13)
    assert again.records_made < 36
    assert rows(tmp_path / "set") == rows(thirteen)


def test_verify_of_a_set_that_grows_says_how_to_end_the_extension(seven: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(seven, tmp_path / "set"))
    with fake_physics(), patch.object(plan, "SHARDS", 3):
        for number in (1, 2, 3, 4):
            generate(fake_config(specimens=13), folder, 0, part=(number, 4))
    said = CliRunner().invoke(app, ["verify", str(folder)])
    assert said.exit_code == EXIT_MISMATCH
    assert "of an extension that is not finished" in said.stderr
    assert f"To end it: siggen generate {folder}/config.yaml --set specimens=N --out {folder} with" in said.stderr
    assert "not part of the set" not in said.stderr
    write(folder, 13)
    assert verify_fake_set(folder, 5).mismatches == ()


@pytest.mark.parametrize("name", ["manifest.json", "labels.parquet", "data/train-00001.parquet", "README.md"])
def test_a_lost_file_of_an_extended_set_is_made_again_by_generate(extended: Path, tmp_path: Path, name: str) -> None:
    shutil.copytree(extended, tmp_path / "set")
    before = file_bytes(tmp_path / "set")
    (tmp_path / "set" / name).unlink()
    write(tmp_path / "set", 13)
    assert file_bytes(tmp_path / "set") == before


def test_what_is_damaged_of_a_set_that_grows_is_mended_and_said(seven: Path, extended: Path, tmp_path: Path) -> None:
    shutil.copytree(seven, tmp_path / "set")
    shard = tmp_path / "set/data/train-00000.parquet"
    content = bytearray(shard.read_bytes())
    content[len(content) // 2] ^= 1
    shard.write_bytes(content)
    assert "train-00000 is made again" in write(tmp_path / "set", 13).notes[0]
    assert file_bytes(tmp_path / "set") == file_bytes(extended)


def test_a_finished_set_of_another_version_does_not_grow(seven: Path, tmp_path: Path) -> None:
    shutil.copytree(seven, tmp_path / "set")
    other = {**environment(), "siggen": "9.9", "fingerprint": "0123456789abcdef"}
    before = file_bytes(tmp_path / "set")
    refused = pytest.raises(DatasetError, match=r"was made by siggen \S+ \(.*this is siggen 9\.9 .* never mixed")
    with patch("siggen.dataset.folder.environment", lambda: other), refused:
        write(tmp_path / "set", 13)
    assert file_bytes(tmp_path / "set") == before
