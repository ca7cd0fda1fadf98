"""Encoders: what their speed says of the model's shafts, what their discs add, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.gearbox.plan import planned_record
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from tests.sensors.runs import GEAR_RATIO, line, loaded, problems, record

PERFECT = {"kind": "encoder", "pulses_per_turn": 20_000, "pitch_error": 0, "eccentricity": 0}
PINION, GEAR = {**PERFECT, "name": "first"}, {**PERFECT, "name": "second", "place": "gear"}


@pytest.mark.parametrize("variation", [{}, {"speed": {"random_rms": 0.01, "ripple_once": 0.02}}])
def test_perfect_encoders_of_both_gears_hold_the_approach_of_their_flanks(variation: dict) -> None:
    config = loaded(PINION, GEAR, dynamics__model="8dof", variation=variation)
    found = record(config)
    specimen = config.gearbox(0)
    state, pair = specimen_state(specimen, 0), specimen.pair
    response, _ = record_response(specimen, state, planned_record(config, 0), internals=True)
    first, second = (found.channels[f"{name}_rotation"].astype(np.float64) for name in ("first", "second"))
    rate = pair.pinion.base_radius_m * first - pair.gear.base_radius_m * second
    # the speed holds over the interval about a sample, so its sum is half an interval ahead
    turned = np.cumsum(rate)[1:-2] / config.fs_hz
    vectors = dict(zip(state.mesh.structure.coordinates, state.mesh.structure.mesh.vector, strict=True))
    translations = sum(
        vectors[name] * response.internals[f"{name}_m"] for name in ("x_pinion", "y_pinion", "x_gear", "y_gear")
    )
    approach = response.internals["approach_m"] - translations
    between = (9.0 * (approach[2:-1] + approach[1:-2]) - approach[3:] - approach[:-3]) / 16.0
    hz, true = _spectrum(between, config.fs_hz)
    _, wrong = _spectrum(turned - between, config.fs_hz)
    # to a tenth of fs the four samples of `between` tell less than 0.1 % wrong, (2π/10)^4 3/128 at its end
    low = hz < 0.09 * config.fs_hz
    assert np.linalg.norm(wrong[low]) < 1e-3 * np.linalg.norm(true[low])


OFF = {"dynamics__friction": {"model": "off"}}
"""With friction the speed settles on the spring that holds the load, 1e-4 of it in this second."""


def _spectrum(values: np.ndarray, fs_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Return frequencies and amplitudes of what changes, without the ends, where the speed of two pulses goes on."""
    inner = values[40:-40]
    return np.fft.rfftfreq(inner.size, 1 / fs_hz), np.abs(np.fft.rfft((inner - inner.mean()) * np.hanning(inner.size)))


def test_its_mean_is_the_speed_of_its_shaft_and_its_disc_adds_a_line_once_per_turn() -> None:
    wobbling = {**PERFECT, "name": "off", "place": "load", "eccentricity": 2e-3}
    config = loaded(PINION, wobbling, {**PERFECT, "name": "true", "place": "load"}, duration_s=1.0, **OFF)
    channels, hz = record(config).channels, 30.0 * GEAR_RATIO
    assert channels["first_rotation"].mean() == pytest.approx(2 * np.pi * 30.0, rel=1e-5)
    assert channels["true_rotation"].mean() == pytest.approx(2 * np.pi * hz, rel=1e-5)
    added = channels["off_rotation"] - channels["true_rotation"]
    expected = 2e-3 * 2 * np.pi * hz  # e/r Ω, from the angle e/r sin Ω t
    assert line(added, config.fs_hz, hz) == pytest.approx(expected, rel=0.01)  # 11.5 turns under a Hann window


def test_pitch_errors_return_every_turn_and_belong_to_the_gearbox() -> None:
    rough = {**PERFECT, "name": "rough", "pulses_per_turn": 256, "pitch_error": 0.02}
    config = loaded(rough, {**rough, "name": "smooth", "pitch_error": 0}, duration_s=0.4)
    errors = []
    for record_id in (0, 1, 2):
        found = record(config, record_id)
        marked = found.channels["rough_rotation"].astype(float) - found.channels["smooth_rotation"]
        angle = 2 * np.pi * 30.0 * np.arange(config.samples) / config.fs_hz + found.labels["start_angle_rad"]
        bins = np.floor(np.mod(angle, 2 * np.pi) / (2 * np.pi) * 128).astype(int)
        errors.append(np.bincount(bins, marked) / np.bincount(bins))
    same, other = np.corrcoef(errors)[0, 1:]
    assert same > 0.8  # the same disc in another state; marks fall between other samples
    assert abs(other) < 0.3  # 128 numbers of another gearbox: 1/sqrt(128) = 0.09


def test_it_leaves_all_other_channels_as_they_were() -> None:
    shaker = {"name": "bearing", "noise": {"floor_m_s2": 0.1}}
    alone, beside = (record(loaded(*sensors)).channels for sensors in ((shaker,), (PINION, shaker)))
    assert alone["bearing_vertical"].tobytes() == beside["bearing_vertical"].tobytes()


def test_what_has_no_pulses_is_refused() -> None:
    found = problems({**PINION, "pulses_per_turn": 0})
    assert found == {"sensors.first.pulses_per_turn": "0; allowed: a whole number from 1 to 100000"}
    found = problems({**PINION, "pulses_per_turn": 1}, duration_s=0.05)
    said = "1; allowed: at least 2; in duration_s its shaft makes 1.5 turns"
    assert found["sensors.first.pulses_per_turn"].startswith(said)
    assert "one of motor, pinion" in problems({**PINION, "place": "lid"})["sensors.first.place"]
    found = problems({**PINION, "eccentricity": [0.001, 3]})
    assert found["sensors.first.eccentricity"].endswith("allowed: a number from 0 to 0.1")
