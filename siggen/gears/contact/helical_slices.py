"""Slices of helical teeth: what each meets and how its teeth give way, at its own place on the path.

A slice beside the path of contact is that at the end of the path, and misses what the corner of the tip leaves there.
Damage is found by each slice on its own line across the face, at the slice's own place: contact lines cross it aslant.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.contact.face_gaps import FaceGaps, face_gaps
from siggen.gears.contact.pair_rest import PairRest, bending_length_m
from siggen.gears.contact.uneven_teeth import UnevenTeeth
from siggen.gears.damage.flank_chords import FlankChords, one_line
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import carrying_middle_m
from siggen.gears.geometry.missing_material import TipRelief, missing_at_m
from siggen.gears.stiffness.body_coupling import ring_torsion
from siggen.gears.stiffness.compliance import axial_part, tooth_compliance
from siggen.gears.stiffness.mesh_stiffness import rolls_at
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.names import Side

POINTS = 2049
"""Of curves over the path that slices are interpolated in."""
CORNERS = 0.3
"""How far beside the path corners are followed, in base pitches; farther slices miss more by as much as they go on."""


def helical_gaps(pair: GearPair, place_m: FloatArray, pinion: FlankChords, gear: FlankChords) -> FaceGaps:
    """Return the gaps of damage and tips at places of slices (k, n) [m]; both flanks have n slices."""
    places = np.ascontiguousarray(_on_path(pair, place_m).T)
    alone = [face_gaps(pair, one_line(pinion, j), one_line(gear, j), own) for j, own in enumerate(places)]
    return FaceGaps(*(np.concatenate(of_slices, axis=1) for of_slices in zip(*alone, strict=True)))


def helical_missing_m(pair: GearPair, place_m: FloatArray, relief: TipRelief | None) -> FloatArray:
    """Return what relief and corners leave out at places of slices (k, n) [m]."""
    start, end, reach = pair.contact_start_m, pair.contact_end_m, CORNERS * pair.base_pitch_m
    # Curves begin and end anew at the ends of the path, where relief stops and corners take over.
    parts = (
        np.linspace(start - reach, start, POINTS // 4)[:-1],
        np.linspace(start, end, POINTS),
        np.linspace(end, end + reach, POINTS // 4)[1:],
    )
    along = np.concatenate(parts)
    curve = sum(missing_at_m(pair, side, relief, along) for side in Side)
    beyond = np.abs(place_m - np.clip(place_m, along[0], along[-1]))
    return np.asarray(np.interp(place_m, along, curve) + beyond)


def helical_rest(pair: GearPair, place_m: FloatArray, options: StiffnessOptions) -> PairRest:
    """Return how both teeth give way at places of slices (k, n) [m], each slice as at its own height.

    Rigid across the face is what a body does in the middle of the line: its torsion, and its bending along the axis.
    """
    along = np.linspace(pair.contact_start_m, pair.contact_end_m, POINTS)
    place, own, rigid = _on_path(pair, place_m), [], np.zeros(len(place_m))
    middle = carrying_middle_m(pair, 0.5 * (place_m[:, 0] + place_m[:, -1]))
    for side, rolls in zip(Side, rolls_at(pair, along), strict=True):
        body = axial_part(pair, side, rolls, options)
        if options.foundation != "none":
            twist = ring_torsion(pair.member(side), pair.poisson_ratio) / (pair.youngs_modulus_pa * pair.face_width_m)
            body = body + twist
        bends = np.maximum(tooth_compliance(pair, side, rolls, options).total - body, 0.0)
        own.append(np.interp(place, along, bends))
        rigid += np.interp(middle, along, body)
    sound = np.stack([one.min(axis=1) for one in own])
    added = np.stack(own) - sound[:, :, np.newaxis]
    mean = np.sum([one.mean(axis=1) for one in own], axis=0)
    return PairRest(rigid, mean, bending_length_m(pair), UnevenTeeth(sound, added))


def _on_path(pair: GearPair, place_m: FloatArray) -> FloatArray:
    return np.asarray(np.clip(place_m, pair.contact_start_m, pair.contact_end_m))
