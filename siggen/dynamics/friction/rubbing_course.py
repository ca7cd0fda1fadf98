"""RubbingCourse: how strongly rough flanks excite the mesh over one tooth pitch.

Model: every pair adds its load times its sliding speed to the power p; loads are shared along the path of contact as
usual for straight teeth, rising from 1/3 to 2/3 where two pairs touch (reference: standard literature). At the pitch
point a single pair does not slide: there nothing is left.
"""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair

LEAST_SHARE = 1.0 / 3.0
"""Share of the load where a pair enters and leaves."""


def rubbing_course(pair: GearPair, exponent: float, points: int = 256) -> FloatArray:
    """Return the power (points,) over one base pitch from where a pair enters, of mean 1."""
    ratio = (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m
    phase = np.arange(points) / points
    place = phase[None, :] + np.arange(int(np.ceil(ratio)))[:, None]
    share = _shape(place, ratio)
    share /= share.sum(axis=0)
    # sliding is proportional to the distance from the pitch point
    pitch_m = pair.line_of_action_m / (1.0 + pair.gear.teeth / pair.pinion.teeth)
    sliding = np.abs(pair.contact_start_m + place * pair.base_pitch_m - pitch_m)
    power = (share * sliding**exponent).sum(axis=0)
    return np.asarray(power / power.mean())


def _shape(place: FloatArray, ratio: float) -> FloatArray:
    """Return the load of a pair at a place (in base pitches from its entry) before pairs share it; 0 off the path."""
    together = max(ratio - 1.0, 1e-9)
    from_end = np.minimum(place, ratio - place)
    rising = LEAST_SHARE * (1.0 + np.clip(from_end / together, 0.0, 1.0))
    alone = np.where(from_end >= together, 1.0, rising)
    return np.where((place >= 0.0) & (place <= ratio), alone, 0.0)
