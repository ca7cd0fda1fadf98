"""Averages and indicators of the members of planetary sets, on signals that are known in closed form.

A sensor at rest hears every planet through a path a over the carrier's angle t: y = sum_i a(t + psi_i) x(u - psi_i),
with the sun's angle u against the carrier. Lines of x at order j come through order k of a.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

from diagnostics.indicators.record import RecordValues, record_values
from diagnostics.indicators.registry import columns, indicator_columns, indicator_titles
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import Planets, gear_names, meshes_of, with_teeth
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, angle_grid, geared_pulses, resample_to_angle
from diagnostics.signal.synchronous_average import synchronous_average
from siggen import load_config
from siggen.columns.drivetrain import GearTrain
from siggen.sets.drawn import set_columns
from tests.config.planets import planets

FS_HZ, CARRIER_HZ, DURATION_S = 12_800.0, 6.0, 4.0
MEMBERS = ("sun", "planet", "ring")
IN_STEP, BETWEEN = (24, 27, 78), (25, 26, 77)
"""All planets mesh at once; the next one a third of a pitch later: the line moves to order 78 of the carrier."""
DEPTH, PHASE = 0.2, 0.3
Wave = Callable[[np.ndarray], np.ndarray]


def still(turn: np.ndarray) -> np.ndarray:
    return np.ones_like(turn)


def wave(turn: np.ndarray) -> np.ndarray:
    return 1.0 + DEPTH * np.cos(turn + PHASE)


def third(turn: np.ndarray) -> np.ndarray:
    return 1.0 + DEPTH * np.cos(3.0 * turn + PHASE)


def window(turn: np.ndarray) -> np.ndarray:
    """Return the Hann window of the literature: a sensor hears a planet best as it passes."""
    return 0.5 + 0.5 * np.cos(turn - 1.1)


def force(turn: np.ndarray) -> np.ndarray:
    """Return one direction of a force that turns with its planet: a path without a mean."""
    return np.cos(turn - 0.4)


def heard(
    path: Wave, teeth: tuple[int, int, int], waves: dict[str, Wave], start: float, duration_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return a record, and the times of the pulses of the sun's shaft, with modulations by member."""
    time_s = np.arange(round(duration_s * FS_HZ)) / FS_HZ
    carrier = 2.0 * np.pi * (CARRIER_HZ * time_s + start)
    sun, planet = carrier * teeth[2] / teeth[0], carrier * teeth[2] / teeth[1]
    signal = np.zeros(time_s.size)
    for place in 2.0 * np.pi * np.arange(3) / 3:
        of_planet = waves.get("planet", still)(planet) if place == 0.0 else 1.0
        mesh = waves.get("sun", still)(sun - place) * of_planet * np.cos(teeth[0] * (sun - place))
        signal += path(carrier + place) * waves.get("ring", still)(carrier + place) * mesh
    speed_hz = CARRIER_HZ * (1.0 + teeth[2] / teeth[0])
    return signal, np.arange(1, int(duration_s * speed_hz)) / speed_hz


def taken(
    path: Wave,
    teeth: tuple[int, int, int] = IN_STEP,
    start: float = 0.0,
    duration_s: float = DURATION_S,
    **waves: Wave,
) -> RecordValues:
    """Return the indicators of such a record, as those of a set's record are taken."""
    signal, pulses = heard(path, teeth, waves, start, duration_s)
    return record_values({"a": signal}, against_carrier(pulses, teeth), FS_HZ, train_of_set(teeth))


def train_of_set(teeth: tuple[int, int, int]) -> GearTrain:
    return with_teeth(set_columns(load_config(planets())).drivetrain, dict(zip(MEMBERS, teeth, strict=True)))


def against_carrier(pulses: np.ndarray, teeth: tuple[int, int, int]) -> np.ndarray:
    return geared_pulses(pulses, Fraction(teeth[2], teeth[0] + teeth[2]))


def sidebands(found: RecordValues, member: str) -> tuple[float, float]:
    lower, upper = (found.values[f"sideband_{member}_h1_{side}1__a"] for side in ("lower", "upper"))
    return lower, upper


@pytest.mark.parametrize("start", [0.0, 0.21, 0.9])
def test_a_wave_on_the_sun_comes_through_the_orders_of_the_path_that_equal_planets_leave(start: float) -> None:
    """24 teeth: the line comes through the path's mean 1/2, its sidebands through orders 1 and -1 with 1/4.

    25 teeth and a force that turns: line and upper sideband through orders 1 and -1 with 1/2, the lower one through
    the mean, which is zero. Hann windows keep other lines 31 dB below a sideband from two bins on.
    """
    found = taken(window, start=start, sun=wave)
    assert found.values["mesh_amplitude_h1__a"] == pytest.approx(3 * 0.5, rel=1e-3)
    assert sidebands(found, "sun") == pytest.approx((DEPTH / 4, DEPTH / 4), rel=0.03)
    assert max(sidebands(found, "planet")) < 0.03 * DEPTH
    between = taken(force, BETWEEN, start=start, sun=wave)
    assert between.values["mesh_amplitude_h1__a"] == pytest.approx(3 * 0.5, rel=1e-3)
    lower, upper = sidebands(between, "sun")
    assert upper == pytest.approx(DEPTH / 2, rel=0.03)
    assert lower < 0.03 * DEPTH


def test_a_plain_average_over_turns_of_the_sun_loses_what_a_window_over_the_carrier_keeps() -> None:
    signal, pulses = heard(force, BETWEEN, {"sun": wave}, 0.0, DURATION_S)
    own = against_carrier(pulses, BETWEEN)
    steps = resample_to_angle(signal, FS_HZ, angle_grid(own, 25 * SAMPLES_PER_TOOTH))
    plain = synchronous_average(steps, 25, SAMPLES_PER_TOOTH).signal
    kept = taken(force, BETWEEN, sun=wave).values["average_rms_sun__a"]
    assert kept == pytest.approx(1.5 * np.sqrt(0.5 * (1.0 + (DEPTH / 2) ** 2)), rel=0.01)
    assert plain.std() < 0.05 * kept


@pytest.mark.parametrize("start", [0.0, 0.21, 0.9])
def test_a_wave_on_one_planet_is_heard_where_its_window_stands(start: float) -> None:
    """One of three planets, at the top of its path, against a line of all through the mean: (m/2) 1/(3/2).

    Windows stand within 7.5 degrees of the best place, which costs 0.4 %.
    """
    found = taken(window, start=start, planet=wave)
    assert sidebands(found, "planet") == pytest.approx((DEPTH / 3, DEPTH / 3), rel=0.03)
    assert max(sidebands(found, "sun")) < 0.03 * DEPTH
    assert found.values["difference_rms_planet__a"] < 0.02


def test_a_wave_on_the_ring_stands_at_multiples_of_the_planets_beside_the_line() -> None:
    found = taken(window, ring=third)
    assert sidebands(found, "ring") == pytest.approx((DEPTH / 2, DEPTH / 2), rel=1e-3)
    assert max(*sidebands(found, "sun"), *sidebands(found, "planet")) < 0.03 * DEPTH
    healthy = taken(force, BETWEEN)
    assert max(sidebands(healthy, "ring")) < 1e-3
    for member in MEMBERS:
        assert healthy.values[f"residual_rms_{member}__a"] < 1e-3 * healthy.values[f"average_rms_{member}__a"]


def test_members_that_turn_too_seldom_have_no_averages_and_the_note_says_what_they_need() -> None:
    found = taken(window, duration_s=1.2, sun=wave)
    assert "all ring averages undefined, since they need 8 turns against the carrier" in found.notes
    assert np.isnan(found.values["fm4_ring__a"])
    assert np.isfinite(found.values["fm4_sun__a"])
    close = taken(window, BETWEEN, duration_s=1.2, sun=wave)
    assert "sun sidebands not resolved, by turns of the carrier: 1 (needs 17)" in close.notes
    assert np.isnan(sidebands(close, "sun")).all()


def test_columns_and_titles_name_the_member() -> None:
    settings, train = IndicatorSettings(), train_of_set(IN_STEP)
    named = gear_names(train)
    titles = indicator_titles(settings, named=named)
    every = columns(settings, named=named)
    assert {"rms", "fm4_sun", "sideband_ratio_planet_h1_k3", "band_kurtosis_ring_o75_150"} <= set(every)
    assert not [name for name in every if "pinion" in name or "gear" in name]
    assert "sun, mesh harmonic 1" in titles["sideband_ratio_sun_h1_k3"]
    assert indicator_columns(settings, named)["na4_star_ring"].entry.name == "na4_star"
    (mesh,) = meshes_of(train)
    assert (mesh.teeth, mesh.names.gears) == ((24, 78), MEMBERS)
    assert mesh.planets is not None
    assert mesh.planets.sun_turns == Fraction(78, 102)
    assert [Planets((24, 27, 78), places).passing for places in ((0.0, 1 / 3, 2 / 3), (0.0, 0.3, 2 / 3))] == [3, 1]
