"""Indicators of a set that was written before there was a second schema version."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

import siggen
from diagnostics.indicators.classifier_table import classifier_table
from diagnostics.indicators.table import record_table
from diagnostics.report.drawing import LOSSES, loss_of_specimens

FIRST = Path(__file__).parents[2] / "sets" / "schema_1"


def test_the_indicators_of_a_set_of_version_1_are_computed(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(FIRST, tmp_path / "set"))  # its table is kept beside it
    table = classifier_table(record_table(siggen.open(folder)))
    assert table.column("state").to_pylist() == ["healthy", "severe"]
    rms = table.column("rms__lid_vertical").to_numpy()
    # The spall through the face shakes the casing: 1.5 mm of arc, 41 µm of sink.
    assert rms[1] > 2.0 * rms[0] > 0.0
    assert min(table.column("revolutions_pinion").to_pylist()) >= 6  # 7.5 revolutions, whole ones between pulses


def test_its_loss_of_stiffness_is_the_one_that_it_has() -> None:
    losses, meaning = loss_of_specimens(siggen.open(FIRST))
    assert {state: loss.tolist() for state, loss in losses.items()} == {"healthy": [0.0], "severe": [1.0]}
    assert meaning == LOSSES["mesh_stiffness_loss"]
    assert np.isfinite(losses["severe"]).all()
