"""What is left of an average after the mesh is taken away."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.signal.difference_signal import separated_average

TEETH, SAMPLES = 18, 18 * 64
ANGLE = 2 * np.pi * np.arange(SAMPLES) / SAMPLES


def test_every_mesh_harmonic_first_sideband_and_shaft_order_is_taken_away() -> None:
    regular = 1.0 + np.cos(ANGLE) + np.cos(2 * ANGLE)
    for harmonic in range(1, 32):
        regular = regular + sum(np.cos((TEETH * harmonic + k) * ANGLE + k) for k in (-1, 0, 1))
    kept = np.cos(3 * ANGLE) + 0.1 * np.cos((TEETH + 2) * ANGLE)
    parts = separated_average(regular + kept, TEETH)
    np.testing.assert_allclose(parts.difference, kept, atol=1e-11)


def test_residual_keeps_the_sidebands() -> None:
    sidebands = np.cos((TEETH - 1) * ANGLE) + np.cos((TEETH + 1) * ANGLE)
    parts = separated_average(3.0 * np.cos(TEETH * ANGLE) + sidebands, TEETH)
    np.testing.assert_allclose(parts.residual, sidebands, atol=1e-12)
    np.testing.assert_allclose(parts.difference, 0.0, atol=1e-12)


@given(seed=st.integers(0, 10_000))
def test_parts_add_up_and_are_orthogonal(seed: int) -> None:
    average = np.random.default_rng(seed).standard_normal(SAMPLES)
    parts = separated_average(average, TEETH)
    np.testing.assert_allclose(parts.regular + parts.difference, average, atol=1e-12)
    assert abs(np.dot(parts.regular, parts.difference)) < 1e-10 * np.dot(average, average)
