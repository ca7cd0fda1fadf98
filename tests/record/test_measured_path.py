"""Measured responses: from files of several kinds into a configuration that needs them no more."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.config import yaml_text
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign, stored_design
from siggen.gearbox.mode_table import seats_of
from siggen.gearbox.plan import planned_record
from siggen.motion.response import Response
from siggen.names import PAIR
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.config.mill import mill
from tests.config.minimal import by_name, minimal
from tests.sensing.resonances import accelerance
from tests.simulated import simulate

INPUTS = seats_of(PAIR)

SENSOR = {"name": "lid", "place": "casing", "axes": ["vertical"], "bits": None, "range_m_s2": 1e6}


def written(folder: Path, path: dict[str, Any], **changes: Any) -> Path:
    """Write a configuration whose sensor has this path, and return its file."""
    sensor = {**SENSOR, "path": path}
    changes = {"dynamics__model": "casing", "duration_s": 0.1, "fs_hz": 25600.0, **changes}
    source = folder / "set.yaml"
    source.write_text(yaml_text(minimal(sensors=by_name([sensor]), **changes)))
    return source


GRID = np.arange(0.0, 12_801.0)
RESIDUES = {"pinion_bearing/vertical": (0.05, -0.01), "pinion_bearing/horizontal": (0.01, 0.02),
            "gear_bearing/vertical": (0.04, 0.01), "gear_bearing/horizontal": (-0.02, 0.01)}  # fmt: skip
"""Of two resonances, by bearing force."""


def columns() -> dict[str, np.ndarray]:
    """Return the columns of a measurement."""
    found = {"frequency_hz": GRID}
    for name in INPUTS:
        curve = accelerance(GRID, (400.0, 1700.0), RESIDUES[name])
        stem = f"vertical_from_{name.replace('/', '_')}"
        found |= {f"{stem}_real_m_s2_per_n": curve.real, f"{stem}_imag_m_s2_per_n": curve.imag}
    return found


def polar(cartesian: dict[str, np.ndarray], unit: str) -> dict[str, np.ndarray]:
    result = {"frequency_hz": cartesian["frequency_hz"]}
    for name, real in cartesian.items():
        if name.endswith("_real_m_s2_per_n"):
            stem = name.removesuffix("_real_m_s2_per_n")
            curve = real + 1j * cartesian[f"{stem}_imag_m_s2_per_n"]
            result[f"{stem}_magnitude_m_s2_per_n"] = np.abs(curve)
            result[f"{stem}_phase_{unit}"] = np.angle(curve, deg=unit == "deg")
    return result


def save(values: dict[str, np.ndarray], file: Path) -> None:
    match file.suffix:
        case ".csv":
            pyarrow.csv.write_csv(pa.table(values), file)
        case ".parquet":
            pyarrow.parquet.write_table(pa.table(values), file)
        case ".npz":
            np.savez(file, **values)


def signal(config: SetDesign) -> np.ndarray:
    result = simulate(config, [0])[0]
    assert isinstance(result, SimulatedRecord), result
    return result.channels["lid_vertical"]


def passed(config: SetDesign, response: Response, residues: dict[str, tuple[float, ...]]) -> np.ndarray:
    """Return the bearing forces of a record through two resonances each, (n,)."""
    length = 2**16  # nothing wraps round
    hz = np.arange(length // 2 + 1) * config.fs_hz / length
    total = np.zeros(hz.size, dtype=complex)
    for name, each in residues.items():
        whole = np.concatenate([response.history.bearing_force_n[name], response.bearing_force_n[name]])
        assert 2 * whole.size < length
        values = whole - response.history.bearing_force_n[name].mean()
        total += accelerance(hz, (400.0, 1700.0), each) * np.fft.rfft(values, length)
    return np.asarray(np.fft.irfft(total, length)[whole.size - config.samples : whole.size])


def test_forces_of_all_bearings_pass_a_response_from_a_file(tmp_path: Path) -> None:
    save(columns(), tmp_path / "lid.npz")
    config = load_config(written(tmp_path, {"file": "lid.npz"}))
    specimen = config.gearbox(0)
    response, _ = record_response(specimen, specimen_state(specimen, 0), planned_record(config, 0))
    expected = passed(config, response, RESIDUES)
    # 1 Hz between the lines of the file, and a response that ends at half the sampling rate
    assert np.abs(signal(config) - expected).max() < 3e-3 * expected.std()


def test_forces_of_every_shaft_of_a_machine_pass_under_its_users_names(tmp_path: Path) -> None:
    places = ("input_bearing", "middle_bearing", "output_bearing")
    forces = {f"{own}/{axis}": f"{own}_{axis}" for own in places for axis in ("vertical", "horizontal")}
    residues = {name: (0.01 * (k + 1), 0.02 - 0.01 * k) for k, name in enumerate(forces)}
    found = {"frequency_hz": GRID}
    for name, own in forces.items():
        curve = accelerance(GRID, (400.0, 1700.0), residues[name])
        found |= {f"vertical_from_{own}_{part}_m_s2_per_n": getattr(curve, part) for part in ("real", "imag")}
    save(found, tmp_path / "lid.npz")
    sensor = {**SENSOR, "path": {"file": "lid.npz"}}
    (tmp_path / "set.yaml").write_text(yaml_text(mill(sensors=by_name([sensor]), fs_hz=25600.0, duration_s=0.1)))
    config = load_config(tmp_path / "set.yaml")
    specimen = config.gearbox(0)
    response, _ = record_response(specimen, specimen_state(specimen, 0), planned_record(config, 0))
    # 1 Hz between the lines of the file, and a response that ends at half the sampling rate
    expected = passed(config, response, residues)
    assert np.abs(signal(config) - expected).max() < 3e-3 * expected.std()
    save(columns(), tmp_path / "lid.npz")
    with pytest.raises(
        ConfigError, match=r"columns vertical_from_gear_bearing_horizontal_...; allowed: forces of input"
    ):
        load_config(tmp_path / "set.yaml")


@pytest.mark.parametrize("name", ["lid.csv", "lid.parquet", "polar_deg.csv", "polar_rad.parquet"])
def test_all_forms_of_a_file_give_the_same_record(tmp_path: Path, name: str) -> None:
    (tmp_path / "measured").mkdir()
    save(columns(), tmp_path / "lid.npz")
    save(polar(columns(), name[6:9]) if name.startswith("polar") else columns(), tmp_path / "measured" / name)
    expected = signal(load_config(written(tmp_path, {"kind": "measured", "file": "lid.npz"})))
    measured = load_config(written(tmp_path, {"kind": "measured", "file": f"measured/{name}"}))
    # float32 channels: 6e-8 of the largest value, and as much again from rounding in the other direction
    np.testing.assert_allclose(signal(measured), expected, atol=1.3e-7 * np.abs(expected).max())


def test_the_set_needs_the_file_no_more(tmp_path: Path) -> None:
    save(columns(), tmp_path / "lid.csv")
    config = load_config(written(tmp_path, {"kind": "measured", "file": "lid.csv"}))
    digest = hashlib.sha256((tmp_path / "lid.csv").read_bytes()).hexdigest()
    assert config.sensors[0].path.sha256 == digest  # type: ignore[union-attr]
    stored = config.text
    (tmp_path / "lid.csv").unlink()
    again = stored_design(stored.encode(), "set")
    assert again == config
    assert again.identity == config.identity
    (tmp_path / "stored.yaml").write_text(stored)
    assert signal(load_config(tmp_path / "stored.yaml")).tobytes() == signal(config).tobytes()


def renamed(values: dict[str, np.ndarray], old: str, new: str) -> dict[str, np.ndarray]:
    return {name.replace(old, new): value for name, value in values.items()}


FIRST = "vertical_from_pinion_bearing_vertical_real_m_s2_per_n"
MISTAKES = {
    "no unit": (lambda v: renamed(v, FIRST, FIRST.removesuffix("_m_s2_per_n")), "no unit"),
    "wrong unit": (lambda v: renamed(v, FIRST, FIRST.replace("m_s2_per_n", "g_per_n")), "the unit g_per_n"),
    "no frequencies": (lambda v: renamed(v, "frequency_hz", "f"), "a column frequency_hz"),
    "unknown column": (lambda v: {**v, "coherence": v["frequency_hz"]}, "the column coherence"),
    "half a number": (lambda v: {n: x for n, x in v.items() if n != FIRST}, "real and imag"),
    "no force": (lambda v: {n: x for n, x in v.items() if "gear_bearing_vertical" not in n}, "two columns for every"),
    "other axis": (lambda v: renamed(v, "vertical_from", "axial_from"), "no columns vertical_from"),
    "not a number": (lambda v: {**v, FIRST: np.where(np.arange(v[FIRST].size) == 40, np.nan, v[FIRST])}, "not finite"),
    "too narrow": (lambda v: {n: x[:1000] for n, x in v.items()}, "0.45 fs_hz"),
    "not causal": (lambda v: {n: -x if "_imag_" in n else x for n, x in v.items()}, "before time 0"),
    "too coarse": (lambda v: {n: x[::64] for n, x in v.items()}, "impulse response"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_file_that_is_no_response_is_refused_by_name(tmp_path: Path, mistake: str) -> None:
    change, said = MISTAKES[mistake]
    save(change(columns()), tmp_path / "lid.parquet")
    with pytest.raises(ConfigError) as refused:
        load_config(written(tmp_path, {"kind": "measured", "file": "lid.parquet"}))
    assert {problem.path for problem in refused.value.problems} == {"sensors.lid.path.file"}
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ({"file": "nowhere.csv"}, "cannot be read"),
        ({}, "the path of a CSV"),
        ({"file": "set.yaml"}, "the ending '.yaml'"),
        ({"file": "text.csv"}, "a column frequency_hz"),
        ({"file": "text.parquet"}, "cannot be read"),
        ({"file": "text.npz"}, "cannot be read"),
        ({"file": "text.csv", "sha256": "0" * 64}, "leave sha256 out"),
        ({"response": "nonsense"}, "what siggen filled in itself"),
    ],
)
def test_a_path_without_a_usable_file_is_refused_by_name(tmp_path: Path, path: dict[str, str], said: str) -> None:
    for name in ("text.csv", "text.parquet", "text.npz"):
        (tmp_path / name).write_text("a,b\n1,2\n")
    with pytest.raises(ConfigError, match=said) as refused:
        load_config(written(tmp_path, {"kind": "measured", **path}))
    assert all(problem.path.startswith("sensors.lid.path.") for problem in refused.value.problems)


def test_a_measured_path_takes_no_more_cross_axis_sensitivity(tmp_path: Path) -> None:
    save(columns(), tmp_path / "lid.csv")
    source = written(tmp_path, {"kind": "measured", "file": "lid.csv"})
    with pytest.raises(ConfigError, match=r"sensors\.lid\.cross_axis"):
        load_config(source, ["sensors.lid.cross_axis=0.04"])
