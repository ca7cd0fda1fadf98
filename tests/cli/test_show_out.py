"""`siggen show --out` as a user calls it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import UsageError
from siggen.sets.drawn import simulated

SET = ["--set", "duration_s=0.05", "--set", "specimens=1"]
runner = CliRunner()


def run(*arguments: object) -> None:
    result = runner.invoke(app, ["show", *map(str, arguments), *SET])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output


def test_the_table_holds_the_stored_signal_and_what_no_sensor_sees(tmp_path: Path) -> None:
    run("tests/configs/linear_pits.yaml", "--record", 6, "--internals", "--out", tmp_path / "record.parquet")
    table = pyarrow.parquet.read_table(tmp_path / "record.parquet")
    config = load_config("tests/configs/linear_pits.yaml", SET[1::2])
    record = next(simulated(config, [6]))
    for channel, signal in record.channels.items():
        assert np.array_equal(table[f"accel_{channel}_m_s2"].to_numpy(), signal)
    assert table.num_rows == config.samples
    assert table["mesh_force_n"].to_numpy().min() > 0.0
    # The mean mesh force carries the torque: F = T/R_b1; 0.05 s is no whole number of periods, hence 5 %.
    torque = float(table.schema.metadata[b"torque_nm"])
    base_radius_m = 0.5 * 3e-3 * 18 * np.cos(np.radians(20))
    assert table["mesh_force_n"].to_numpy().mean() == pytest.approx(torque / base_radius_m, rel=0.05)


def test_a_record_that_the_set_does_not_have_is_refused_with_the_range(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--record: received 8; allowed: a whole number from 0 to 7"):
        run("tests/configs/linear_pits.yaml", "--record", 8, "--out", tmp_path / "record.parquet")


@pytest.mark.parametrize("file", ["tests/configs/linear_pits.yaml", "tests/configs/casing.yaml"])
def test_the_transmission_error_is_the_deflection_of_the_teeth_under_load(tmp_path: Path, file: str) -> None:
    run(file, "--record", 0, "--internals", "--out", tmp_path / "record.parquet")
    table = pyarrow.parquet.read_table(tmp_path / "record.parquet")
    force, stiffness = (table[c].to_numpy().mean() for c in ("mesh_force_n", "mesh_stiffness_n_per_m"))
    error = table["transmission_error_m"].to_numpy().mean()
    assert error > 1e-6  # some 30 N m press 1 kN on 2e8 to 4e8 N/m
    # The mean of F/K is not the quotient of the means, as K swings by 30 % about its own; tip relief adds a little.
    assert error == pytest.approx(force / stiffness, rel=0.3)


def test_internals_can_be_left_out(tmp_path: Path) -> None:
    run("tests/configs/linear_pits.yaml", "--record", 0, "--out", tmp_path / "signals.parquet")
    run("tests/configs/linear_pits.yaml", "--record", 0, "--internals", "--out", tmp_path / "all.parquet")
    signals, everything = (pyarrow.parquet.read_table(tmp_path / f"{name}.parquet") for name in ("signals", "all"))
    assert signals.column_names == [
        "time_s",
        "angle_rad",
        "accel_bearing_vertical_m_s2",
        "accel_bearing_horizontal_m_s2",
    ]
    assert set(signals.column_names) < set(everything.column_names)
    for name in signals.column_names:
        assert signals[name].equals(everything[name])
