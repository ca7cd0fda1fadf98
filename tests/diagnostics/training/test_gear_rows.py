"""Averages of every gear: an event stands in the turn of the gear that it belongs to, whatever sensor and path."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.training.gear_rows import ROWS, STEPS, GearLines, gear_lines, gear_rows
from siggen.errors import UsageError

TEETH = (18, 47)
FS_HZ, TURNS, SPEED_HZ = 20480.0, 94, 40.0  # 94 turns of the pinion are 36 of the gear: two hunting periods


def record(rng: np.random.Generator, *, pinion: float = 0.0, gear: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return noise with short events once per turn of either gear, and the pulses of the pinion."""
    time_s = np.arange(round((TURNS + 0.5) / SPEED_HZ * FS_HZ)) / FS_HZ
    wave = rng.standard_normal(time_s.size)
    for height, turn in ((pinion, 1.0), (gear, TEETH[0] / TEETH[1])):
        place = (time_s * SPEED_HZ * turn - 0.25) % 1.0
        wave += height * np.exp(-0.5 * (np.minimum(place, 1.0 - place) / turn * STEPS / 3.0) ** 2)
    return wave, np.arange(TURNS + 1) / SPEED_HZ


def rows_of(signals: list[np.ndarray], pulses: np.ndarray, healthy: np.ndarray | None = None) -> np.ndarray:
    found = [gear_lines({"lid": signal}, pulses, FS_HZ, TEETH) for signal in signals]
    lines, teeth = (np.stack(part) for part in zip(*found, strict=True))
    known = None if healthy is None else np.stack([gear_lines({"lid": healthy}, pulses, FS_HZ, TEETH)[0]] * len(lines))
    return gear_rows(GearLines(lines, teeth), known)[:, 0].astype(np.float64)


def test_an_event_stands_in_the_turn_of_its_own_gear() -> None:
    rng = np.random.default_rng(0)
    (of_pinion, pulses), (of_gear, _) = record(rng, pinion=3.0), record(rng, gear=3.0)
    found = np.abs(rows_of([of_pinion, of_gear], pulses)[:, :, 0])
    # a quarter of a turn; noise of unit rms stays below 4.5 over 1024 steps, what the other gear has is averaged out
    for row in (0, 1):
        assert found[row, row].max() > 6.0
        assert abs(found[row, row].argmax() - STEPS // 4) <= 3
        assert found[row, 1 - row].max() < 5.0


def test_neither_gain_nor_sign_of_a_sensor_moves_more_than_sixteen_bits_do() -> None:
    signal, pulses = record(np.random.default_rng(1), pinion=2.0)
    plain, other = rows_of([signal, -1e-4 * signal], pulses)
    assert np.allclose(plain, -other, rtol=2e-3, atol=2e-3)  # float16: 1e-3 of a value, twice


def test_a_change_is_told_in_parts_of_the_healthy_record_and_nothing_where_there_is_none() -> None:
    rng = np.random.default_rng(2)
    healthy, pulses = record(rng)
    event = record(np.random.default_rng(3), pinion=1.0)[0] - record(np.random.default_rng(3))[0]
    same, changed = rows_of([healthy, healthy + 0.5 * event], pulses, healthy)
    assert same[:, 2:].max() == 0.0
    assert abs(np.abs(changed[0, 2]).argmax() - STEPS // 4) <= 3
    for gain in (1.0, 30.0):  # of a sensor that sees both
        assert np.allclose(
            rows_of([gain * (healthy + 0.5 * event)], pulses, gain * healthy)[0], changed, rtol=2e-3, atol=2e-3
        )
    assert rows_of([healthy], pulses).shape == (1, 2, ROWS, STEPS)
    assert rows_of([healthy], pulses)[:, :, 2:].max() == 0.0


def test_a_driven_gear_that_began_with_another_tooth_has_not_changed() -> None:
    rng = np.random.default_rng(4)
    lines, order = np.zeros((1, 2, 2, STEPS // 2), dtype=np.complex64), np.arange(STEPS // 2)
    lines[..., 9:400] = rng.standard_normal((1, 2, 2, 391)) + 1j * rng.standard_normal((1, 2, 2, 391))
    teeth = np.array([TEETH])
    for begun in (0, 5, 46):
        healthy = lines * np.exp(-2j * np.pi * order * np.array([[0], [begun]]) / np.array([[18], [47]]))
        found = gear_rows(GearLines(lines, teeth), healthy.astype(np.complex64))[..., 2:, :]
        assert np.abs(found).max() < 1e-4  # of 1; complex64
    half = lines * np.exp(-2j * np.pi * order * 2.5 / 47)  # no whole teeth: another gear
    assert np.abs(gear_rows(GearLines(lines, teeth), half.astype(np.complex64))[:, :, 1, 2:]).max() > 1.0


def test_a_record_without_a_turn_is_refused_in_words() -> None:
    with pytest.raises(UsageError, match="received 1 pulses; allowed: 2 or more"):
        gear_lines({"lid": np.zeros(100)}, np.zeros(1), FS_HZ, TEETH)
