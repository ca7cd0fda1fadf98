"""Labels of damage on helical teeth: their contact lines cross it aslant."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import pi, tan

import numpy as np
import pytest

from siggen.damage.outlines import rectangle
from siggen.damage.pits import FlankPit
from siggen.damage.spalls import FlankSpall
from siggen.gears.gear_pair import GearPair
from siggen.mesh.damage_summary import damage_summary
from siggen.mesh.hertz import linear_compliance
from siggen.mesh.mesh_stiffness import mesh_stiffness
from siggen.mesh.mesh_tables import largest_stiffness_loss
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.gears.geometry.test_helical import helical_pair

PLAIN, BODY = StiffnessOptions(), StiffnessOptions(coupling="body")
FINE, PER_PITCH = 2001, 16
"""Of the slow sums: places across the face, lines in a base pitch."""
GROOVE, NARROW = (-5e-3, 25e-3), (4e-3, 10e-3)
TOOTH = 3


def spall(pair: GearPair, face_m: tuple[float, float], half_m: float = 0.3e-3) -> FlankSpall:
    pitch = float(pair.pinion.height_m(np.array([pair.pitch_point_m / pair.pinion.base_radius_m]))[0])
    return FlankSpall("pinion", TOOTH, rectangle((pitch - half_m, pitch + half_m), face_m), 0.2e-3, "flat")


@cache
def slow_line(pair: GearPair, position_m: float, one: FlankSpall | None) -> tuple[float, float, float]:
    """Return stiffness, lost and whole length of one line, place by place across the face."""
    across = pair.face_width_m * (np.arange(FINE) + 0.5) / FINE
    place = position_m + (across - 0.5 * pair.face_width_m) * tan(pair.base_helix_rad)
    on = (place >= pair.contact_start_m) & (place <= pair.contact_end_m)
    if not on.any():
        return 0.0, 0.0, 0.0
    rolls = {"pinion": place[on] / pair.pinion.base_radius_m}
    rolls["gear"] = (pair.line_of_action_m - place[on]) / pair.gear.base_radius_m
    lost, pits = np.zeros(on.sum(), bool), ()
    if one is not None:
        (low, high), (left, right) = one.outline.height_range_m, one.outline.face_range_m
        height = pair.pinion.height_m(rolls["pinion"])
        lost, pits = (height > low) & (height < high) & (across[on] > left) & (across[on] < right), (one,)
    share = lost.mean()
    teeth = tooth_compliance(pair, "pinion", rolls["pinion"], PLAIN, pits).total
    teeth = teeth + tooth_compliance(pair, "gear", rolls["gear"], PLAIN).total
    cell = pair.face_width_m / FINE
    if share == 1.0:
        return 0.0, lost.sum() * cell, on.sum() * cell
    contact = linear_compliance(pair, np.array([pair.face_width_m]))[0] / (1.0 - share)
    return float((1.0 / (contact + teeth)).sum() / FINE), lost.sum() * cell, on.sum() * cell


def slow_losses(pair: GearPair, one: FlankSpall) -> np.ndarray:
    """Return losses (k,) of the mesh as the damaged pair passes through contact, PER_PITCH a pitch."""
    count = int(pair.total_contact_ratio * PER_PITCH)
    step = pair.base_pitch_m / PER_PITCH
    sound = [slow_line(pair, pair.engagement_start_m + n * step, None)[0] for n in range(count + 1)]
    damaged = [slow_line(pair, pair.engagement_start_m + n * step, one)[0] for n in range(count + 1)]
    meshes = np.array([sum(sound[n % PER_PITCH :: PER_PITCH]) for n in range(count + 1)])
    return (np.array(sound) - damaged) / meshes


@pytest.mark.parametrize(("helix_deg", "face_m"), [(-15.0, NARROW), (25.0, GROOVE)])
def test_the_label_is_the_largest_loss_along_the_sloping_line(helix_deg: float, face_m: tuple[float, float]) -> None:
    pair = helical_pair(helix_deg)
    one, turn = spall(pair, face_m), 2.0 * pi / pair.pinion.teeth
    losses = slow_losses(pair, one)

    def found(pitches: np.ndarray) -> np.ndarray:
        sound, damaged = (mesh_stiffness(pair, (TOOTH + pitches) * turn, PLAIN, damage) for damage in ((), (one,)))
        return 1.0 - damaged / sound

    # The slow sum takes or leaves each of 2,001 places: 1/2,001 of what a line could lose.
    np.testing.assert_allclose(found(np.arange(losses.size) / PER_PITCH), losses, atol=1e-3 * losses.max() + 2e-5)
    label = largest_stiffness_loss(pair, (one,), PLAIN)
    assert label == pytest.approx(found(np.linspace(0.0, pair.total_contact_ratio, 4001)).max(), rel=1e-3)
    assert losses.max() < label * (1.0 + 1e-3)
    # Where a spur pair's groove takes the whole contact, a helical one keeps land.
    assert label < 0.03 < largest_stiffness_loss(replace(pair, helix_rad=0.0), (spall(pair, GROOVE),), PLAIN) == 1.0


def test_length_and_whole_loss_are_those_of_lines() -> None:
    pair = helical_pair(15.0)
    for half, whole in ((0.3e-3, False), (1.5e-3, True)):
        one = spall(pair, GROOVE, half)
        summary = damage_summary(pair, (one,))
        positions = np.linspace(pair.engagement_start_m, pair.engagement_end_m, 101)
        lines = np.array([slow_line(pair, position, one)[1:] for position in positions])
        # Places of 10 µm; the longest loss lasts a while.
        assert summary.contact_length_loss_m == pytest.approx(lines[:, 0].max(), rel=0.01)
        assert summary.through_face is whole is bool(np.any((lines[:, 1] > 0) & (lines[:, 0] == lines[:, 1])))


@pytest.mark.parametrize("options", [PLAIN, BODY])
def test_labels_of_no_helix_are_those_of_spur_teeth(options: StiffnessOptions) -> None:
    near, spur = helical_pair(1e-6), helical_pair(0.0)
    # Of spalls all slices are exact; the round ends of pits are seen on the middle lines of slices, where they overlap.
    pits = tuple(FlankPit("pinion", TOOTH, 1.9e-3, place, 0.3e-3, 0.2e-3, 0.2e-3) for place in (5e-3, 9e-3, 9.4e-3))
    for damage, near_enough in (((spall(spur, NARROW),), 1e-6), ((spall(spur, GROOVE),), 1e-6), (pits, 1e-4)):
        labels = [largest_stiffness_loss(pair, damage, options) for pair in (near, spur)]
        assert labels[0] == pytest.approx(labels[1], rel=near_enough)
        extents = [damage_summary(pair, damage) for pair in (near, spur)]
        assert extents[0].contact_length_loss_m == pytest.approx(
            extents[1].contact_length_loss_m, rel=10.0 * near_enough
        )
        assert extents[0].through_face is extents[1].through_face
