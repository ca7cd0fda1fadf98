"""Labels of teeth as they were made: the columns of `siggen.columns.manufacture_columns`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from siggen.gearbox.tooth_errors import MadeGear, SpecimenErrors
from siggen.gears.errors.flank_waves import FlankWaves
from siggen.names import Side
from siggen.specimen.mesh_teeth import MeshTeeth

Labels = dict[str, object]


def tooth_labels(teeth: MeshTeeth, state_id: int) -> Labels:
    """Return the labels of pinion and gear of a mesh in a state; none of perfect gears."""
    errors = teeth.errors(state_id)
    if errors is None:
        return {}
    drawn: Labels = {"manufacture_draw": "state" if teeth.teeth.redrawn else "specimen"}
    of_gears = (_errors(errors, teeth, side, side) | _waves(teeth, state_id, side, side) for side in Side)
    for labels in of_gears:
        drawn |= labels
    return drawn | {"lead_misalignment_um": 1e6 * errors.lead_misalignment_m}


def ring_and_planet_labels(suns: Sequence[MeshTeeth], ring: MeshTeeth, state_id: int, each: str) -> Labels:
    """Return the labels of a ring, and those of `each` planet towards the sun as lists."""
    of_ring = ring.errors(state_id)
    if of_ring is None:
        return {}
    planets = [_errors(errors, sun, Side.DRIVEN, each) for sun in suns if (errors := sun.errors(state_id)) is not None]
    return {
        **_errors(of_ring, ring, Side.DRIVEN, "ring"),
        **_waves(ring, state_id, Side.DRIVEN, "ring"),
        **{name: [one[name] for one in planets] for name in planets[0]},
    }


def _errors(errors: SpecimenErrors, teeth: MeshTeeth, side: Side, word: str) -> Labels:
    made: MadeGear = {Side.DRIVER: errors.pinion, Side.DRIVEN: errors.gear}[side]
    kinds = teeth.teeth.made
    largest, helix = made.found.largest, made.helix
    labels: Labels = {
        f"accuracy_class_{word}": made.accuracy_class,
        f"tolerance_share_{word}": made.tolerance_share,
        f"pitch_deviation_{word}_um": 1e6 * largest["pitch_m"],
        f"cumulative_pitch_{word}_um": 1e6 * largest["cumulative_pitch_m"],
        f"runout_{word}_um": 1e6 * largest["runout_m"],
        f"profile_slope_{word}_um": 1e6 * largest["profile_slope_m"],
        f"profile_form_{word}_um": 1e6 * largest["profile_form_m"],
        f"profile_deviation_{word}_um": 1e6 * largest["profile_m"],
    }
    if kinds is not None and kinds.crowned:
        labels[f"crowning_{word}_um"] = 1e6 * helix.crowning_m
    if kinds is not None and kinds.helices:
        labels[f"helix_slope_{word}_um"] = 1e6 * helix.slope_m
        labels[f"helix_form_{word}_um"] = 1e6 * float(np.ptp(helix.form_m))
    return labels


def _waves(teeth: MeshTeeth, state_id: int, side: Side, word: str) -> Labels:
    """Return the orders of a gear's ghosts, per turn of its shaft, and amplitudes before the contact's width."""
    waves = teeth.waves(state_id)
    if waves is None:
        return {}
    drawn: FlankWaves = {Side.DRIVER: waves.pinion, Side.DRIVEN: waves.gear}[side]
    count = waves.ghosts[side]
    return {
        f"ghost_orders_{word}": [int(n) for n in drawn.waves[:count]],
        f"ghost_amplitudes_{word}_um": [1e6 * float(a) for a in drawn.amplitude_m[:count]],
    }
