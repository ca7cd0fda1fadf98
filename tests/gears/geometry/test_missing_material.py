from __future__ import annotations

import numpy as np
import pytest

from siggen.gears.missing_material import CORNER_REACH_PITCHES, missing_material
from tests.dynamics.pair_runs import RELIEF, gear_pair


def test_relief_is_a_parabola_that_ends_at_the_tips() -> None:
    pair = gear_pair()
    missing = missing_material(pair, RELIEF, corner_contact=False, points=2001)
    position = np.linspace(missing.start_m, missing.end_m, 2001)
    for teeth, tip in ((missing.pinion, pair.contact_end_m), (missing.gear, pair.contact_start_m)):
        distance = np.abs(position - tip)
        expected = np.where(distance < RELIEF.length_m, RELIEF.amount_m * (1.0 - distance / RELIEF.length_m) ** 2, 0.0)
        np.testing.assert_allclose(teeth.profile_m[0], expected, atol=1e-18)
    assert (missing.start_m, missing.end_m) == (pair.contact_start_m, pair.contact_end_m)


def test_beyond_the_path_of_contact_the_corner_gap_adds_to_the_relief_of_the_tip() -> None:
    pair = gear_pair()
    relieved, plain = (missing_material(pair, relief) for relief in (RELIEF, None))
    reach = CORNER_REACH_PITCHES * pair.base_pitch_m
    assert relieved.start_m == pytest.approx(pair.contact_start_m - reach)
    assert relieved.gear.profile_m[0, 0] == pytest.approx(plain.gear.profile_m[0, 0] + RELIEF.amount_m, rel=1e-12)
    assert relieved.pinion.profile_m[0, -1] == pytest.approx(plain.pinion.profile_m[0, -1] + RELIEF.amount_m, rel=1e-12)
    # Deeper than any approach of teeth that are not overloaded many times: 30 N m deflect them by 6 µm.
    assert min(plain.gear.profile_m[0, 0], plain.pinion.profile_m[0, -1]) > 35e-6
