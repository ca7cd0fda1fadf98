"""Integrals of what crowded pits add to a tooth: converged, for all contacts."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.damage.flank_damage import pit_rows
from siggen.mesh.pitted_beams import pit_integrals, pit_sums
from siggen.mesh.tooth_compliance import section_breaks
from tests.gears.builders import pair_18_47, pit

PAIR = pair_18_47()


@pytest.mark.parametrize("floor", ["dish", "flat"])
def test_crowded_pits_are_integrated_as_exactly_as_on_ever_finer_parts(floor):
    rng = np.random.default_rng(5)
    crowd = [pit(rng.uniform(1.0, 4.0), rng.uniform(0.0, 20.0), 0.3, 0.2, 0.3, floor) for _ in range(100)]
    gear, width = PAIR.pinion, PAIR.face_width_m
    rows = pit_rows(crowd)
    roll = np.linspace(*PAIR.active_flank[0], 501)
    breaks = section_breaks(gear, rows, width, (0.0, gear.tip_roll_rad))
    ends = np.unique(np.concatenate([breaks, roll]))
    # Parts towards either end, down to 1e-4 of a piece: a square root's end leaves less than 1e-6 of it there.
    shares = np.array([1e-4, 1e-3, 0.01, 0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 0.999, 0.9999])
    fine = np.unique(np.concatenate([ends, (ends[:-1, np.newaxis] + np.diff(ends)[:, np.newaxis] * shares).ravel()]))
    flank = (rows, gear.base_radius_m, gear.base_half_angle_rad, width)
    found, exact = (pit_integrals(roll, cuts, *pit_sums(cuts, *flank), *flank) for cuts in (breaks, fine))
    # Damage adds less than a hundredth to a compliance, which therefore holds to 1e-8.
    np.testing.assert_allclose(found, exact, rtol=1e-6, atol=1e-12 * exact.max())
