"""A section measured later goes into the card of a finished set, and the manifest promises the new card."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.dataset.card_section import with_section, write_card_section
from siggen.errors import DatasetError, VerificationError
from siggen.sets.verification import verify
from tests.dataset.fake_set import file_bytes, write_fake_set


def test_only_card_and_manifest_change_and_the_set_verifies(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    before = file_bytes(tmp_path)
    write_card_section(tmp_path, "## Measured\n\nFirst.\n")
    after = file_bytes(tmp_path)
    assert {name for name in before if before[name] != after[name]} == {"README.md", "manifest.json"}
    assert verify(tmp_path).mismatches == ()
    # the set is a finished one still: the same command makes nothing again
    assert write_fake_set(tmp_path).was_finished
    assert file_bytes(tmp_path) == after


def test_a_second_section_replaces_the_first(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    write_card_section(tmp_path, "First.")
    first = (tmp_path / "README.md").read_text()
    write_card_section(tmp_path, "Second.")
    second = (tmp_path / "README.md").read_text()
    assert second == first.replace("First.", "Second.")
    assert second.index("Second.") < second.index("## Columns of `data/`")


def test_a_card_without_columns_gets_the_section_at_its_end() -> None:
    assert with_section("# Card\n", "Text.").endswith("Text.\n<!-- measured section: end -->\n\n")
    assert with_section(with_section("# Card\n", "Text."), "Text.") == with_section("# Card\n", "Text.")


def test_a_card_changed_by_hand_is_not_sealed(tmp_path: Path) -> None:
    write_fake_set(tmp_path)
    (tmp_path / "README.md").write_text("mine")
    with pytest.raises(VerificationError, match=r"README\.md is not the one"):
        write_card_section(tmp_path, "Text.")
    assert (tmp_path / "README.md").read_text() == "mine"


def test_a_folder_without_a_set_is_refused_and_not_created(tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="no data set here"):
        write_card_section(tmp_path / "nothing", "Text.")
    assert not (tmp_path / "nothing").exists()
