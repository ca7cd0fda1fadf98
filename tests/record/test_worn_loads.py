"""Worn flanks under the load of the mesh at rest, and their transmission error, against a slow computation by hand."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from siggen.damage.flank_wear import POINTS, Worn, WornFlanks, worn_until
from siggen.damage.on_flank import with_losses
from siggen.gearbox.teeth import gear_pair
from siggen.mesh.mesh_tables import TABLE_POINTS
from siggen.mesh.pair_law import MeshConstants, pair_law
from siggen.mesh.static_mesh import static_approaches_m
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.record.contact import tooth_tables
from siggen.record.motion import teeth_missing
from siggen.record.teeth import load_at_rest
from tests.damage.test_damage import config_with
from tests.record.worn_by_hand import SlowPair

PER_PITCH = 960
TEETH = StiffnessOptions("base_circle", "none")
WORE_UNDER_N, FORCE_N, DEPTH_M, RELIEF_M = 2500.0, 1500.0, 20e-6, 60e-6
"""So long a relief for so little force that no tip corner touches beside the path: the computation by hand has none."""
GEARS, SPECIMEN = config_with().config.gears, config_with().gearbox(0)
LAW = replace(SPECIMEN.law, relief_m=RELIEF_M)
PAIR = SPECIMEN.pair
PATH = np.linspace(PAIR.contact_start_m, PAIR.contact_end_m, POINTS)


@cache
def worn() -> Worn:
    load = load_at_rest(LAW, PAIR, TEETH, WORE_UNDER_N)
    return worn_until(PAIR, load, 1e-17, depth_m=DEPTH_M)


@cache
def by_hand() -> tuple[SlowPair, list[np.ndarray]]:
    slow = SlowPair(PAIR, RELIEF_M, 0.25 * PAIR.base_pitch_m, PER_PITCH)
    return slow, slow.worn(WORE_UNDER_N, DEPTH_M, 160)


def test_both_flanks_wear_as_by_hand() -> None:
    slow, depths = by_hand()
    for found, expected in zip((worn().pinion_m, worn().gear_m), depths, strict=True):
        # Steps of 0.125 µm against 1 µm and less, and the cells in which the load has its steps.
        assert np.mean(np.abs(np.interp(slow.s, PATH, found) - expected)) < 2e-3 * DEPTH_M


@pytest.mark.parametrize("worn_depth", [0.0, 1.0])
def test_mesh_harmonics_of_the_transmission_error_at_rest_are_those_by_hand(worn_depth: float) -> None:
    """Solved across the face, as records are; 20 µm on all teeth, and none."""
    parts = tuple(
        WornFlanks(which, tuple((worn_depth * depths).tolist()))
        for which, depths in (("pinion", worn().pinion_m), ("gear", worn().gear_m))
    )
    teeth = tooth_tables(LAW, PAIR, (), TEETH, TABLE_POINTS, 3.0 * FORCE_N)
    law = pair_law(
        teeth.tables,
        with_losses(teeth_missing(LAW, PAIR, TABLE_POINTS), PAIR, parts),
        MeshConstants(PAIR.line_of_action_m, 1.0, PAIR.base_pitch_m),
        damping_ratio=0.0,
        contact=teeth.contact,
    )
    found = static_approaches_m(law, FORCE_N, np.arange(PER_PITCH) / PER_PITCH)
    slow, depths = by_hand()
    expected, _ = slow.rest(FORCE_N, worn_depth * (depths[0] + depths[1]), "weber_banaschek")
    lines, hand = (np.fft.rfft(values)[1:5] / PER_PITCH for values in (found, expected))
    # The way is tabulated to 1e-3 (one cell of the profile at each step of the load); the contact of slices that feel
    # each other is 0.6 % of these harmonics stiffer than Weber and Banaschek's whole face.
    np.testing.assert_allclose(np.abs(lines), np.abs(hand), rtol=0.01)


def test_swapped_gears_wear_the_same_under_the_same_force() -> None:
    other = gear_pair(GEARS.model_copy(update={"pinion": GEARS.gear, "gear": GEARS.pinion}))
    load = load_at_rest(LAW, other, TEETH, WORE_UNDER_N)
    swapped = worn_until(other, load, 1e-17, depth_m=DEPTH_M)
    # The end of a pair's way is the beginning of the other: steps of the load lie in other cells of the profile.
    for one, two in ((worn().pinion_m, swapped.gear_m), (worn().gear_m, swapped.pinion_m)):
        assert np.mean(np.abs(one - two[::-1])) < 1e-3 * DEPTH_M
