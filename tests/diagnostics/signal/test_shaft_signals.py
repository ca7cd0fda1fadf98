"""What is left of an average after the mesh is taken away."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diagnostics.signal.shaft_signals import separated_average

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


# --- MATLAB's Predictive Maintenance Toolbox --------------------------------------------------------------------------


def test_worked_example_of_tsaresidual_leaves_the_tone_between_the_meshes() -> None:
    # its help page: shaft order 1 and meshes at orders 17 and 51, each with its second harmonic, go; order 10 stays
    angle = 2 * np.pi * np.arange(17 * 64) / (17 * 64)
    tone = 2 * np.sin(10 * angle)
    removed = {1: 1.0, 2: 1.0, 17: 3.0, 34: 3.0, 51: 4.0, 102: 4.0}
    average = tone + sum(a * np.sin(order * angle) for order, a in removed.items())
    np.testing.assert_allclose(separated_average(average, 17, shaft_orders=2, harmonics=6).residual, tone, atol=1e-11)


def test_parts_are_those_of_its_page_on_filtered_averages() -> None:
    # regular = shaft + mesh + sidebands, residual = average - shaft - mesh, difference = average - regular
    shaft, sidebands = np.cos(ANGLE) + np.cos(2 * ANGLE), np.cos((TEETH - 1) * ANGLE) + np.cos((2 * TEETH + 1) * ANGLE)
    mesh, rest = np.cos(TEETH * ANGLE) + np.cos(2 * TEETH * ANGLE), np.cos(5 * ANGLE) + np.cos((TEETH + 2) * ANGLE)
    parts = separated_average(shaft + mesh + sidebands + rest, TEETH, harmonics=2)
    np.testing.assert_allclose(parts.regular, shaft + mesh + sidebands, atol=1e-11)
    np.testing.assert_allclose(parts.residual, sidebands + rest, atol=1e-11)
    np.testing.assert_allclose(parts.difference, rest, atol=1e-11)


def test_with_two_harmonics_as_in_its_examples_the_third_stays_in_residual_and_difference() -> None:
    third = np.cos(3 * TEETH * ANGLE) + 0.3 * np.cos((3 * TEETH + 1) * ANGLE)
    average = np.cos(TEETH * ANGLE) + np.cos(2 * TEETH * ANGLE) + third
    two, every = separated_average(average, TEETH, harmonics=2), separated_average(average, TEETH)
    np.testing.assert_allclose(two.difference, third, atol=1e-11)
    np.testing.assert_allclose(every.difference, 0.0, atol=1e-11)


@given(seed=st.integers(0, 10_000), sidebands=st.integers(0, 4), harmonics=st.integers(1, 9))
def test_residual_is_difference_and_sidebands(seed: int, sidebands: int, harmonics: int) -> None:
    average = np.random.default_rng(seed).standard_normal(SAMPLES)
    parts = separated_average(average, TEETH, sidebands=sidebands, harmonics=harmonics)
    lines = np.fft.rfft(parts.residual - parts.difference)
    held = np.flatnonzero(np.abs(lines) > 1e-9)
    wanted = [h * TEETH + s * k for h in range(1, harmonics + 1) for k in range(1, sidebands + 1) for s in (-1, 1)]
    assert sorted(wanted) == held.tolist()
    np.testing.assert_allclose(lines[held], np.fft.rfft(average)[held], rtol=1e-9, atol=1e-9)
