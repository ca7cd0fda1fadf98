"""Sets that a stranger changed and sealed again: read or refused in words, and nothing beside them is touched."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from unittest.mock import patch

import pytest

import siggen
from siggen.dataset.seal import sealed, unsealed
from siggen.errors import DatasetError
from siggen.gearbox import plan
from siggen.publication.publish import publish
from siggen.sets.parts import generate_part, merge
from siggen.sets.verification import verify
from tests.dataset.fake_set import copy_fake_set, fake_config, fake_physics, write_fake_set
from tests.dataset.resealed_set import facts
from tests.faults.foreign_sets import outcome_rows, readers
from tests.publication.conftest import facts_file

CHANGES = 4
QUICK_READERS = ("open", "verify", "publish", "merge", "extend", "generate")


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
    with fake_physics(), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
        rows = list(outcome_rows(tmp_path / "place", folder, asked, CHANGES))
    assert len(rows) == len(QUICK_READERS)
    assert [(row.what, row.alternative) for row in rows if not row.met] == []


@pytest.mark.parametrize(
    "name", ["../bashrc", "/tmp/x", "data/../../x", "", "a//b", "a\\b", "C:/x", ".hidden", "x" * 600]
)
def test_an_object_that_could_lie_elsewhere_is_refused_by_name(tmp_path: Path, folder: Path, name: str) -> None:
    (tmp_path / "bashrc").write_bytes(b"x")
    resealed(folder, lambda m: m["files"].update({name: facts(tmp_path, "bashrc", blocks=False)}))
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


def test_a_copy_is_hashed_while_it_is_copied(tmp_path: Path) -> None:
    for number in (1, 2):
        with fake_physics(), patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096):
            generate_part(fake_config(), tmp_path / str(number), (number, 2), 0)
    rows = tmp_path / "2" / "data" / "train-00001.parquet"
    content = bytearray(rows.read_bytes())
    content[500] ^= 1
    rows.write_bytes(content)
    with (
        fake_physics(),
        patch.multiple(plan, SHARD_BYTES=12_000, GROUP_CHANNEL_BYTES=4_096),
        pytest.raises(DatasetError, match="missing or damaged in all parts"),
    ):
        merge([tmp_path / "1", tmp_path / "2"], tmp_path / "out")
    assert not (tmp_path / "out" / "data" / "train-00001.parquet").exists()
