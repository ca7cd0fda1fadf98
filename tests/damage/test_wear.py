"""Archard's wear on the flanks: volumes against the work of sliding, symmetry, growth, and where it is nothing."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, sqrt

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.arrays import FloatArray
from siggen.damage.flank_wear import POINTS, AtRest, WornFlanks, turn_factors, worn_until
from siggen.damage.on_flank import with_losses
from siggen.damage.part import Refusal
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import TipRelief, missing_material
from tests.gears.builders import pair_18_47

PAIR = pair_18_47()
FORCE_N, COEFFICIENT = 3000.0, 2e-17
PATH = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, POINTS)


def shared(pair: GearPair, position_m: FloatArray) -> FloatArray:
    """A load that is shared in halves by two pairs, and turns with the driver."""
    ahead, behind = position_m + pair.base_pitch_m, position_m - pair.base_pitch_m
    together = (ahead <= pair.contact_end_m) | (behind >= pair.contact_start_m)
    return np.where(together, 0.5 * FORCE_N, FORCE_N)


def rigid(position_m: FloatArray, *_: FloatArray) -> AtRest:
    return AtRest(shared(PAIR, position_m), 1e-3)


def test_a_pass_takes_the_coefficient_times_the_work_of_sliding_from_either_gear() -> None:
    """By quadrature over time, of speeds and arcs of flanks that are points at their radii."""
    base_1, base_2 = PAIR.pinion.base_radius_m, PAIR.gear.base_radius_m
    omega_1, line = 1.0, PAIR.line_of_action_m
    omega_2 = omega_1 * base_1 / base_2

    def speeds(s: float) -> tuple[float, float]:
        """Speeds along the flank: that of the point across the line of action."""
        first = sqrt((omega_1 * hypot(base_1, s)) ** 2 - (omega_1 * base_1) ** 2)
        second = sqrt((omega_2 * hypot(base_2, line - s)) ** 2 - (omega_2 * base_2) ** 2)
        return first, second

    def work_rate(s: float) -> float:
        first, second = speeds(s)
        return FORCE_N * abs(first - second) / (omega_1 * base_1)  # ds = R_b Ω dt

    ends = PAIR.contact_start_m, PAIR.contact_end_m
    work = quad(work_rate, *ends, points=[PAIR.pitch_point_m], epsabs=0, epsrel=1e-10)[0]
    factors = turn_factors(PAIR, PATH, COEFFICIENT)
    per_pass = factors[0] * FORCE_N, factors[1] * FORCE_N * 47 / 18
    fine = np.linspace(*ends, 40001)
    along = np.array([speeds(s) for s in fine]).T / (omega_1 * base_1)
    for depths, arc_rate in zip(per_pass, along, strict=True):
        volume = np.trapezoid(PAIR.face_width_m * np.interp(fine, PATH, depths) * arc_rate, fine)
        # Depths are linear between 513 places: 1e-5 of their curvature; the kink at the pitch point lies in one cell.
        assert volume == pytest.approx(COEFFICIENT * work, rel=1e-4)


def test_the_other_gear_as_driver_wears_the_same() -> None:
    """The way of a pair runs backwards, and a turn of the new driver is another time."""
    swapped = replace(PAIR, pinion=PAIR.gear, gear=PAIR.pinion)

    def mirrored(position_m: FloatArray, *_: FloatArray) -> AtRest:
        return AtRest(shared(swapped, position_m), 1e-3)

    worn = worn_until(PAIR, rigid, COEFFICIENT, depth_m=20e-6)
    other = worn_until(swapped, mirrored, COEFFICIENT, depth_m=20e-6)
    # Where a pair joins, half a load or a whole one may stand in a point that lies within rounding of the place.
    same = np.isclose(worn.pinion_m, other.gear_m[::-1], rtol=1e-9, atol=1e-15)
    assert np.count_nonzero(~same) <= 2
    assert other.turns == pytest.approx(worn.turns * 18 / 47, rel=1e-9)


def test_worn_flanks_miss_their_depth_on_all_teeth_and_two_of_them_the_deeper() -> None:
    relieved = missing_material(PAIR, TipRelief(8e-6, 2e-3), points=1025)
    deep, flat = WornFlanks("pinion", (4e-6, 0.0, 1e-6)), WornFlanks("pinion", (2e-6,) * 3)
    assert with_losses(relieved, PAIR, ()) is relieved
    worn = with_losses(relieved, PAIR, (deep, flat))
    places = np.linspace(relieved.start_m, relieved.end_m, 1025)
    expected = np.maximum(2e-6, np.interp(places, np.linspace(PATH[0], PATH[-1], 3), [4e-6, 0.0, 1e-6]))
    np.testing.assert_allclose(worn.pinion.profile_m - relieved.pinion.profile_m, expected[None], atol=1e-18)
    np.testing.assert_array_equal(worn.gear.profile_m, relieved.gear.profile_m)
    again = with_losses(relieved, PAIR, (flat, deep))
    np.testing.assert_array_equal(again.pinion.profile_m, worn.pinion.profile_m)


def test_wear_without_depth_is_refused() -> None:
    assert [one.name for one in WornFlanks("gear", (0.0, 0.0)).own_problems()] == ["depths_m"]
    assert isinstance(next(WornFlanks("gear", (0.0, np.nan)).own_problems()), Refusal)
    assert not list(WornFlanks("gear", (0.0, 1e-6)).own_problems())


def test_depths_in_the_table_run_from_the_root_to_the_tip_of_either_gear() -> None:
    pinion, gear = (WornFlanks(name, (4e-6, 1e-6, 2e-6)).table_row()["wear_depths_um"] for name in ("pinion", "gear"))
    # The path of contact begins at the pinion's root and ends at that of the gear.
    assert [pinion[0], pinion[len(pinion) // 2], pinion[-1]] == pytest.approx([4.0, 1.0, 2.0])
    assert gear == pytest.approx(pinion[::-1])
