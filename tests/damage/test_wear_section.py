"""Wear of a state: from the configuration to worn flanks, records and labels; growth and messages."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from diagnostics.indicators.record import record_values
from siggen.columns.record import SimulatedRecord
from siggen.damage.flank_wear import LABEL_POINTS, WornFlanks
from siggen.errors import ConfigError
from siggen.mesh.mesh_tables import TABLE_POINTS
from siggen.record.specimen_state import specimen_state, state_teeth
from siggen.record.static_mesh import static_mesh
from siggen.record.teeth import all_teeth
from tests.damage.test_damage import config_with, damage_of
from tests.simulated import damage_rows, simulate

WEAR: dict[str, Any] = {"kind": "wear", "depth_um": 20.0}


def test_both_gears_wear_and_the_pinion_deeper() -> None:
    pinion, gear = damage_of(config_with(WEAR), 1)
    assert (pinion.gear, gear.gear, pinion.tooth, gear.tooth) == ("pinion", "gear", -1, -1)
    assert pinion.depth_m == pytest.approx(20e-6, rel=1e-12)
    # By the ratio of turns alone the gear's flank would have 0.38 of the pinion's sliding way at its own root.
    assert 0.2 < gear.depth_m / pinion.depth_m < 0.6


def test_a_state_grows_from_the_milder_one_and_is_nowhere_less_deep() -> None:
    drawn = [5.0, 15.0]
    config = config_with({**WEAR, "depth_um": drawn}, WEAR, {**WEAR, "depth_um": 60.0})
    slight, moderate, severe = (damage_of(config, state) for state in (1, 2, 3))
    assert len(slight) == len(moderate) == len(severe) == 2
    for milder, deeper in ((slight, moderate), (moderate, severe)):
        for one, two in zip(milder, deeper, strict=True):
            assert np.all(np.asarray(two.depths_m) >= np.asarray(one.depths_m))


def test_rows_tell_the_depths_of_all_teeth_of_each_gear() -> None:
    config = config_with(WEAR)
    parts = damage_of(config, 1)
    rows = damage_rows(config, 1)
    assert [(row["gear"], row["tooth"], row["kind"], row["shape"]) for row in rows] == [
        ("pinion", -1, "wear", "none"),
        ("gear", -1, "wear", "none"),
    ]
    assert rows[0]["depth_mm"] == pytest.approx(0.02, rel=1e-12)
    depths = np.asarray(rows[0]["wear_depths_um"])
    assert depths.size == LABEL_POINTS
    assert depths.argmax() < LABEL_POINTS // 4  # from the root's end on
    gear = np.asarray(rows[1]["wear_depths_um"])
    assert gear[0] == pytest.approx(1e6 * parts[1].depths_m[-1])


def test_worn_gears_that_are_perfect_otherwise_stay_on_mesh_lines() -> None:
    """18 turns of the pinion, 50 samples per mesh period: all that is no harmonic of it stands in other lines."""
    config = config_with(WEAR).with_sections(fs_hz=27000.0, duration_s=0.6)
    healthy, worn = simulate(config, [0, 1])
    assert isinstance(healthy, SimulatedRecord)
    assert isinstance(worn, SimulatedRecord)
    assert (healthy.labels["fault"], worn.labels["fault"]) == ("healthy", "wear")
    assert (worn.labels["faulty_gear"], worn.labels["faulty_teeth_pinion"]) == ("several", [])
    lines = []
    for record in (healthy, worn):
        found = np.abs(np.fft.rfft(record.channels["bearing_vertical"].astype(float)))
        mesh = found[324::324].copy()
        found[324::324] = 0.0
        assert found[1:].max() < 1e-6 * mesh.max()
        lines.append(mesh)
    # 20 µm are twice the deflection: mesh lines are others.
    assert np.abs(lines[1][:4] / lines[0][:4] - 1.0).max() > 0.2


def test_the_loss_of_stiffness_of_an_even_layer_is_its_share_of_the_approach() -> None:
    """Closed form: a layer d off every flank adds d to the approach x at any load: F/x loses d/(x + d) at most."""
    config = config_with(WEAR)
    specimen = config.gearbox(0)
    state = specimen_state(specimen, 0)
    layer = WornFlanks("pinion", (5e-6,) * 9)
    teeth = state_teeth(specimen, all_teeth(specimen)[0], 0).tables
    worn = static_mesh(specimen.law, state.pair, teeth, TABLE_POINTS, (layer,))
    force_n = worn.force_n(60.0)
    approach = force_n / state.static.stiffness_n_per_m(60.0, np.linspace(0.0, 1.0, 2001))
    # 1e-4: 2001 angles do not meet the kink where the approach is least
    assert worn.largest_loss(60.0) == pytest.approx(5e-6 / (approach.min() + 5e-6), rel=1e-4)


def test_worn_records_tell_a_loss_of_stiffness_that_grows_and_a_sham_none() -> None:
    config = config_with({**WEAR, "depth_um": 5.0}, WEAR, {**WEAR, "depth_um": 25.0})
    states = (*config.config.states[:3], config.config.states[3].model_copy(update={"acts": False}))
    config = config.with_sections(states=states)
    loss = [specimen_state(config.gearbox(0), n).static.largest_loss(60.0) for n in range(4)]
    assert loss[0] == loss[3] == 0.0
    assert 0.05 < loss[1] < loss[2] < 1.0


def test_fm4_of_worn_gears_is_that_of_healthy_ones_in_the_same_noise() -> None:
    """All that wear adds stands in mesh lines, which the difference signal leaves out."""
    config = config_with(WEAR).with_sections(fs_hz=27000.0, duration_s=0.6)
    noise = np.random.default_rng(3).standard_normal(config.samples)
    found = []
    for record in simulate(config, [0, 1]):
        assert isinstance(record, SimulatedRecord)
        signal = record.channels["bearing_vertical"].astype(float) + noise
        values = record_values({"a": signal}, record.tacho_s, config.fs_hz, (18, 47)).values
        found.append((values["fm4_pinion__a"], values["mesh_amplitude_h1__a"]))
    (healthy, before), (worn, after) = found
    # 1 %: what interpolation over the turn leaves of lines that are ten times as high.
    assert worn == pytest.approx(healthy, rel=0.05)
    assert after > 3.0 * before


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"depth_um": 0.0}, r"states\.slight\.damage\.depth_um: received 0\.0; allowed: a number above 0"),
        ({"depth_um": None}, r"states\.slight\.damage\.depth_um"),
        (
            {"depth_um": 301.0},
            r"states\.slight\.damage\.depth_um: received 301; allowed: up to 300 um, 0\.1 of the module",
        ),
    ],
)
def test_what_cannot_be_is_refused_by_name(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        config_with({**WEAR, **change})


def test_wear_needs_flanks_with_a_shape_and_a_state_more_wear_than_its_milder_one() -> None:
    with pytest.raises(ConfigError, match=r"states\.slight\.damage\.kind: received 'wear'; allowed: another kind with"):
        config_with(WEAR, law="linear")
    with pytest.raises(ConfigError, match=r"states\.moderate\.damage\.depth_um"):
        config_with(WEAR, {**WEAR, "depth_um": 15.0})
    assert all(isinstance(one, WornFlanks) for one in damage_of(config_with(WEAR), 1))
