from __future__ import annotations

import numpy as np
import pytest

from siggen.sensing.responses import high_pass_response, resonance_response


def test_a_resonance_passes_low_frequencies_and_peaks_at_one_over_twice_its_damping() -> None:
    low, peak, above = resonance_response(np.array([0.0, 9000.0, 90000.0]), 9000.0, 0.04)
    assert low == 1.0
    assert abs(peak) == pytest.approx(1.0 / 0.08)
    assert abs(above) == pytest.approx(1.0 / 99.0, rel=1e-4)  # 1/(x² - 1), the damping adds (2 ζ x/x²)² = 7e-5


def test_a_coupling_capacitor_stops_the_mean_and_halves_the_power_at_its_corner() -> None:
    zero, corner, high = high_pass_response(np.array([0.0, 1.5, 1500.0]), 1.5)
    assert zero == 0.0
    assert 20.0 * np.log10(abs(corner)) == pytest.approx(-3.0103, abs=1e-4)
    assert abs(high) == pytest.approx(1.0, abs=1e-6)
