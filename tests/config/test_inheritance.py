"""A configuration that extends another: what is merged, what is replaced, and what cannot be resolved."""

from __future__ import annotations

from pathlib import Path

import pytest

from siggen.checks.loading import load_config
from siggen.config import inherited
from siggen.errors import ConfigError


def test_a_file_that_extends_a_preset_is_the_preset_with_its_own_values(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("extends: bench\nname: mine\ngears: {pinion: {teeth: 20}}\n")
    mine, bench = load_config(tmp_path / "mine.yaml"), load_config("bench", ["name=mine", "gears.pinion.teeth=20"])
    assert mine.identity == bench.identity
    assert "extends" not in mine.canonical()


def test_mappings_merge_and_distributions_and_lists_are_replaced(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text("a: {b: 1, c: 2}\nd: {normal: [0, 1], within: [0, 1]}\ne: [1, 2]\nf: {g: 1}\n")
    own = {"extends": "base.yaml", "a": {"c": 3}, "d": {"log": [1, 2]}, "e": [5], "f": None}
    expected = {"a": {"b": 1, "c": 3}, "d": {"log": [1, 2]}, "e": [5], "f": None}
    assert inherited(own, tmp_path) == expected


def test_data_files_of_the_extended_file_count_from_its_folder(tmp_path: Path) -> None:
    (tmp_path / "below").mkdir()
    (tmp_path / "below" / "base.yaml").write_text("sensors: {lid: {noise_spectrum: {file: floor.csv}}}\n")
    (tmp_path / "middle.yaml").write_text("extends: below/base.yaml\n")
    found = inherited({"extends": "middle.yaml"}, tmp_path)
    assert Path(found["sensors"]["lid"]["noise_spectrum"]["file"]) == (tmp_path / "below" / "floor.csv").resolve()


@pytest.mark.parametrize(
    ("text", "said"),
    [("extends: mine.yaml", "a circle"), ("extends: 3", "allowed: a preset"), ("extends: nothing", "quickstart")],
)
def test_what_leads_nowhere_is_refused_in_words(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "mine.yaml").write_text(text)
    with pytest.raises(ConfigError, match=said):
        load_config(tmp_path / "mine.yaml")
