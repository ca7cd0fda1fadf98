"""Helix of one gear: crowning is a parabola, errors stay within slope, form and total of the standard."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from siggen.gears.errors import HELIX_POINTS, Helix, drawn_helix, straight_helix
from siggen.gears.tolerances import flank_tolerances
from tests.gears.builders import pair_18_47

LIMITS = flank_tolerances(pair_18_47().pinion, 0.02, 6)
FACE = np.linspace(0.0, 1.0, HELIX_POINTS)


def test_crowning_takes_all_at_both_ends_a_quarter_half_way_and_nothing_in_the_middle() -> None:
    missing = straight_helix(6e-6).missing_m(np.array([0.0, 0.25, 0.5, 1.0]))
    np.testing.assert_allclose(missing, [6e-6, 1.5e-6, 0.0, 6e-6], atol=1e-18)
    assert not straight_helix(6e-6).straight
    assert straight_helix().straight


@settings(max_examples=100, deadline=None)
@given(st.floats(-1.0, 1.0), st.floats(0.5, 5.0), st.floats(0.0, 6.3))
def test_a_machine_finds_slope_form_and_total_within_their_tolerances(slope: float, waves: float, phase: float) -> None:
    helix = drawn_helix(0.0, slope, waves, phase, LIMITS)
    found = helix.missing_m(FACE)
    line = np.polyfit(FACE, found, 1)
    # A machine's mean line is the least-squares one; the form is what is left about it.
    assert line[0] == pytest.approx(helix.slope_m, abs=1e-12)
    form = float(np.ptp(found - np.polyval(line, FACE)))
    used = abs(line[0]) / LIMITS.helix_slope_m, form / LIMITS.helix_form_m, float(np.ptp(found)) / LIMITS.helix_m
    assert max(used) <= 1.0 + 1e-9
    # The form or the total is at its limit: nothing smaller was drawn than the class allows.
    assert max(used[1:]) == pytest.approx(1.0, abs=1e-9)


def test_limits_of_zero_leave_a_straight_helix() -> None:
    assert drawn_helix(0.0, 0.7, 1.3, 0.4, LIMITS.times(0.0)).straight
    assert isinstance(drawn_helix(1e-6, 0.7, 1.3, 0.4, LIMITS.times(0.0)), Helix)
