"""Several measured paths: every gearbox draws one, all sensors the same number; the set needs no file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.config import parse, parse_yaml, yaml_text
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.record.instrument import specimen_instrument
from tests.config.minimal import by_name, minimal
from tests.simulated import simulate

FLAT = np.arange(0.0, 12_801.0, 25.0)


def response_file(file: Path, level: float) -> str:
    """Write a flat path that passes nothing at frequency 0."""
    curve = level * FLAT**2 / (FLAT**2 + 100.0**2)
    stem = "vertical_from_{}_bearing_{}_{}_m_s2_per_n"
    forces = [(place, axis) for place in ("pinion", "gear") for axis in ("vertical", "horizontal")]
    real = {stem.format(*force, "real"): curve for force in forces}
    imag = {stem.format(*force, "imag"): 0.0 * curve for force in forces}
    np.savez(file, frequency_hz=FLAT, **real, **imag)
    return file.name


def with_paths(folder: Path, path: dict[str, Any], sensors: int = 1) -> Path:
    common = {"place": "casing", "axes": ["vertical"], "bits": None, "path": {"kind": "measured", **path}}
    listed = [{**common, "name": f"s{k}"} for k in range(sensors)]
    source = folder / "set.yaml"
    rigid = {"kind": "rigid", "mass_kg": 40.0}
    changes = {"dynamics__model": "casing", "duration_s": 0.1, "fs_hz": 25600.0, "housing": rigid}
    source.write_text(yaml_text(minimal(sensors=by_name(listed), **changes)))
    return source


def rms_levels(config: SetDesign, specimen: int) -> list[float]:
    channels = specimen_instrument(config.gearbox(specimen)).channels
    return [channel.path_rms_m_s2_per_n for channel in channels]


def test_every_gearbox_draws_one_of_the_files_and_its_sensors_the_same_one(tmp_path: Path) -> None:
    files = [response_file(tmp_path / f"p{k}.npz", 10.0**-k) for k in range(3)]
    config = load_config(with_paths(tmp_path, {"file": files}, sensors=2))
    drawn = np.array([rms_levels(config, specimen) for specimen in range(24)])
    np.testing.assert_array_equal(drawn[:, 0], drawn[:, 1])
    number = np.round(-np.log10(drawn[:, 0])).astype(int)
    counts = np.bincount(number, minlength=3)
    assert counts.size == 3
    # 24 gearboxes over 3 files: 8 each, standard deviation 2.3; a file that is never drawn lies 3.5 of these off
    assert counts.min() >= 2
    record = simulate(config, [0])[0]
    assert record.labels["path_number_s0_vertical"] == record.labels["path_number_s1_vertical"] == number[0]  # type: ignore[union-attr]


def test_one_file_in_the_list_gives_the_record_of_that_file_alone(tmp_path: Path) -> None:
    name = response_file(tmp_path / "p.npz", 0.01)
    single = simulate(load_config(with_paths(tmp_path, {"file": name})), [0])[0].channels["s0_vertical"]  # type: ignore[union-attr]
    listed = simulate(load_config(with_paths(tmp_path, {"file": [name]})), [0])[0].channels["s0_vertical"]  # type: ignore[union-attr]
    # a family holds float32: 6e-8 of every value of the path
    np.testing.assert_allclose(listed, single, atol=3e-7 * np.abs(single).max())


def test_a_set_with_several_paths_needs_no_file(tmp_path: Path) -> None:
    files = [response_file(tmp_path / f"p{k}.npz", 0.1 * (k + 1)) for k in range(2)]
    config = load_config(with_paths(tmp_path, {"file": files}))
    for name in files:
        (tmp_path / name).unlink()
    again = parse(parse_yaml(yaml_text(config.canonical()))).config
    assert again is not None
    assert again.identity == config.identity
    assert rms_levels(SetDesign(again), 3) == rms_levels(config, 3)


def test_a_wrong_file_of_several_is_named(tmp_path: Path) -> None:
    files = [response_file(tmp_path / "p0.npz", 0.1), "nowhere.npz"]
    with pytest.raises(ConfigError, match=r"nowhere\.npz"):
        load_config(with_paths(tmp_path, {"file": files}))
    with pytest.raises(ConfigError, match=r"path\.file: received .*; allowed: the path of a CSV"):
        load_config(with_paths(tmp_path, {"file": ["p0.npz", 3]}))


def test_the_table_of_siggen_path_is_read_again(tmp_path: Path) -> None:
    """It names sensors and has one column group for each of them."""
    from typer.testing import CliRunner

    out = tmp_path / "path.npz"
    table = tmp_path / "path.parquet"
    settings = ["duration_s=0.5", "background=null", "housing.damping_ratio=0.01"]
    options = [part for said in settings for part in ("--set", said)]
    result = CliRunner().invoke(
        app, ["inspect", "path", "quickstart", "--out", str(table), *options], catch_exceptions=False
    )
    assert result.exit_code == 0, result.output
    assert not out.exists()
    modal = load_config("quickstart", [*settings, "specimens=1"])
    raw = modal.canonical()
    for sensor in raw["sensors"].values():
        sensor |= {"place": "casing", "path": {"kind": "measured", "file": str(table)}}
        sensor["cross_axis"] = 0.0
    measured = load_config(raw)
    for before, after in zip(rms_levels(modal, 0), rms_levels(measured, 0), strict=True):
        assert after == pytest.approx(before, rel=0.02)  # cross-axis sensitivity is part of the table
    assert len(yaml_text(measured.canonical())) < 4 * 2**20
