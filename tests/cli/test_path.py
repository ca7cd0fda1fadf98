"""`siggen inspect path` as a user calls it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from siggen.cli.app import app
from siggen.errors import UsageError

runner = CliRunner()


@pytest.mark.drawn
def test_every_channel_has_a_curve_from_every_bearing_force(tmp_path: Path) -> None:
    out, png = tmp_path / "path.parquet", tmp_path / "path.png"
    arguments = [
        "inspect",
        "path",
        "industrial",
        "--out",
        str(out),
        "--png",
        str(png),
        "--gearbox",
        "3",
    ]
    result = runner.invoke(app, arguments, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    assert "lid_axial" in result.output
    assert "its lowest modes" in result.output
    table = pyarrow.parquet.read_table(out)
    assert table.num_columns == 1 + 6 * 4 * 2
    frequency = table["frequency_hz"].to_numpy()
    curve = table["lid_axial_from_gear_bearing_vertical_real_m_s2_per_n"].to_numpy()
    # whole steps from 0 up to half the sampling rate, on which one falls only by chance
    np.testing.assert_allclose(np.diff(frequency), frequency[1], rtol=1e-9)
    assert 12800.0 - frequency[1] < frequency[-1] <= 12800.0
    # no more than plates at resonance, and nothing at frequency 0
    assert curve[0] == 0.0
    assert 1e-4 < np.abs(curve).max() < 10.0
    assert png.stat().st_size > 10_000


def test_a_set_without_paths_says_how_to_add_one() -> None:
    result = runner.invoke(app, ["inspect", "path", "tests/configs/linear_pits.yaml"])
    assert isinstance(result.exception, UsageError)
    assert "housing that gives way" in str(result.exception)
