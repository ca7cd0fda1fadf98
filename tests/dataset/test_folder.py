"""What generation finds in a folder, and what it refuses to touch."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.dataset.folder import content_of
from siggen.dataset.storage import LocalFolder
from siggen.errors import DatasetError
from siggen.gearbox.design import SetDesign
from tests.dataset.fake_set import copy_fake_set, fake_config, file_bytes, write_fake_set

CONFIG = fake_config()


def is_finished(storage: LocalFolder, design: SetDesign) -> bool:
    return content_of(storage, design).finished is not None


def test_a_set_with_a_missing_or_truncated_file_is_not_finished(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    assert is_finished(LocalFolder(tmp_path), CONFIG)
    card = tmp_path / "README.md"
    card.write_bytes(card.read_bytes()[:-1])
    assert not is_finished(LocalFolder(tmp_path), CONFIG)
    card.unlink()
    assert not is_finished(LocalFolder(tmp_path), CONFIG)


def test_a_folder_with_other_things_is_refused_and_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("x")
    with pytest.raises(DatasetError, match=r"not empty \(thesis\.tex\)"):
        write_fake_set(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.tex"]


def test_another_set_is_refused_with_what_differs(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    before = file_bytes(tmp_path)
    with pytest.raises(
        DatasetError, match=r"seed: 7 there, 8 asked for\n  gears\.module_mm: 3\.0 there, 2\.0 asked for"
    ):
        write_fake_set(tmp_path, fake_config(seed=8, gears={**CONFIG.canonical()["gears"], "module_mm": 2.0}))
    assert file_bytes(tmp_path) == before


def test_fewer_gearboxes_in_place_and_another_number_of_a_begun_set_are_refused(tmp_path: Path) -> None:
    copy_fake_set(tmp_path)
    before = file_bytes(tmp_path)
    with pytest.raises(DatasetError, match=r"with 5 gearboxes, finished; asked for are 3: .* fewer need a new folder"):
        write_fake_set(tmp_path, fake_config(specimens=3))
    assert file_bytes(tmp_path) == before
    (tmp_path / "manifest.json").unlink()
    with pytest.raises(DatasetError, match=r"with 5 gearboxes, begun and not finished; asked for are 7"):
        write_fake_set(tmp_path, fake_config(specimens=7))


def test_a_config_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / "config.yaml").write_text("a: [")
    with pytest.raises(DatasetError, match="cannot be read"):
        write_fake_set(tmp_path)
