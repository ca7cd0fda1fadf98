"""The back flanks of a gear pair as the drive flanks of a pair in which the gear drives.

Derived. Seen in a mirror along the centre line back flanks are drive flanks. The gear turns first there, so positions
s' count from its base tangent point on the other line of action, and grow with the angle as those of drive flanks do.
At the angle at which tooth n of the pinion touches at s on its drive flank, its back flank touches at

    s' = T - (2 R_b1 (η_b1 + α_w) - s),     η_b1: half angle of a tooth on the base circle, α_w: working pressure angle

the next tooth n + 1 of the gear, since it stands in the space behind tooth n. Backlash would shift this by a quarter of
itself at most, some thousandths of a base pitch; it is left out.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial, MissingTables, touching_gap_m
from siggen.names import Side


def driven_pair(pair: GearPair) -> GearPair:
    """Return the same pair with the gear in front."""
    return replace(pair, pinion=pair.gear, gear=pair.pinion)


def pitches_ahead(pair: GearPair) -> float:
    """Return by how many base pitches a pair of back flanks is farther on its path than drive flanks are on theirs."""
    half = pair.pinion.base_half_angle_rad + pair.working_pressure_angle_rad
    return (pair.contact_start_m + pair.contact_end_m - 2.0 * pair.pinion.base_radius_m * half) / pair.base_pitch_m


def back_flanks(missing: MissingMaterial, pair: GearPair) -> MissingMaterial:
    """Return what back flanks miss, over positions s' of the driven pair; teeth keep the gear that they belong to.

    A tooth whose drive flank lies behind its place has a back flank that lies ahead by as much: places change sign.
    Forms are those of the drive flanks of the mirrored gear, whose teeth count the other way (assumed: both flanks of a
    tooth are made alike). Corners of tips touch where they do with the gear at its place.
    """
    line = pair.line_of_action_m
    mirrored = (_mirrored(missing, pair, side) for side in Side)
    return MissingMaterial(line - missing.end_m, line - missing.start_m, *mirrored)


def _mirrored(missing: MissingMaterial, pair: GearPair, side: Side) -> MissingTables:
    """Return the tables of a gear; tooth k + 1 of the gear takes part in the pair of tooth k."""
    teeth, later = (missing.pinion, 0) if side == Side.DRIVER else (missing.gear, 1)
    place = np.linspace(missing.start_m, missing.end_m, teeth.profile_m.shape[1])
    form = teeth.profile_m - touching_gap_m(pair, side, place)
    corner = touching_gap_m(driven_pair(pair), side.mate, pair.line_of_action_m - place[::-1])
    number = np.arange(teeth.kind_of_tooth.size) + later
    return MissingTables(
        profile_m=form[:, ::-1] + corner,
        kind_of_tooth=teeth.kind_of_tooth[-number % number.size],
        offset_m=0.0 - teeth.offset_m[number % number.size],
    )
