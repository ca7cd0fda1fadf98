"""A decimated signal shows every extreme where it stands."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from diagnostics.explore.payload import (
    MOST_EXACT,
    drawn_signal,
    extreme_points,
    packed_column,
    packed_places,
    packed_steps,
    unpacked_column,
)
from tests.diagnostics.explore.unpacked import places, steps


@pytest.mark.parametrize("samples", [1000, 1001, 38_399])
def test_every_bucket_keeps_its_exact_extremes(samples: int) -> None:
    signal = np.random.default_rng(1).standard_normal(samples)
    drawn = extreme_points(signal, 37)
    edges = np.linspace(0, samples, 38).astype(int)
    for low, high in pairwise(edges):
        kept = drawn.value[(drawn.sample >= low) & (drawn.sample < high)]
        assert (kept.min(), kept.max()) == (signal[low:high].min(), signal[low:high].max())
    assert np.array_equal(signal[drawn.sample], drawn.value)


def test_one_impulse_in_a_long_record_is_drawn() -> None:
    signal = np.zeros(100_000)
    signal[61_803] = -7.0
    drawn = extreme_points(signal, 200)
    assert drawn.value[drawn.sample == 61_803] == [-7.0]


def test_a_fine_stretch_holds_every_sample_once() -> None:
    signal = np.random.default_rng(2).standard_normal(10_000)
    drawn = drawn_signal(signal, 50, (300, 900))
    assert np.all(np.diff(drawn.sample) > 0)
    assert set(range(300, 900)) <= set(drawn.sample.tolist())


def test_packed_values_come_back_within_half_a_step() -> None:
    values = np.append(np.random.default_rng(3).standard_normal(500) * 40.0, np.nan)
    packed = packed_steps(values)
    back = steps(packed)
    assert np.isnan(back[-1])
    assert np.abs(back[:-1] - values[:-1]).max() <= 0.5001 * packed["step"]
    assert packed["step"] == pytest.approx(np.nanmax(np.abs(values)) / 32767)


@pytest.mark.parametrize("found", [[0, 3, 3 + 65_535], [5, 70_000, 5_000_000], []])
def test_packed_places_come_back_exactly(found: list[int]) -> None:
    assert places(packed_places(np.array(found, dtype=np.int64))).tolist() == found


def test_a_column_keeps_its_digits_up_to_many_records_and_then_errs_by_four_in_a_thousand() -> None:
    values = np.random.default_rng(1).lognormal(0.0, 6.0, MOST_EXACT + 1)
    values[7] = np.nan
    np.testing.assert_array_equal(unpacked_column(packed_column(values[:-1])), values[:-1].astype("<f4"))
    short = packed_column(values)
    assert len(short["data"]) < 0.6 * len(packed_column(values[:-1])["data"])
    np.testing.assert_allclose(unpacked_column(short), values, rtol=2.0**-8)  # 7 bits of mantissa, rounded
