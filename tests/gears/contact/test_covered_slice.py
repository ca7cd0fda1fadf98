"""Slices that damage covers in part: limits, pits finer than slices against three dimensions, an end that moves."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.damage.flank_chords import flank_chords
from siggen.damage.outlines import rectangle
from siggen.damage.spalls import FlankSpall
from siggen.mesh.contact_edges import NO_EDGE, gap_sink
from siggen.mesh.face_slices import CoveredSlice, covered_sink, face_gaps, spread_of_cells
from tests.gears.builders import pair_18_47
from tests.gears.contact.faces import (
    BENDING,
    RADIUS,
    REST,
    approach_under,
    face,
    part_spall,
    pitted,
    solve,
)
from tests.reference.contact.face_contact import FaceCase, approach_at, land_of_pits

GAP, TIPS, RADII = (0.5e-3, 0.05e-3, 0.2e-3, 0.2e-3), (-NO_EDGE, -NO_EDGE), (RADIUS, 0.0)


def test_the_sink_is_that_of_the_least_energy_and_its_slope_its_derivative() -> None:
    """Independent: the energy of land and gap summed finely and searched for its least value."""
    covered, spread = 0.4, spread_of_cells(1.28)
    one = CoveredSlice(GAP, TIPS, covered, spread, RADII)
    grid = np.linspace(0.0, 2.5e-6, 20001)
    sinks = np.array([gap_sink(*GAP, *RADII, load).sink_m for load in grid])
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (sinks[1:] + sinks[:-1]) * np.diff(grid))])

    def least(load: float) -> float:
        apart = np.linspace(0.0, load / (1.0 - covered), 40001)
        on_gap = covered * np.interp(load - (1.0 - covered) * apart, grid, energy)
        return float(np.min(0.5 * spread * covered * (1.0 - covered) * apart**2 + on_gap))

    for load in (0.1e-6, 0.3e-6, 0.8e-6):
        step = 0.02 * load
        found = covered_sink(one, load)
        assert found.sink_m == pytest.approx((least(load + step) - least(load - step)) / (2.0 * step), rel=2e-3)
        ahead, behind = (covered_sink(one, load + s).sink_m for s in (1e-10, -1e-10))
        assert found.slope == pytest.approx((ahead - behind) / 2e-10, rel=1e-4)


@pytest.mark.parametrize("teeth", [{}, {"teeth": BENDING, "rest": 0.25 * REST}], ids=["rigid", "bending"])
@pytest.mark.parametrize(("force", "length"), [(1200.0, 0.6e-3), (4000.0, 0.6e-3), (4000.0, 0.3e-3)])
def test_pits_finer_than_slices_lose_stiffness_as_in_three_dimensions(teeth, force: float, length: float) -> None:
    """Slices of 0.2 to 0.3 mm; when each took a pit whole or not at all they erred by up to 3 points at 0.3 mm."""
    rigid, (bends_m, compliance) = teeth.get("rest", REST), teeth.get("teeth", (np.inf, 0.0))
    case = FaceCase(cell_m=0.05e-3, tooth_length_m=bends_m, tooth_m_per_n=compliance)
    whole, damaged = (
        rigid * force + approach_at(case, land, force, reach=5.0)[0]
        for land in (np.ones(400, bool), land_of_pits(case, 16, length))
    )
    expected = 100.0 * (1.0 - whole / damaged)
    for slices, room in ((67, 0.8), (80, 0.8), (97, 0.4)):
        healthy = approach_under(face(slices=slices, **teeth), force)
        found = 100.0 * (1.0 - healthy / approach_under(pitted(16, length, slices, **teeth), force))
        assert found == pytest.approx(expected, abs=room), slices


def test_the_force_follows_the_end_of_a_spall_within_a_slice() -> None:
    """It falls steadily: the steps differ by a fifth of one slice's, where whole slices fell at once."""
    halves = np.linspace(5.4e-3, 5.8e-3, 41)
    forces = np.array([solve(part_spall(0.0, half=half, slices=100), 8e-6)[0].force_n for half in halves])
    steps = -np.diff(forces)
    assert np.all(steps > 0.0)
    assert steps.max() < 3.0 * steps.mean()


def test_slices_know_which_part_of_them_damage_covers() -> None:
    pair, slices = pair_18_47(), 50
    width = pair.face_width_m / slices
    ends = 10.25 * width, 20.75 * width
    spall = FlankSpall("pinion", 0, rectangle((1.6e-3, 2.4e-3), ends), 0.15e-3)
    chords = flank_chords(pair.pinion, (spall,), pair.face_width_m, slices)
    expected = np.zeros(slices)
    expected[11:20], expected[10], expected[20] = 1.0, 0.75, 0.75
    np.testing.assert_allclose(chords.covered, expected, atol=1e-9)
    assert chords.face_m[10] == pytest.approx(10.625 * width)
    plain = flank_chords(pair.gear, (), pair.face_width_m, slices)
    gaps = face_gaps(pair, chords, plain, np.array([pair.pitch_point_m, pair.contact_end_m]))
    np.testing.assert_allclose(gaps.covered[0], expected, atol=1e-9)
    assert gaps.on_damage.max() <= 1.0
    np.testing.assert_allclose(gaps.tips_m[1, :, 0], 0.0, atol=1e-9)
    assert chords.covered.sum() * width == pytest.approx(ends[1] - ends[0])
