"""Presets: bench, industrial and ideal in miniature, and what each of them promises."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import siggen
from diagnostics.audit.envelope import realism
from diagnostics.audit.measured_set import measured_set
from diagnostics.audit.separability_findings import separability_findings, verdict
from siggen.checks.loading import load_config
from siggen.config import Config
from siggen.config.yaml_source import read_yaml
from siggen.record.simulation import simulate
from siggen.sets.verification import verify

CONFIGS = Path(__file__).parents[2] / "configs"
PRESETS = ("bench", "industrial", "ideal")
THROUGH = "through_100"


def preset(name: str, states: tuple[str, ...], **changes: Any) -> Config:
    """Return a preset with some of its states; those that lose the state they grew from begin with an intact gear."""
    raw = read_yaml(CONFIGS / f"{name}.yaml")
    kept = [{**state} for state in raw["states"] if state["name"] in states]
    for state in kept:
        if "damage" in state:
            state["grows_from"] = "none"
    return load_config({**raw, "states": kept, "duration_s": 0.3, **changes})


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_in_miniature_is_generated_and_verified(name: str, tmp_path: Path) -> None:
    config = preset(name, ("healthy", "face_80", THROUGH), specimens=1, duration_s=0.1)
    siggen.generate(config, tmp_path / name)
    assert verify(tmp_path / name, sample=2).mismatches == ()
    assert siggen.open(tmp_path / name).manifest.get("failures", []) == []


@pytest.mark.parametrize("name", PRESETS)
def test_the_ladder_of_a_preset_is_dense_where_damage_begins_to_show(name: str) -> None:
    config = load_config(CONFIGS / f"{name}.yaml")
    spalls = [state for state in config.states if state.damage is not None and state.damage.kind == "spall"]
    width = config.gears.face_width_mm
    through = [s.damage.profile_length_mm for s in spalls if s.damage.face_length_mm == width]
    assert through == [0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.25, 1.5]
    assert [s.damage.face_length_mm / width for s in spalls[: -len(through)]] == [0.2, 0.4, 0.8, 0.95]
    assert all(state.damage.height_reading == "arc" for state in spalls)


@pytest.mark.parametrize("name", PRESETS)
def test_every_gearbox_of_a_preset_has_two_healthy_records(name: str) -> None:
    config = load_config(CONFIGS / f"{name}.yaml")
    assert sum(state.damage is None for state in config.states) * config.repeats >= 2


@pytest.mark.slow
def test_slight_damage_of_the_bench_costs_one_to_three_percent_of_stiffness() -> None:
    losses = []
    for specimen in range(6):
        config = preset("bench", ("slight",), duration_s=0.01)
        losses.append(simulate(config, [specimen])[0].labels["mesh_stiffness_loss"])
    assert 0.005 < min(losses) < max(losses) < 0.04  # drawn pits: 1 to 3 % for nearly all of them
    assert 0.01 < np.median(losses) < 0.03


def test_states_of_one_bench_gearbox_share_gears_speed_and_torque_but_no_noise(tmp_path: Path) -> None:
    config = preset("bench", ("healthy", "healthy_again", THROUGH), specimens=2, duration_s=0.2)
    siggen.generate(config, tmp_path / "bench")
    table = siggen.open(tmp_path / "bench").labels()
    rows = table.to_pylist()
    for specimen in (0, 1):
        own = [row for row in rows if row["specimen_id"] == specimen]
        for name in ("speed_hz", "torque_nm", "pitch_deviation_pinion_um", "path_modes_lid_vertical"):
            assert len({row[name] for row in own}) == 1, name
        for name in ("start_angle_rad", "noise_floor_lid_vertical_m_s2", "force_noise_n_per_sqrt_hz"):
            assert len({row[name] for row in own}) == len(own), name


def test_healthy_records_of_the_bench_have_sidebands(tmp_path: Path) -> None:
    config = preset("bench", ("healthy",), specimens=4, duration_s=0.6)
    siggen.generate(config, tmp_path / "bench")
    measured = measured_set(siggen.open(tmp_path / "bench"))
    assert "healthy_without_sidebands" not in [finding.trap for finding in separability_findings(measured)]
    found = realism(measured)
    assert found is not None
    # -30 to -8 dB for nine tenths of the full set; 4 dB more for 8 channel-records of a third of its length
    sideband = measured.values["sideband1_db"]
    assert np.all((sideband > -34.0) & (sideband < -4.0))


def test_the_ideal_set_is_trivially_separable(tmp_path: Path) -> None:
    config = preset("ideal", ("healthy", "slight", THROUGH), specimens=4, duration_s=0.4)
    siggen.generate(config, tmp_path / "ideal")
    findings = separability_findings(measured_set(siggen.open(tmp_path / "ideal")))
    assert "healthy_without_sidebands" in [finding.trap for finding in findings]
    assert verdict(findings, config.specimens).startswith("The set is trivially separable")
