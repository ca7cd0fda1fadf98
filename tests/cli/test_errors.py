"""`siggen inspect errors` as a user calls it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import UsageError
from siggen.views.errors import error_figure, gear_charts

CLASS_6 = ["--set", "manufacture={accuracy_class: 6}"]
runner = CliRunner()


def run(*arguments: object) -> None:
    result = runner.invoke(
        app, ["inspect", "errors", "tests/configs/casing.yaml", *map(str, arguments)], catch_exceptions=True
    )
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output


@pytest.mark.drawn
def test_a_row_per_tooth_and_a_picture(tmp_path: Path) -> None:
    run("--out", tmp_path / "e.csv", "--png", tmp_path / "e.png", *CLASS_6)
    table = pyarrow.csv.read_csv(tmp_path / "e.csv")
    assert table["gear"].to_pylist() == ["pinion"] * 18 + ["gear"] * 47
    steps = table["pitch_um"].to_numpy()
    # Every gear closes: its single pitch deviations add up to nothing.
    assert abs(steps[:18].sum()) < 1e-9
    assert abs(steps[18:].sum()) < 1e-9
    assert np.abs(steps).max() > 1.0
    assert (tmp_path / "e.png").stat().st_size > 20_000


def test_the_table_is_what_the_records_were_labelled_with(tmp_path: Path) -> None:
    run("--out", tmp_path / "e.parquet", "--gearbox", 4, *CLASS_6)
    table = pyarrow.parquet.read_table(tmp_path / "e.parquet")
    pinion, _ = gear_charts(load_config("tests/configs/casing.yaml", [CLASS_6[1]]).gearbox(4))
    largest = 1e6 * pinion.made.found.largest["profile_m"]
    assert table["profile_um"].to_numpy()[:18].max() == pytest.approx(largest, rel=1e-12)


def test_drawn_profiles_and_pitches_lie_within_the_band() -> None:
    charts = gear_charts(load_config("tests/configs/casing.yaml", [CLASS_6[1]]).gearbox(0))
    for chart, (pitch, profiles) in zip(charts, np.reshape(error_figure(charts).axes, (2, 2)), strict=True):
        used = 1e6 * chart.made.tolerance_share * chart.made.tolerances.profile_m
        heights = [np.ptp(line.get_ydata()) for line in profiles.get_lines()]
        assert len(heights) == len(chart.profile_um)
        assert max(heights) <= used * (1.0 + 1e-9)
        assert len(pitch.containers[0]) == len(chart.profile_um)


def test_states_may_have_gears_of_their_own(tmp_path: Path) -> None:
    tables = []
    for state in ("healthy", "severe"):
        own = ["--set", "manufacture={accuracy_class: 6, draw: state}", "--state", state]
        run("--out", tmp_path / f"{state}.parquet", *own)
        tables.append(pyarrow.parquet.read_table(tmp_path / f"{state}.parquet"))
    assert not tables[0].equals(tables[1])


def test_perfect_gears_and_unknown_states_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="received perfect ones"):
        run("--out", tmp_path / "e.csv")
    with pytest.raises(UsageError, match="allowed: healthy, slight"):
        run("--out", tmp_path / "e.csv", "--state", "grave", *CLASS_6)
    assert list(tmp_path.iterdir()) == []
