"""Spectra, averages and flanks of the page against signals and shapes that are known."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from diagnostics.explore.payload import Detail, OrderAxis, PageAxes, record_views
from diagnostics.explore.set_source import outlines
from diagnostics.records.gear_train import pair_train
from diagnostics.records.recording import Recording
from diagnostics.signal.spectrum import envelope_spectrum
from tests.diagnostics.explore.unpacked import steps

TEETH = (10, 14)
FS_HZ = 10_240.0
SPEED_HZ = 20.0
STEPS = 16
AXES = PageAxes(Detail(100, 200, 400, 100, STEPS), OrderAxis(0.1, 400), OrderAxis(0.1, 100))


def meshing(start_turns: float, gear_tooth: int, bump: float = 5.0) -> Recording:
    """Return mesh line 3 of amplitude 2 and a bump wherever a pair with the given gear tooth enters contact."""
    turns = start_turns + SPEED_HZ * np.arange(round(3.5 * FS_HZ)) / FS_HZ
    pairs = turns * TEETH[0]
    since = (pairs - gear_tooth) % TEETH[1]
    signal = 2.0 * np.cos(2 * np.pi * 3 * pairs) + bump * np.exp(-0.5 * ((since - 0.5) / 0.1) ** 2)
    pulses = (np.arange(math.ceil(start_turns), math.floor(turns[-1]) + 1) - start_turns) / SPEED_HZ
    return Recording({}, {"a": signal.astype(np.float32)}, pulses, FS_HZ, pair_train(TEETH))


@pytest.mark.parametrize("start_turns", [0.0, 0.3, 2.0, 4.71, 6.99])
def test_a_gear_tooth_stands_at_its_number_whatever_angle_the_record_starts_at(start_turns: float) -> None:
    found = record_views(meshing(start_turns, 11), AXES, 2 * math.pi * start_turns)["channels"]["a"]
    average = steps(found["averages"][1])
    smooth = np.convolve(np.tile(average, 3), np.ones(STEPS) / STEPS, "same")[average.size : 2 * average.size]
    assert smooth.argmax() / STEPS == pytest.approx(11.5, abs=0.1)
    assert found["averages"][1]["numbered"]


def test_a_line_of_the_order_spectrum_has_the_amplitude_of_its_tone() -> None:
    found = record_views(meshing(0.3, 11, bump=0.0), AXES, None)["channels"]["a"]
    assert steps(found["spectrum"])[300] == pytest.approx(20 * math.log10(2.0), abs=0.02)
    assert not found["averages"][1]["numbered"]  # without a start angle nobody knows the gear's tooth


def test_amplitude_modulation_is_the_first_line_of_the_envelope() -> None:
    turns, per_turn, teeth = 20, 640, 18
    angle = 2 * np.pi * np.arange(turns * per_turn) / per_turn
    found = envelope_spectrum(3.0 * (1 + 0.2 * np.cos(angle)) * np.cos(teeth * angle), turns, teeth)
    assert found[turns] == pytest.approx(0.6, rel=1e-9)
    assert found[3 * turns :].max() < 1e-9


def test_a_record_without_pulses_shows_its_signal_and_says_what_is_missing() -> None:
    record = meshing(0.0, 0)
    found = record_views(replace(record, tacho_s=np.array([])), AXES, 0.0)
    assert "at least 2" in found["missing"]
    assert set(found["channels"]["a"]) == {"wave", "undefined"}


def test_the_largest_line_about_a_point_is_kept_and_gaps_take_the_nearest() -> None:
    amplitude = np.zeros(401)
    amplitude[203] = 1.0  # order 5.075 at 40 revolutions
    assert OrderAxis(0.1, 60).largest(amplitude, 40).argmax() == 51
    coarse = OrderAxis(0.1, 60).largest(np.arange(21.0), 2)
    assert coarse[:6].tolist() == [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]


def test_an_elliptic_pit_keeps_its_axes() -> None:
    row = {"gear": "gear", "tooth": 3, "kind": "pit", "depth_mm": 0.1, "polygon_face_mm": [], "polygon_height_mm": []}
    row |= {"face_mm": 8.0, "height_mm": 2.0, "semi_axis_face_mm": 1.5, "semi_axis_profile_mm": 0.5}
    row |= {"face_width_mm": 20.0, "pitch_height_mm": 2.5, "tip_height_mm": 5.0}
    corners = np.array(outlines([row])[0]["corners"])
    assert np.ptp(corners, axis=0).tolist() == [3.0, 1.0]
    assert corners.mean(axis=0).tolist() == pytest.approx([8.0, 2.0], abs=1e-3)
