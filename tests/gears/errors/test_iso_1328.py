from __future__ import annotations

from itertools import pairwise
from math import sqrt

import pytest

from siggen.gears.tolerances import flank_tolerances, outside_iso_1328
from tests.gears.builders import spur_gear

WIDTH_M = 20e-3
PRINTED = {
    # module, teeth: single pitch, cumulative pitch and total profile of classes 5 to 8 [µm], as printed elsewhere
    (1.5, 18): ((5.6, 16.0, 7.4), (8.0, 22.6, 10.5), (11.3, 31.9, 14.9), (15.9, 45.1, 21.0)),
    (1.5, 47): ((5.7, 17.8, 7.5), (8.0, 25.2, 10.6), (11.3, 35.6, 14.9), (16.0, 50.4, 21.1)),
    (2.0, 18): ((5.8, 16.8, 7.8), (8.3, 23.7, 11.0), (11.7, 33.5, 15.6), (16.5, 47.4, 22.0)),
    (2.0, 47): ((5.9, 18.9, 7.8), (8.3, 26.8, 11.1), (11.8, 37.8, 15.6), (16.7, 53.5, 22.1)),
    (3.0, 18): ((6.3, 18.2, 8.5), (8.8, 25.8, 12.0), (12.5, 36.5, 17.0), (17.7, 51.6, 24.0)),
    (3.0, 47): ((6.3, 20.9, 8.5), (9.0, 29.6, 12.1), (12.7, 41.8, 17.1), (17.9, 59.2, 24.1)),
}


@pytest.mark.parametrize(("gear", "classes"), PRINTED.items())
def test_printed_tolerances(gear: tuple[float, int], classes: tuple[tuple[float, float, float], ...]) -> None:
    for accuracy_class, printed in zip((5, 6, 7, 8), classes, strict=True):
        found = flank_tolerances(spur_gear(gear[1], 1e-3 * gear[0], 5e-3), WIDTH_M, accuracy_class)
        # Printed to a tenth of a micrometre.
        assert 1e6 * found.pitch_m == pytest.approx(printed[0], abs=0.051)
        assert 1e6 * found.cumulative_pitch_m == pytest.approx(printed[1], abs=0.051)
        assert 1e6 * found.profile_m == pytest.approx(printed[2], abs=0.051)


def test_helix_and_runout_of_class_5_by_hand() -> None:
    """By hand from the formulas of the 2013 edition, at d = 100 mm, b = 25 mm, m = 5 mm, where all roots are whole."""
    found = flank_tolerances(spur_gear(20, 5e-3, 10e-3), 25e-3, 5)
    by_hand = {
        "helix_slope_m": 0.5 + 1.75 + 4.0,
        "helix_form_m": 0.7 + 2.25 + 4.0,
        "profile_slope_m": 2.0 + 0.1 + 4.0,
        "profile_form_m": 2.75 + 5.0,
        "runout_m": 0.9 * (0.2 + 5.5 + 3.5 + 12.0),
    }
    assert {name: 1e6 * getattr(found, name) for name in by_hand} == pytest.approx(by_hand, rel=1e-12)


def edition_1995(module_mm: float, diameter_mm: float, width_mm: float) -> dict[str, float]:
    """Return class 5 of the first edition [µm], by formulas of its own with the geometric means of its ranges."""

    def mean(value: float, ends: tuple[float, ...]) -> float:
        low, high = next((a, b) for a, b in pairwise(ends) if a < value <= b)
        return sqrt(low * high)

    m = mean(module_mm, (0.5, 2.0, 3.5, 6.0, 10.0))
    d, b = mean(diameter_mm, (5.0, 20.0, 50.0, 125.0, 280.0)), mean(width_mm, (4.0, 10.0, 20.0, 40.0))
    return {
        "pitch_m": 0.3 * (m + 0.4 * sqrt(d)) + 4.0,
        "cumulative_pitch_m": 0.3 * m + 1.25 * sqrt(d) + 7.0,
        "profile_slope_m": 2.0 * sqrt(m) + 0.14 * sqrt(d) + 0.5,
        "profile_form_m": 2.5 * sqrt(m) + 0.17 * sqrt(d) + 0.5,
        "profile_m": 3.2 * sqrt(m) + 0.22 * sqrt(d) + 0.7,
        "helix_slope_m": 0.07 * sqrt(d) + 0.45 * sqrt(b) + 3.0,
        "helix_m": 0.1 * sqrt(d) + 0.63 * sqrt(b) + 4.2,
    }


@pytest.mark.parametrize("teeth", [18, 47])
def test_the_first_edition_of_the_standard_allowed_about_the_same(teeth: int) -> None:
    found = flank_tolerances(spur_gear(teeth, 3e-3, 10e-3), WIDTH_M, 5)
    # The editions differ: ranges against formulas. At this module by 16 % for the pitch of 141 mm, 18 % for the helix.
    for name, first in edition_1995(3.0, 3.0 * teeth, 20.0).items():
        assert 1e6 * getattr(found, name) == pytest.approx(first, rel=0.20), name


@pytest.mark.parametrize(
    ("teeth", "module_mm", "width_mm", "name"),
    [
        (18, 0.4, 20.0, "module: received 0.4 mm; allowed by ISO 1328-1: 0.5 to 70 mm"),
        (5, 0.9, 20.0, "reference diameter: received 4.5 mm"),
        (18, 3.0, 3.9, "face width: received 3.9 mm"),
        (1001, 3.0, 20.0, "teeth: received 1001"),
    ],
)
def test_gears_outside_the_standard_are_refused_by_name(
    teeth: int, module_mm: float, width_mm: float, name: str
) -> None:
    gear = spur_gear(teeth, 1e-3 * module_mm, 1e-4)
    assert len(outside_iso_1328(gear, 1e-3 * width_mm)) == 1
    with pytest.raises(ValueError, match=name):
        flank_tolerances(gear, 1e-3 * width_mm, 6)
