from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.modal_path import HousingModes, housing_modes, modal_accelerance, modal_shares, mode_shape

MODES = housing_modes(np.array([400.0, 900.0, 2500.0]), np.array([0.01, 0.02, 0.03]), lowest_mass_kg=20.0, exponent=2.0)


def one_mode(ratio: float = 0.02) -> HousingModes:
    return housing_modes(np.array([1000.0]), np.array([ratio]), lowest_mass_kg=5.0, exponent=2.0)


def accelerance(modes: HousingModes, frequency_hz: list[float]) -> np.ndarray:
    ones = np.ones(modes.frequency_hz.size)
    return modal_accelerance(modes, ones[None], ones, np.array(frequency_hz))[0]


def test_a_mode_is_a_spring_below_its_resonance_and_a_mass_above() -> None:
    low, high = accelerance(one_mode(), [1.0, 1e6])
    # next terms of the series are (f/f_r)² = 1e-6 and 2 ζ f_r/f = 4e-5
    assert low == pytest.approx(-((1.0 / 1000.0) ** 2) / 5.0, rel=1e-4)
    assert high == pytest.approx(1.0 / 5.0, rel=1e-4)


def test_at_resonance_damping_alone_limits_the_accelerance() -> None:
    assert accelerance(one_mode(0.02), [1000.0])[0] == pytest.approx(1j / (2.0 * 0.02 * 5.0), rel=1e-12)


def test_the_sum_of_modes_is_the_response_of_masses_on_springs() -> None:
    """Each mode integrated as an oscillator m q'' + c q' + k q = φ F, independently of the formula in frequency."""
    from scipy.signal import lsim

    fs, f = 51200.0, 1234.0
    t = np.arange(20480) / fs
    total = np.zeros(t.size)
    for natural, ratio, mass in zip(MODES.frequency_hz, MODES.damping_ratio, MODES.modal_mass_kg, strict=True):
        w = 2 * np.pi * natural
        _, acceleration, _ = lsim(
            ([1.0, 0.0, 0.0], [mass, 2 * ratio * w * mass, w**2 * mass]), np.sin(2 * np.pi * f * t), t
        )
        total += acceleration
    last = slice(t.size - 4096, None)
    basis = np.stack([np.cos(2 * np.pi * f * t[last]), np.sin(2 * np.pi * f * t[last])], axis=1)
    cosine, sine = np.linalg.lstsq(basis, total[last], rcond=None)[0]
    # lsim holds the force linearly between samples: (2 π f/fs)²/12 = 2e-3; the start has decayed to e^-7
    assert sine + 1j * cosine == pytest.approx(accelerance(MODES, [f])[0], rel=5e-3)


def test_residues_fall_with_the_square_of_the_frequency() -> None:
    rng = np.random.default_rng(3)
    frequency, residue = [], []
    for _ in range(2000):
        natural = np.sort(np.exp(rng.uniform(np.log(300), np.log(8000), 9)))
        modes = housing_modes(natural, np.full(9, 0.02), lowest_mass_kg=20.0, exponent=2.0)
        frequency.append(natural / natural[0])
        residue.append(mode_shape(9, rng) * mode_shape(9, rng) / modes.modal_mass_kg)
    logs = np.log(np.ravel(frequency)), np.log(np.abs(np.ravel(residue)))
    slope = np.polyfit(*logs, 1)[0]
    # scatter of ln|φφ| is 0.45 and the abscissa's spread 1: standard error 0.45/√18000 = 0.003
    assert slope == pytest.approx(-2.0, abs=0.02)
    signs = np.sign(np.ravel(residue))
    assert abs(signs.mean()) < 4.0 / np.sqrt(signs.size)


def test_mode_shapes_have_mean_square_one_and_no_node() -> None:
    values = mode_shape(100_000, np.random.default_rng(1))
    # the square of a uniform number from 0.5 to 1.5 varies by 0.54 of its mean: standard error 0.0017
    assert (values**2).mean() == pytest.approx(1.0, abs=0.007)
    assert np.abs(values).min() > 0.4


@pytest.mark.parametrize(
    ("frequency", "ratio", "mass", "named"),
    [
        ([900.0, 400.0], [0.02, 0.02], 20.0, "frequency_hz"),
        ([400.0, 900.0], [0.02, 1.2], 20.0, "damping_ratio"),
        ([400.0, 900.0], [0.02], 20.0, "damping_ratio"),
        ([400.0], [0.02], 0.0, "lowest_mass_kg"),
    ],
)
def test_modes_that_cannot_be_are_refused(frequency: list, ratio: list, mass: float, named: str) -> None:
    with pytest.raises(ValueError, match=named):
        housing_modes(np.array(frequency), np.array(ratio), lowest_mass_kg=mass, exponent=2.0)


def test_what_modes_do_may_be_at_hand_and_changes_no_bit() -> None:
    rng = np.random.default_rng(5)
    at_input, at_output, grid = rng.normal(size=(4, 3)), rng.normal(size=3), np.linspace(0.0, 12800.0, 997)
    alone = modal_accelerance(MODES, at_input, at_output, grid)
    shared = modal_accelerance(MODES, at_input, at_output, grid, modal_shares(MODES, grid))
    assert alone.tobytes() == shared.tobytes()
