"""Averages of every gear: an event stands in the turn of the gear that it belongs to, whatever sensor and path."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.training.gear_rows import ROWS, STEPS, GearLines, gear_lines, gear_rows, joined
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
    records = joined([gear_lines({"lid": signal}, pulses, FS_HZ, TEETH) for signal in signals])
    known = None if healthy is None else gear_lines({"lid": healthy}, pulses, FS_HZ, TEETH)
    return gear_rows(records, known)[:, 0].astype(np.float64)


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


def test_the_change_of_an_unchanged_gearbox_is_as_large_as_its_noise_says() -> None:
    # of both gears; the event tells with which tooth the driven one began
    for gear, events in enumerate(({}, {"gear": 4.0})):
        pairs = [[record(np.random.default_rng(seed), **events)[0] for seed in (2 * k, 2 * k + 1)] for k in range(8)]
        pulses = record(np.random.default_rng(0))[1]
        changes = np.stack([rows_of([one], pulses, other)[0, gear, 2] for one, other in pairs])
        # 1 but for the scatter of k turns, whose inverse has a mean of (2 k - 2) / (2 k - 3): 1.4 % for the 36 of the
        # gear; eight pairs of 475 lines scatter by 1 / sqrt(8 x 475) = 1.6 %
        assert 2.0 * np.square(np.sinh(changes)).mean() == pytest.approx(1.0, abs=0.06)


def test_a_driven_gear_that_began_with_another_tooth_has_not_changed() -> None:
    rng = np.random.default_rng(4)
    lines, order = np.zeros((1, 2, 2, STEPS // 2), dtype=np.complex64), np.arange(STEPS // 2)
    lines[..., 9:400] = rng.standard_normal((1, 2, 2, 391)) + 1j * rng.standard_normal((1, 2, 2, 391))
    noise, teeth = np.where(np.abs(lines) > 0.0, 1.0, 0.0).astype(np.float32), np.array([TEETH])

    def changes(begun: float) -> np.ndarray:
        healthy = lines * np.exp(-2j * np.pi * order * np.array([[0], [begun]]) / np.array([[18], [47]]))
        both = np.concatenate([healthy.astype(np.complex64), lines])  # several, each turned by itself
        several = GearLines(both, np.repeat(noise, 2, axis=0), np.repeat(teeth, 2, axis=0))
        return np.asarray(np.abs(gear_rows(GearLines(lines, noise, teeth), several)[0, :, 1, 2:]))

    for begun in (0, 5, 46):
        assert changes(begun).max() < 1e-3  # of 1; complex64 and sixteen bits
    assert changes(2.5).max() > 1.0  # no whole teeth: another gear


def test_a_record_without_a_turn_is_refused_in_words() -> None:
    with pytest.raises(UsageError, match="received 1 pulses; allowed: 2 or more"):
        gear_lines({"lid": np.zeros(100)}, np.zeros(1), FS_HZ, TEETH)
