from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.responses import FrequencyResponse, curve_problems, grid_problems
from tests.sensing.resonances import accelerance

KEY = ("vertical", "pinion_bearing/vertical")
FS = 51200.0
MODES = (400.0, 1700.0), (0.05, -0.0028)


def modal(step_hz: float = 1.0, top_hz: float = 25600.0, first_hz: float = 0.0) -> FrequencyResponse:
    grid = np.arange(round(first_hz / step_hz), round(top_hz / step_hz) + 1) * step_hz
    return FrequencyResponse(grid, {KEY: accelerance(grid, *MODES)})


def found(response: FrequencyResponse, memory_s: float = 0.4) -> list[str]:
    return [f"{received}; {allowed}" for received, allowed in curve_problems(response, *KEY, memory_s)]


def changed(curve: np.ndarray, response: FrequencyResponse | None = None) -> FrequencyResponse:
    return FrequencyResponse((response or modal()).frequency_hz, {KEY: curve})


def test_a_measured_response_is_applied_as_it_was_given() -> None:
    response = modal(step_hz=2.0, first_hz=20.0)
    given = response.accelerance(KEY[0], (KEY[1],), response.frequency_hz)[0]
    assert np.abs(given - response.curves[KEY]).max() <= 1e-9 * np.abs(response.curves[KEY]).max()


def test_between_its_frequencies_it_runs_as_the_modes_do() -> None:
    between = np.arange(100.25, 20000.0, 7.0)
    exact = accelerance(between, *MODES)
    error = np.abs(modal().accelerance(KEY[0], (KEY[1],), between)[0] - exact)
    # a spline of step h has the error h⁴ f''''/384, for a resonance of half-width 8 Hz (1/8)⁴ 24/384 = 2e-5 of its peak
    assert error.max() < 5e-5 * np.abs(exact).max()


def test_below_its_band_it_falls_with_the_square_of_the_frequency() -> None:
    low = modal(first_hz=20.0).accelerance(KEY[0], (KEY[1],), np.array([0.0, 10.0, 20.0]))[0]
    assert low[0] == 0.0
    assert low[1] == pytest.approx(low[2] / 4.0)


def test_a_modal_response_is_accepted() -> None:
    assert found(modal()) == []
    assert found(modal(first_hz=20.0)) == []
    assert list(grid_problems(modal(first_hz=20.0).frequency_hz, FS)) == []


def test_a_response_with_the_phase_of_the_other_sign_is_not_causal() -> None:
    assert "before time 0" in found(changed(modal().curves[KEY].conj()))[0]


def test_a_response_of_random_phases_is_not_causal() -> None:
    phases = np.exp(2j * np.pi * np.random.default_rng(1).random(25601))
    assert "before time 0" in found(changed(np.abs(modal().curves[KEY]) * phases))[0]


def test_a_response_that_rings_longer_than_the_history_is_refused() -> None:
    assert "finer frequency step" in found(modal(), memory_s=0.02)[0]


def test_a_frequency_step_too_wide_for_the_damping_is_refused() -> None:
    assert found(modal(step_hz=40.0))


def test_numbers_that_are_not_finite_are_refused() -> None:
    curve = modal().curves[KEY].copy()
    curve[77] = np.nan
    assert found(changed(curve)) == ["1 value not finite; allowed: finite numbers"]


def test_a_path_through_which_nothing_passes_is_accepted() -> None:
    assert found(changed(np.zeros(25601, dtype=complex))) == []


@pytest.mark.parametrize(
    ("frequency", "said"),
    [
        (np.arange(10.0), "at least 16"),
        (np.arange(-1.0, 25600.0), "at least 16 finite frequencies from 0"),
        (np.r_[np.arange(100.0), np.arange(101.0, 25600.0)], "equally spaced"),
        (np.arange(25600.0, 0.0, -1.0), "ascending"),
        (np.arange(0.0, 20000.0), "0.45 fs_hz"),
        (np.arange(100.0, 25600.0), "at most 50 Hz"),
    ],
)
def test_frequencies_that_are_no_grid_over_the_band_are_refused(frequency: np.ndarray, said: str) -> None:
    assert said in "; ".join(*grid_problems(frequency, FS))
