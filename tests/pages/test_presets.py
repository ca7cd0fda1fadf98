"""Presets: bench and industrial in miniature, and what each of them promises."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import siggen
from diagnostics.audit.envelope import realism
from diagnostics.audit.leaks import separability_findings
from diagnostics.audit.measured_set import measured_set
from siggen.checks.loading import load_config
from siggen.checks.plausibility import implausible
from siggen.config.inheritance import inherited
from siggen.config.states import complete_states
from siggen.gearbox.configured import pair_of
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import SPLITS, split_of
from siggen.keys.yaml_source import read_yaml
from siggen.sets.verification import verify
from tests.simulated import simulate

CONFIGS = Path(__file__).parents[2] / "configs"
PRESETS = ("bench", "industrial")
LENGTHS_MM = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.25, 1.5]
SHARES = [0.2, 0.4, 0.8, 0.95]
THROUGH = "through_100"


def preset(name: str, states: tuple[str, ...], **changes: Any) -> SetDesign:
    """Return a preset with some of its states; those that lose the state they grew from begin with an intact gear."""
    raw = inherited(read_yaml(CONFIGS / f"{name}.yaml"), CONFIGS)
    complete = complete_states(raw["states"])[0]
    kept = {name: {**state, "grows": None} for name, state in complete.items() if name in states}
    return load_config({**raw, "states": kept, "duration_s": 0.3, **changes})


def test_a_preset_in_miniature_is_generated_and_verified(tmp_path: Path) -> None:
    """One that extends another."""
    config = preset("industrial", ("healthy", THROUGH), specimens=1, duration_s=0.1)
    siggen.generate(config, tmp_path / "set", executor="serial")
    assert verify(tmp_path / "set", sample=1, executor="serial").mismatches == ()
    assert siggen.open(tmp_path / "set").manifest.get("failures", []) == []


@pytest.mark.parametrize("name", PRESETS)
def test_the_ladder_of_a_preset_is_dense_where_damage_begins_to_show(name: str) -> None:
    config = load_config(CONFIGS / f"{name}.yaml")
    damages = [state.damage for state in config.config.states if state.name.startswith(("face_", "through_"))]
    width = config.config.gears.face_width_mm
    shares = [d.face_share if d.kind == "irregular" else d.face_length_mm / width for d in damages]
    assert shares == [*SHARES, *(1.0 for _ in LENGTHS_MM)]
    assert [d.profile_length_mm for d in damages if d is not None] == [*(1.0 for _ in SHARES), *LENGTHS_MM]


@pytest.mark.parametrize("name", PRESETS)
def test_every_gearbox_of_a_preset_has_two_healthy_records(name: str) -> None:
    config = load_config(CONFIGS / f"{name}.yaml")
    assert sum(state.damage is None for state in config.config.states) * config.repeats >= 2


@pytest.mark.slow
def test_slight_damage_of_the_bench_costs_one_to_three_percent_of_stiffness() -> None:
    losses = []
    for specimen in range(6):
        config = preset("bench", ("slight",), duration_s=0.01)
        losses.append(simulate(config, [specimen])[0].labels["mesh_stiffness_loss"])
    assert 0.005 < min(losses) < max(losses) < 0.04  # drawn pits: 1 to 3 % for nearly all of them
    assert 0.01 < np.median(losses) < 0.03


def test_states_of_one_bench_gearbox_share_gears_speed_torque_and_levels_of_noise(tmp_path: Path) -> None:
    config = preset("bench", ("healthy", "healthy_again", THROUGH), specimens=2, duration_s=0.05)
    siggen.generate(config, tmp_path / "bench", executor="serial")
    table = siggen.open(tmp_path / "bench").labels()
    rows = table.to_pylist()
    for specimen in (0, 1):
        own = [row for row in rows if row["specimen_id"] == specimen]
        shared = ("speed_hz", "torque_nm", "pitch_deviation_pinion_um", "path_modes_lid_vertical")
        levels = (
            "noise_floor_lid_vertical_m_s2",
            "rubbing_force_n",
            "machine_force_n_per_sqrt_hz",
            "lead_misalignment_um",
        )
        for name in (*shared, *levels):
            assert len({row[name] for row in own}) == 1, name
        assert len({row["start_angle_rad"] for row in own}) == len(own)


def test_healthy_records_of_the_bench_have_sidebands(tmp_path: Path) -> None:
    config = preset("bench", ("healthy",), specimens=4, duration_s=0.6)
    siggen.generate(config, tmp_path / "bench", executor="serial")
    measured = measured_set(siggen.open(tmp_path / "bench"))
    assert "healthy_without_sidebands" not in [finding.leak for finding in separability_findings(measured)]
    found = realism(measured)
    assert found is not None
    # -30 to -8 dB for nine tenths of channels measured. Of 24 gearboxes of bench 76 % lie inside (docs/understand/
    # presets.md), so of 8 at least 4: fewer have a chance of 2 %. An upper bound of -4 dB does not hold: of the 96
    # channel-records of that set 4 % lie above it, where the path is weak at the mesh line, and one of these 8 is at
    # -3.0 dB. None lies above -1.8 dB; at 0 dB a sideband is as strong as what it modulates.
    sideband = measured.values["sideband1_db"]
    assert np.all((sideband > -34.0) & (sideband < 0.0))
    assert np.mean((sideband > -30.0) & (sideband < -8.0)) >= 0.5
    assert -30.0 < np.median(sideband) < -8.0


MODULES_OF_ISO_54 = {1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}


def test_families_holds_many_usual_pairs_that_hunt_and_keeps_each_in_one_split() -> None:
    """Loading checks every pair; a change of the drawing of pairs would give the preset another identity."""
    config = load_config(CONFIGS / "families.yaml")
    pairs = config.config.gears.pairs
    assert len(pairs) >= 50
    assert {pair.module_mm for pair in pairs} <= MODULES_OF_ISO_54
    assert all(math.gcd(*pair.teeth) == 1 and pair.teeth[0] >= 17 for pair in pairs)
    assert all(7.7 <= pair.face_width_mm / pair.module_mm <= 15.3 for pair in pairs)
    found = {pair_of(config.config, i): split_of(config, i) for i in range(len(pairs))}
    assert [sum(split == name for split in found.values()) for name in SPLITS] == [36, 12, 12]
    assert str(pairs[0]) == "17/35 teeth, m 2.5, b 32 mm"
    assert implausible(config.possible) == ()
