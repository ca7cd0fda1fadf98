"""Records are what they were: every state of two presets beside the kept numbers of tests/golden.json."""

from __future__ import annotations

import json

import pytest

from benchmarks.golden import KEPT, compared, numbers_of
from siggen.columns.versions import SIMULATION_VERSION


@pytest.mark.parametrize("preset", ["paper_a", "quickstart"])
def test_a_record_of_every_state_is_what_it_was(preset: str) -> None:
    # whoever moves numbers on purpose: python -m benchmarks golden (what moved, by how much), then --write
    assert [
        f"{one.state} {one.channel} {one.text}" for one in compared({preset: numbers_of(preset)}) if not one.equal
    ] == []


def test_kept_numbers_belong_to_this_version_of_the_simulation() -> None:
    assert json.loads(KEPT.read_text(encoding="utf-8"))["simulation_version"] == SIMULATION_VERSION
