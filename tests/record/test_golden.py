"""Records of two presets and of every kind, and refusals, are those that tests/golden.json keeps."""

from __future__ import annotations

import json

import pytest

from benchmarks.golden import KEPT, compared, numbers_of, processor, refusals
from siggen.columns.versions import SIMULATION_VERSION


@pytest.mark.parametrize("preset", ["paper_a", "quickstart", "kinds"])
def test_a_record_of_every_state_is_what_it_was(preset: str) -> None:
    if preset == "kinds" and json.loads(KEPT.read_text(encoding="utf-8"))["processor"] != processor():
        pytest.skip("kept on another kind of processor, where a pulse of an encoder may round to the next count")
    # whoever moves numbers on purpose: python -m benchmarks golden (what moved, by how much), then --write
    assert [
        f"{one.state} {one.channel} {one.text}" for one in compared({preset: numbers_of(preset)}) if not one.equal
    ] == []


def test_kept_numbers_belong_to_this_version_of_the_simulation() -> None:
    assert json.loads(KEPT.read_text(encoding="utf-8"))["simulation_version"] == SIMULATION_VERSION


def test_what_cannot_be_is_refused_in_the_words_that_were_kept() -> None:
    assert refusals() == json.loads(KEPT.read_text(encoding="utf-8"))["refusals"]
