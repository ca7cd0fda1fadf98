"""Sets that a stranger changed and sealed again: read or refused in words, and nothing beside them is touched."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import siggen
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.publication.publish import publish
from siggen.sets.verification import verify
from tests.dataset.fake_set import copy_fake_set, fake_physics, write_fake_set
from tests.dataset.resealed_set import facts, reseal
from tests.faults.foreign_sets import outcome_rows, readers
from tests.publication.conftest import facts_file

CHANGES = 4
QUICK_READERS = ("open", "verify", "publish", "extend", "generate")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    copy_fake_set(tmp_path / "set")
    (tmp_path / "secret.txt").write_bytes(b"secret")
    return tmp_path / "set"


def resealed(folder: Path, change: Callable[[dict], object]) -> None:
    manifest = unsealed("manifest.json", (folder / "manifest.json").read_bytes())
    change(manifest)
    (folder / "manifest.json").write_bytes(sealed(manifest))


def test_no_reader_ends_raw_writes_elsewhere_or_shows_what_lies_beside_the_set(tmp_path: Path, folder: Path) -> None:
    asked = {name: reader for name, reader in readers(folder).items() if name in QUICK_READERS}
    with fake_physics():
        rows = list(outcome_rows(tmp_path / "place", folder, asked, CHANGES))
    assert len(rows) == len(QUICK_READERS)
    assert [(row.what, row.alternative) for row in rows if not row.met] == []


@pytest.mark.parametrize(
    "name", ["../bashrc", "/tmp/x", "data/../../x", "", "a//b", "a\\b", "C:/x", ".hidden", "x" * 600]
)
def test_an_object_that_could_lie_elsewhere_is_refused_by_name(tmp_path: Path, folder: Path, name: str) -> None:
    (tmp_path / "bashrc").write_bytes(b"x")
    resealed(folder, lambda m: m["files"].update({name: facts(tmp_path, "bashrc")}))
    with pytest.raises(DatasetError, match=r"manifest\.json: files\..*allowed: names below the set's folder"):
        siggen.open(folder)
    with pytest.raises(DatasetError):
        publish(folder, tmp_path / "deep" / "out", facts_file(tmp_path))
    assert [m.what for m in verify(folder).mismatches] == ["manifest.json"]
    assert not (tmp_path / "deep").exists()


@pytest.mark.parametrize("kind", ["file", "folder"])
def test_a_link_out_of_the_set_is_never_followed(tmp_path: Path, folder: Path, kind: str) -> None:
    first = folder / "data" / "train-00000.parquet"
    if kind == "file":
        first.replace(tmp_path / "elsewhere.parquet")
        first.symlink_to(tmp_path / "elsewhere.parquet")
    else:
        (folder / "data").rename(tmp_path / "elsewhere")
        (folder / "data").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(DatasetError, match=r"leads out of .* by a link.*cp -rL"):
        siggen.open(folder).record(next(iter(siggen.open(folder).labels("train")["record_id"].to_pylist())))
    with pytest.raises(DatasetError):
        publish(folder, tmp_path / "out", facts_file(tmp_path))
    assert verify(folder).mismatches
    assert not list((tmp_path / "out").glob("data/*"))


def test_a_link_to_another_file_of_the_set_and_a_linked_set_are_read(tmp_path: Path, folder: Path) -> None:
    first = folder / "data" / "train-00000.parquet"
    first.replace(folder / "kept.parquet")
    first.symlink_to("../kept.parquet")
    (tmp_path / "linked").symlink_to(folder)
    assert sum(batch.num_rows for batch in siggen.open(tmp_path / "linked").records()) == 30


def test_a_half_made_set_writes_through_no_link(tmp_path: Path, folder: Path) -> None:
    (tmp_path / "home").mkdir()
    (folder / "manifest.json").unlink()
    for file in (folder / "data").iterdir():
        file.unlink()
    (folder / "data").rmdir()
    (folder / "data").symlink_to(tmp_path / "home")
    with pytest.raises(DatasetError, match="by a link"):
        write_fake_set(folder)
    assert not list((tmp_path / "home").iterdir())


@pytest.mark.timeout(20)
def test_a_pipe_in_the_place_of_a_file_does_not_wait_for_ever(folder: Path) -> None:
    card = folder / "config.yaml"
    card.unlink()
    os.mkfifo(card)
    with pytest.raises(DatasetError):
        siggen.open(folder)
    assert verify(folder).mismatches


def lies(table: pa.Table, kind: str) -> pa.Table:
    """Return a table that is not what the manifest says: without a column, with another name or type, with nulls."""
    place = table.schema.get_field_index("record_id")
    if kind == "dropped":
        return table.drop_columns(["record_id"])
    if kind == "renamed":
        return table.rename_columns(["id" if name == "record_id" else name for name in table.column_names])
    if kind == "retyped":
        return table.set_column(place, "record_id", table["record_id"].cast(pa.string()))
    if kind == "null":
        return table.set_column(place, "record_id", pa.array([None] * table.num_rows, pa.int64()))
    return table.append_column("record_id", table["record_id"])


@pytest.mark.parametrize("kind", ["dropped", "renamed", "retyped", "null", "twice"])
@pytest.mark.parametrize("name", ["labels.parquet", "damage.parquet", "data/train-00000.parquet"])
def test_a_table_that_lies_is_refused_by_its_name(folder: Path, name: str, kind: str) -> None:
    pq.write_table(lies(pq.read_table(folder / name), kind), folder / name)
    reseal(folder)
    with pytest.raises(DatasetError, match=rf"{name} is not the promised file \(it"):
        read_all(folder)


def read_all(folder: Path) -> None:
    dataset = siggen.open(folder)
    _ = dataset.labels(), dataset.damage(), list(dataset.records())


@pytest.mark.parametrize("name", ["labels.parquet", "damage.parquet"])
def test_a_table_that_is_none_is_refused_by_its_name(folder: Path, name: str) -> None:
    (folder / name).write_bytes(b"PAR1 text, sealed PAR1")
    reseal(folder)
    with pytest.raises(DatasetError, match=rf"{name} is not the promised file \(it cannot be decoded"):
        read_all(folder)


def test_published_files_are_compared_and_copied_never_linked(tmp_path: Path, folder: Path) -> None:
    publish(folder, tmp_path / "out", facts_file(tmp_path))
    for name in siggen.open(folder).files:
        assert not (folder / name).samefile(tmp_path / "out" / name)
    rows = folder / "data" / "train-00001.parquet"
    content = bytearray(rows.read_bytes())
    content[500] ^= 1
    rows.write_bytes(content)
    with pytest.raises(DatasetError, match="SHA-256 differs"):
        publish(folder, tmp_path / "again", facts_file(tmp_path))
    assert not (tmp_path / "again").exists()
