"""Missing material of gears with manufacturing errors: one row of the tables per tooth, a place for each of them.

Derived. To what all teeth of a gear miss (relief, corners) come its own slope and form, counted from the middle of the
active flank, and the way that eccentricity moves it while it is in mesh; the offset is where the tooth stands when it
is touched in that middle: pitch deviations times cos α, since they are arcs, and eccentricity. Beyond root end and tip
of a flank its last deviation holds; eccentricity goes on. Offsets shift the back flank too, as teeth that stand in a
wrong place do; for the radial part of an eccentricity (its share sin α) this is an approximation.

Slices of helical teeth meet slope and form each at its own place, and the pair sees their mean over the load
(`face_shares`). Eccentricity and place are those of the whole gear. All counts along the transverse line of action, as
the standard measures it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.errors.error_shapes import FLANK_POINTS
from siggen.gears.errors.gear_errors import GearErrors, eccentric_m
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial, MissingTables
from siggen.names import Side
from siggen.uniform_spline import UniformSpline


def with_errors(
    missing: MissingMaterial,
    pair: GearPair,
    pinion: GearErrors,
    gear: GearErrors,
    shares: FaceShares | None = None,
) -> MissingMaterial:
    """Return the missing material of the same teeth with errors; `shares` of helical teeth alone.

    Errors of size zero change no bit of any force. Tables may have rows per kind already; then every tooth keeps that
    of its kind.
    """
    return replace(
        missing,
        pinion=_with_errors(missing, missing.pinion, pair, Side.DRIVER, pinion, shares),
        gear=_with_errors(missing, missing.gear, pair, Side.DRIVEN, gear, shares),
    )


def _with_errors(
    missing: MissingMaterial,
    teeth: MissingTables,
    pair: GearPair,
    side: Side,
    errors: GearErrors,
    shares: FaceShares | None,
) -> MissingTables:
    position = np.linspace(missing.start_m, missing.end_m, teeth.profile_m.shape[1])
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    standing = eccentric_m(pair, side, errors, middle)
    if shares is None:
        profile = _profiles(pair, side, errors, position)
    else:
        profile = shares.mean(position, lambda place: _profiles(pair, side, errors, place))
    profile = profile - _profiles(pair, side, errors, middle)
    profile += eccentric_m(pair, side, errors, position) - standing
    cosine = float(np.cos(pair.member(side).pressure_angle_rad))
    return MissingTables(
        profile_m=teeth.profile_m[teeth.kind_of_tooth] + profile,
        kind_of_tooth=np.arange(len(profile), dtype=np.int32),
        offset_m=teeth.offset_m + cosine * errors.pitch_m + standing[:, 0],
    )


def _profiles(pair: GearPair, side: Side, errors: GearErrors, position_m: FloatArray) -> FloatArray:
    """Return slope and form of every tooth (z, k) at positions s (k,) [m]; the gear's flank runs against s."""
    place = (position_m - pair.contact_start_m) / (pair.contact_end_m - pair.contact_start_m)
    place = np.clip(place if side == Side.DRIVER else 1.0 - place, 0.0, 1.0)
    form = UniformSpline(0.0, 1.0 / (FLANK_POINTS - 1), errors.form_m.T)(place)
    return np.asarray(errors.slope_m[:, None] * place[None, :] + form.T)
