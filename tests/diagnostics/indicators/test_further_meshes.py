"""Indicators of gearboxes with several meshes, on signals whose sidebands are known in closed form."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from diagnostics.indicators.record import RecordValues, record_values
from diagnostics.indicators.registry import columns, indicator_columns, indicator_titles
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import PAIR, GearMesh, MeshNames, gear_names, meshes_of, with_teeth
from diagnostics.signal.order_domain import angle_grid, shaft_grid
from siggen import load_config
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError
from siggen.sets.drawn import set_columns
from tests.config.idler import idler
from tests.config.mill import mill
from tests.config.staged import SLOW, staged

TRAIN = set_columns(load_config(staged())).drivetrain
FS_HZ, SPEED_HZ = 12_800.0, 30.0
DEPTH = 0.2


def turned(time_s: np.ndarray) -> np.ndarray:
    """Return the turns of the first pinion: 30 Hz, with a slow swing of 0.47 Hz."""
    return SPEED_HZ * time_s + 0.15 * np.sin(np.pi * time_s)


def pulses(duration_s: float) -> np.ndarray:
    """Return the times of its whole turns, by Newton's method."""
    whole = np.arange(1, int(turned(np.array(duration_s))))
    time_s = whole / SPEED_HZ
    for _ in range(20):
        time_s = time_s - (turned(time_s) - whole) / (SPEED_HZ + 0.15 * np.pi * np.cos(np.pi * time_s))
    return time_s


def taken(modulation: str, front: float = 0.7, duration_s: float = 4.0) -> RecordValues:
    """Return the values of the lines of both meshes, that of `slow` modulated by one of its shafts."""
    time_s = np.arange(round(FS_HZ * duration_s)) / FS_HZ
    first = 2.0 * np.pi * turned(time_s)
    pinion, gear = first * 18 / 47, first * 18 / 47 * 17 / 52
    wave = 1.0 + DEPTH * np.cos({"pinion": pinion, "gear": gear}[modulation] + 0.3)
    signal = wave * np.cos(17 * pinion) + front * np.cos(18 * first)
    return record_values({"a": signal}, pulses(duration_s), FS_HZ, TRAIN)


def three() -> GearTrain:
    return set_columns(load_config(staged(stages=[SLOW, {**SLOW, "name": "last_one"}]))).drivetrain


def test_a_gear_train_has_exact_turns_and_the_gears_that_share_a_shaft() -> None:
    first, slow, last = meshes_of(three())
    assert first == GearMesh(MeshNames("fast", ("pinion", "gear")), (18, 47), Fraction(1), 0, 17)
    assert slow == GearMesh(MeshNames("slow", ("slow_pinion", "slow_gear")), (17, 52), Fraction(18, 47), 47, 17)
    assert last.names == MeshNames("last_one", ("last_one_pinion", "last_one_gear"))
    assert (last.turns, last.before, last.behind) == (Fraction(18 * 17, 47 * 52), 52, 0)


def test_orders_and_turns_of_every_mesh_are_those_that_the_set_stores() -> None:
    """Of two meshes, of three, and of an idler."""
    for train in (three(), set_columns(load_config(mill())).drivetrain, set_columns(load_config(idler())).drivetrain):
        turns = {shaft.name: shaft.turns for shaft in train.shafts}
        for mesh, stored in zip(meshes_of(train), train.meshes, strict=True):
            assert (mesh.turns * mesh.teeth[0]).as_integer_ratio() == stored.order
            assert mesh.turns.as_integer_ratio() == turns[train.gear(stored.driver).shaft]


def test_teeth_of_a_record_take_the_place_of_those_that_differ_within_a_set() -> None:
    drawn = set_columns(load_config("families", ["gears.pairs.count=3"])).drivetrain
    (mesh,) = meshes_of(with_teeth(drawn, {"pinion": 23, "gear": 61}))
    assert (mesh.names, mesh.teeth) == (PAIR[0], (23, 61))


def test_steps_of_a_geared_shaft_lie_on_the_steps_of_the_first_one() -> None:
    """Every 47th turn of the first pinion ends the 18th of the next shaft: both grids have the same times there."""
    times = pulses(8.0)
    own, geared = angle_grid(times, 64), shaft_grid(times, 64, Fraction(18, 47))
    assert geared is not None
    assert geared.revolutions == (times.size - 1) * 18 // 47
    shared = min(own.revolutions // 47, geared.revolutions // 18)
    assert shared >= 4
    np.testing.assert_array_equal(own.time_s[:: 47 * 64][:shared], geared.time_s[:: 18 * 64][:shared])
    assert shaft_grid(times[:2], 64, Fraction(18, 47)) is None


def test_sidebands_stand_at_the_shaft_and_the_mesh_that_have_them() -> None:
    """Modulation of index m by one sine gives m, sidebands of m/2 each, and nothing elsewhere.

    The pinion of `slow` and the gear in front stand on one shaft, so all lines are whole orders there: 1e-6 is what
    resampling leaves. The first pinion does not share a period with it: its average over 119 turns keeps one part in
    a hundred of the sideband.
    """
    found = taken("pinion").values
    assert found["mesh_amplitude_h1_slow__a"] == pytest.approx(1.0, abs=1e-6)
    assert found["mesh_amplitude_h1_fast__a"] == pytest.approx(0.7, rel=0.01)
    assert found["sideband_ratio_slow_pinion_h1_k3__a"] == pytest.approx(DEPTH, abs=1e-6)
    assert found["sideband_slow_pinion_h1_upper1__a"] == pytest.approx(0.5 * DEPTH, abs=1e-6)
    assert found["amplitude_modulation_slow_pinion_h1__a"] == pytest.approx(DEPTH, abs=1e-6)
    assert found["sideband_slow_gear_h1_upper1__a"] < 1e-3
    assert found["sideband_ratio_gear_h1_k3__a"] < 1e-6
    assert found["sideband_ratio_pinion_h1_k3__a"] < 0.01


def test_sidebands_of_the_last_shaft_are_read_beside_a_stronger_mesh_in_front() -> None:
    """Fourteen turns: the mesh in front, 20 times as strong, would leak into them; it is taken out beforehand.

    What leaks of the own mesh is below -31 dB of a sideband, as of a Hann window from two bins on.
    """
    found = taken("gear", front=20.0).values
    assert found["sideband_slow_gear_h1_upper1__a"] == pytest.approx(0.5 * DEPTH, rel=0.03)
    assert found["sideband_slow_gear_h1_lower1__a"] == pytest.approx(0.5 * DEPTH, rel=0.03)
    assert found["average_rms_slow_gear__a"] == pytest.approx(np.sqrt(0.5 * (1.0 + 0.5 * DEPTH**2)), rel=0.01)
    assert found["sideband_ratio_pinion_h1_k3__a"] < 0.01


def test_lines_of_the_mesh_in_front_are_no_difference_signal_of_the_shaft() -> None:
    """On one shaft stand 47 and 17 teeth: neither mesh's lines, nor first sidebands, are what damage leaves."""
    found = taken("pinion").values
    assert found["average_rms_slow_pinion__a"] == pytest.approx(np.sqrt(0.5 * (1.02 + 0.49)), rel=1e-4)
    assert found["difference_rms_slow_pinion__a"] < 1e-6
    assert found["difference_rms_gear__a"] < 1e-6
    # order 47 lies four below the third mesh harmonic, 51: it is no sideband of it
    assert np.isnan(found["sideband_slow_pinion_h3_lower4__a"])


def test_a_shaft_of_fewer_than_eight_turns_has_no_averages_and_says_so_once() -> None:
    found = taken("pinion", duration_s=2.0)
    assert found.notes.count("all slow_gear averages undefined") == 1
    assert "8 slow_gear revolutions" in found.notes
    gear = {name: value for name, value in found.values.items() if "_slow_gear" in name}
    assert gear
    assert all(np.isnan(list(gear.values())))
    assert np.isfinite(found.values["fm4_slow_pinion__a"])


def test_columns_are_called_after_the_gears_of_their_mesh_and_say_what_they_hold() -> None:
    settings, named = IndicatorSettings(), gear_names(set_columns(load_config(mill())).drivetrain)
    alone, both, known = columns(settings), columns(settings, named=named), indicator_columns(settings, named)
    first = [name for name in both if known[name].of_first]
    assert len(first) == len(alone)
    assert 0.9 * len(alone) < len(both) - len(first) < len(alone)
    titles = indicator_titles(settings, named=named)
    assert titles["fm0_eva_h5"] == "FM0, eva, mesh harmonics 1 to 5"
    assert "mesh slow" in titles["mesh_amplitude_h1_slow"]
    assert known["fm4_karl"].fields == {"shaft": "karl"}


def test_names_of_gears_that_make_two_columns_one_are_refused() -> None:
    with pytest.raises(UsageError, match="two of them are called cepstral_peak_a_b"):
        indicator_columns(IndicatorSettings(), (MeshNames("", ("a.b", "c")), MeshNames("x", ("a_b", "d"))))
