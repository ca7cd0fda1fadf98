"""Columns by bands of shaft orders, and random convolutions: known values, and no dependence on the start angle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import convolve1d

from diagnostics.audit.residual_lines import (
    band_bank,
    kurtogram_maximum,
    line_array,
    order_bands,
    residual_lines,
    whitened,
)
from diagnostics.audit.signal_attackers import (
    DILATIONS,
    KERNELS,
    LEVELS,
    STEPS,
    convolution_features,
    revolution,
)

ORDERS, TEETH = 362, 18


def noise_lines(records: int, channels: int = 1, seed: int = 1) -> np.ndarray:
    rng = np.random.default_rng(seed)
    size = (records, channels, ORDERS)
    return residual_lines(rng.standard_normal(size) + 1j * rng.standard_normal(size), np.full(records, TEETH))


def event_lines(angle_turn: float, order: float = 150.0) -> np.ndarray:
    """Lines of a burst of 2 % of a turn at an angle."""
    order_of = np.arange(ORDERS)
    return np.exp(-(((order_of - order) / 40.0) ** 2)) * np.exp(-2j * np.pi * order_of * angle_turn)


def test_bands_reach_from_the_shaft_sidebands_to_the_highest_order_in_all_widths() -> None:
    bands = order_bands(ORDERS - 1)
    assert min(low for low, _ in bands) == 9
    assert (9, ORDERS - 1) in bands
    assert any(low > 200 for low, _ in bands)
    assert any(95 <= low <= 110 and 280 <= high <= 310 for low, high in bands)
    assert all(high >= 1.2 * low for low, high in bands)


def test_gaussian_noise_has_kurtosis_three_and_a_burst_stands_out_in_its_band() -> None:
    noise = noise_lines(200)
    bank = band_bank(noise)
    column = bank.names.index("kurtosis, orders 102 to 204")
    # 100 lines with random phases are one noise of about 200 degrees of freedom: 3 within a few hundredths
    assert 10.0 ** bank.values[:, 0, column].mean() == pytest.approx(3.0, abs=0.1)
    with_burst = band_bank(noise + 1.0 * event_lines(0.3))
    assert with_burst.values[:, 0, column].mean() > bank.values[:, 0, column].mean() + 0.3
    low = bank.names.index("kurtosis, orders 9 to 13")
    assert with_burst.values[:, 0, low] == pytest.approx(bank.values[:, 0, low], abs=0.01)
    assert kurtogram_maximum(noise + event_lines(0.3)).mean() > 2.0 * kurtogram_maximum(noise).mean()


def test_lines_of_shafts_and_couplings_move_no_column() -> None:
    rng = np.random.default_rng(3)
    lines = rng.standard_normal((2, 1, ORDERS)) + 1j * rng.standard_normal((2, 1, ORDERS))
    loud = lines.copy()
    loud[..., 1:9] *= 100.0
    teeth = np.full(2, TEETH)
    np.testing.assert_array_equal(
        band_bank(residual_lines(loud, teeth)).values, band_bank(residual_lines(lines, teeth)).values
    )


def test_no_column_depends_on_where_the_revolution_starts_or_on_the_level() -> None:
    lines = noise_lines(3, 2) + event_lines(0.1)
    turned = 7.0 * lines * np.exp(-2j * np.pi * np.arange(ORDERS) * 0.2371)
    first, second = band_bank(lines), band_bank(turned)
    sampled = np.array(["local" in name for name in first.names])
    assert second.values[..., ~sampled] == pytest.approx(first.values[..., ~sampled], abs=1e-9)
    # the window of a twentieth of a turn moves in steps of 1/1024
    assert second.values[..., sampled] == pytest.approx(first.values[..., sampled], abs=0.02)
    shifted = lines * np.exp(-2j * np.pi * np.arange(ORDERS) * 100 / STEPS)
    features = convolution_features(revolution(np.concatenate([lines, shifted])))
    assert features[:3] == pytest.approx(features[3:], abs=1.01 / STEPS)


def test_a_convolution_is_the_one_of_another_library() -> None:
    waves = revolution(noise_lines(2))
    kernel, dilation = KERNELS[17], DILATIONS[3]
    weights = np.zeros(8 * dilation + 1)
    weights[::dilation] = -1.0
    weights[[place * dilation for place in kernel]] = 2.0
    answer = convolve1d(waves[:, 0].astype(np.float64), weights[::-1], axis=1, mode="wrap")
    place = (3 * len(KERNELS) + 17) * (len(LEVELS) + 1)
    found = convolution_features(waves)[:, place : place + len(LEVELS) + 1]
    expected = (answer[:, None, :] > np.quantile(answer, LEVELS)[None, :, None]).mean(axis=2)
    assert found[:, :-1] == pytest.approx(expected, abs=2.0 / STEPS)
    assert found[:, -1] == pytest.approx(answer.max(axis=1), rel=1e-5)


def test_whitening_leaves_lines_of_one_size_and_channels_that_were_not_measured_stay_undefined() -> None:
    steep = noise_lines(1) * np.exp(-np.arange(ORDERS) / 30.0)
    size = np.abs(whitened(steep))[0, 0]
    assert np.median(size[20:60]) == pytest.approx(np.median(size[300:350]), rel=0.3)
    lines = line_array([[np.ones(ORDERS, np.complex64), np.empty(0, np.complex64)]])
    assert np.isfinite(band_bank(lines).values[0, 0]).all()
    assert np.isnan(band_bank(lines).values[0, 1]).all()
