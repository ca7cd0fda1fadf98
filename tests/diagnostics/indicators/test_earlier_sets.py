"""Indicators of a set that an earlier simulation wrote."""

from __future__ import annotations

import shutil
from pathlib import Path

import siggen
from diagnostics.indicators.classifier_table import classifier_table
from diagnostics.indicators.table import record_table

EARLIER = Path(__file__).parents[2] / "sets" / "earlier_set"


def test_the_indicators_of_an_earlier_set_are_computed(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(EARLIER, tmp_path / "set"))  # its table is kept beside it
    table = classifier_table(record_table(siggen.open(folder)))
    assert table.column("state").to_pylist() == ["healthy", "severe"] * 2
    rms = table.column("rms__lid_vertical").to_numpy()
    # The spall through the face shakes the casing: 1.5 mm of arc, 41 µm of sink.
    assert (rms[[1, 3]] > 2.0 * rms[[0, 2]]).all()
    assert min(table.column("revolutions_pinion").to_pylist()) >= 6  # 7.5 revolutions, whole ones between pulses
