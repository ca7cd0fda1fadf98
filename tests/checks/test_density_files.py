"""Densities of noise from files: the numbers count, not the file; what cannot be used is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from tests.config.minimal import by_name, minimal
from tests.simulated import label_names, simulate

PLAIN = {"name": "bearing", "bits": None, "range_m_s2": 1e6}


def loaded(folder: Path, table: dict[str, object]) -> SetDesign:
    raw = minimal(sensors=by_name([{**PLAIN, "noise_spectrum": table}]), duration_s=1.0)
    (folder / "set.yaml").write_text(yaml.safe_dump(raw, sort_keys=False))
    return load_config(folder / "set.yaml")


def problems(folder: Path, table: dict[str, object]) -> dict[str, str]:
    with pytest.raises(ConfigError) as refused:
        loaded(folder, table)
    return {problem.path: problem.received for problem in refused.value.problems}


def test_a_file_is_its_numbers(tmp_path: Path) -> None:
    (tmp_path / "rest.csv").write_text("frequency_hz,density\n10,0.1\n1000,0.01\n")
    numbers = loaded(tmp_path, {"frequency_hz": [10.0, 1000.0], "density": [0.1, 0.01]})
    assert loaded(tmp_path, {"file": "rest.csv"}).identity == numbers.identity
    (tmp_path / "rest.csv").write_text("frequency_hz,density\n10,0.1\n1000,0.02\n")
    assert loaded(tmp_path, {"file": "rest.csv"}).identity != numbers.identity


def test_a_sensor_shows_the_density_of_its_table(tmp_path: Path) -> None:
    table = {"frequency_hz": [100.0, 10_000.0], "density": [10.0, 0.1]}
    raw = {"duration_s": 1.0, "dynamics__model": "8dof"}
    noisy = load_config(minimal(sensors=by_name([{**PLAIN, "noise_spectrum": {**table, "factor": 2.0}}]), **raw))
    clean = load_config(minimal(sensors=by_name([PLAIN]), **raw))
    found, without = simulate(noisy, [0])[0], simulate(clean, [0])[0]
    assert isinstance(found, SimulatedRecord)
    assert isinstance(without, SimulatedRecord)
    assert set(found.labels) == set(label_names(noisy))
    added = found.channels["bearing_vertical"].astype(float) - without.channels["bearing_vertical"]
    assert found.labels["noise_spectrum_bearing_vertical_m_s2"] == pytest.approx(added.std(), rel=1e-4)
    power = np.abs(np.fft.rfft(added)) ** 2 * 2.0 / (added.size * noisy.fs_hz)
    for hz, density in ((50, 20.0), (1000, 2.0), (20_000, 0.2)):
        band = power[int(0.9 * hz) : int(1.1 * hz)]
        assert np.sqrt(band.mean()) == pytest.approx(density, rel=3.0 / np.sqrt(band.size) + 0.02)


def test_files_that_cannot_be_used_are_named(tmp_path: Path) -> None:
    assert set(problems(tmp_path, {"file": "none.csv"})) == {"sensors.bearing.noise_spectrum.file"}
    (tmp_path / "other.csv").write_text("hz,density\n10,1\n20,1\n")
    assert "columns are missing" in problems(tmp_path, {"file": "other.csv"})["sensors.bearing.noise_spectrum.file"]
    (tmp_path / "short.csv").write_text("frequency_hz,density\n10,1\n")
    assert "1 rows" in problems(tmp_path, {"file": "short.csv"})["sensors.bearing.noise_spectrum.file"]


def test_knots_that_fall_or_do_not_match_are_refused(tmp_path: Path) -> None:
    falling = problems(tmp_path, {"frequency_hz": [20.0, 10.0], "density": [1.0, 1.0]})
    assert "sensors.bearing.noise_spectrum.frequency_hz" in falling
    fewer = problems(tmp_path, {"frequency_hz": [10.0, 20.0, 30.0], "density": [1.0, 1.0]})
    assert fewer["sensors.bearing.noise_spectrum.density"] == "3 frequencies, 2 densities"
