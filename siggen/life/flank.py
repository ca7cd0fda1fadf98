"""Flank: the working flank of a gear as a law of life sees it; places along it are arcs from the base circle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.gear_pair import GearPair, contact_zones
from siggen.mesh.damage_summary import flank_arc_m
from siggen.names import Side

PLACES = 65
"""Along the flank at which its curvature is known."""


@dataclass(frozen=True, slots=True)
class Flank:
    """All flanks of one gear, which are alike.

    Attributes
    ----------
    gear : Side
        Its gear.
    teeth : int
    turns : float
        Of this gear per turn of the pinion.
    face_m : float
        Width of the face [m].
    area_m2 : float
        Face times the arc of the involute from its rack-cut start to the tip, as labels measure shares [m²].
    active_arc_m, pitch_arc_m, tip_arc_m : float
        Where contact begins, where the pitch line lies and where the flank ends [m].
    sliding_m, curvature_per_m : (PLACES,)
        Arcs of single contact below the pitch line [m], and the relative curvature of both flanks there [1/m].
    """

    gear: Side
    teeth: int
    turns: float
    face_m: float
    area_m2: float
    active_arc_m: float
    pitch_arc_m: float
    tip_arc_m: float
    sliding_m: FloatArray
    curvature_per_m: FloatArray

    def start_m(self, exponent: float, u: float) -> float:
        """Return the arc at which a pit begins, drawn by a uniform [m].

        Derived: the density goes with the largest Hertz pressure to the power 2 m, where the load to the power m sets
        the life. The pressure goes with the root of load and curvature; in single contact the load is the same.
        """
        density = (self.curvature_per_m / self.curvature_per_m.max()) ** exponent
        steps = 0.5 * (density[1:] + density[:-1]) * np.diff(self.sliding_m)
        below = np.concatenate([[0.0], np.cumsum(steps)])
        return float(np.interp(u * below[-1], below, self.sliding_m))


def flanks(pair: GearPair) -> tuple[Flank, Flank]:
    """Return the flanks of pinion and gear."""
    return _flank(pair, Side.DRIVER), _flank(pair, Side.DRIVEN)


def _flank(pair: GearPair, side: Side) -> Flank:
    gear, line = pair.member(side), pair.line_of_action_m
    zone = next(z for z in contact_zones(pair) if z.start_m <= pair.pitch_point_m <= z.end_m)
    if side == Side.DRIVER:
        first, low, pitch = pair.contact_start_m, zone.start_m, pair.pitch_point_m
    else:
        first, low, pitch = line - pair.contact_end_m, line - zone.end_m, line - pair.pitch_point_m
    travel = np.linspace(low, pitch, PLACES)
    to_arc = 0.5 / gear.base_radius_m
    return Flank(
        side,
        gear.teeth,
        pair.pinion.teeth / gear.teeth,
        pair.face_width_m,
        pair.face_width_m * flank_arc_m(gear),
        to_arc * first**2,
        to_arc * pitch**2,
        0.5 * gear.base_radius_m * gear.flank_rolls_rad[1] ** 2,
        to_arc * travel**2,
        line / (travel * (line - travel)),
    )
