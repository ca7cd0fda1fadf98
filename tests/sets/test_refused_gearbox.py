"""A gearbox that cannot be drawn is a failure of its own records and of no other's."""

from __future__ import annotations

from pathlib import Path

import pytest

import siggen
from siggen.config import Config
from siggen.gearbox import design
from siggen.gearbox.specimen import Specimen


def test_a_first_gearbox_that_is_refused_costs_its_own_records_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw = design.draw_specimen

    def refused(config: Config, number: int) -> Specimen:
        if number == 0:
            raise ValueError("ring: received planets that it cannot hold")
        return draw(config, number)

    monkeypatch.setattr(design, "draw_specimen", refused)
    config = siggen.load_config("quickstart", ["specimens=2", "duration_s=0.05", "splits.by=gearbox"])
    siggen.generate(config, tmp_path / "set", executor="serial", allowed_loss=0.9)
    labels = siggen.open(tmp_path / "set").labels().to_pylist()
    assert {row["specimen_id"] for row in labels} == {1}
    assert len(labels) == len(config.config.states)
