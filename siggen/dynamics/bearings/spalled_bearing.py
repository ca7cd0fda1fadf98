"""SpalledBearing: the force between a shaft and its seat as balls pass a spall, as inputs of the equations of motion.

A ball that sinks into a spall is a movement of the base of its bearing's spring: what the ball does not bear any more
pushes shaft and seat together, equal on both and opposite (derived). The rest of the ring bears it, by the spring of
the bearing. The spring itself keeps its stiffness, though a ball less shares it, and a healthy bearing does not vary
as its balls pass: both are left out.

    outer   at β_o, still       balls pass it n FTF (1 - s) times a turn, each under the load of that place
    inner   turns with the shaft: the load of its place changes once a turn
    ball    meets both races once in every turn about its axis, under a load that changes once a turn of the cage
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.bearings.bearing_spall import RollingSpall
from siggen.dynamics.bearings.cage_course import CageCourse
from siggen.dynamics.drive.drive import Turning
from siggen.dynamics.drive.excitation import InputSource


@dataclass(frozen=True, slots=True)
class ZoneOfLoad:
    """Where the mean force of a shaft on its seat points from the horizontal [rad], and how far it moves the rings."""

    direction_rad: float
    deflection_m: float


@dataclass(frozen=True, slots=True, eq=False)
class SpalledBearing(InputSource):
    """A spall in a loaded bearing.

    Parameters
    ----------
    spall : BearingSpall
    zone : ZoneOfLoad
    cage : CageCourse
    order : float
        Turns of the shaft per turn of the pinion; negative if it turns from vertical to horizontal. Angles count from
        horizontal to vertical.
    directions : (2, n)
        Generalised forces per newton that a ball loses along both axes: on the shaft, and back on its seat.
    on_seat : place/axis -> (2,) force on the seat, per newton
    """

    spall: RollingSpall
    zone: ZoneOfLoad
    cage: CageCourse
    order: float
    directions: FloatArray
    on_seat: Mapping[str, FloatArray]

    @property
    def vectors(self) -> FloatArray:
        """The directions (2, n)."""
        return self.directions

    @property
    def sharp_turn_rad(self) -> float:
        """Until the spall stood at all angles to the load; of the outer race until two balls have passed."""
        cage_rad = 2.0 * pi / self.cage.order
        turns = {"outer": 2.0 * cage_rad / self.spall.bearing.balls, "inner": 2.0 * pi, "ball": cage_rad}
        return turns[self.spall.element] / abs(self.order)

    @property
    def seat_forces(self) -> Mapping[str, FloatArray]:
        """Forces on the seats (2,) per unit of both inputs, beside those of springs and dampers."""
        return self.on_seat

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the lost load (k, 2) [N] along both axes."""
        lost, toward = self.lost_n(turning.angle_rad)
        return np.stack([lost * np.cos(toward), lost * np.sin(toward)], axis=1)

    def lost_n(self, pinion_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what the ball in the spall, or next to it, loses (k,) [N], and its angle from horizontal (k,)."""
        sense, shaft_rad = np.sign(self.order), abs(self.order) * pinion_rad
        cage_rad = self.cage.angle_rad(shaft_rad)
        place_rad, apart_m, inside = self._nearest(shaft_rad, cage_rad)
        toward = sense * place_rad + self.zone.direction_rad
        bearing = self.spall.bearing
        squeezed = bearing.squeezed_m(self.zone.deflection_m, place_rad)
        return self.spall.lost_n(squeezed, self.spall.sunk_m(apart_m, inside)), toward

    def _nearest(self, shaft_rad: FloatArray, cage_rad: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray | bool]:
        """Return of the nearest ball its angle from the load, its way to the middle of the spall, and on which race."""
        spall, bearing = self.spall, self.spall.bearing
        if spall.element == "ball":
            turned = spall.place_rad + bearing.spin_per_cage * (cage_rad - self.cage.start_rad)
            race = np.rint(turned / pi)
            apart = 0.5 * bearing.ball_diameter_m * (turned - pi * race)
            return cage_rad, apart, race % 2.0 == 1.0
        inside = spall.element == "inner"
        place = spall.place_rad + (shaft_rad if inside else 0.0)
        apart = cage_rad - place
        apart -= bearing.spacing_rad * np.rint(apart / bearing.spacing_rad)
        radius = bearing.inner_radius_m if inside else bearing.outer_radius_m
        return np.asarray(place + apart), radius * apart, inside

    @property
    def ever_pushes(self) -> bool:
        """Whether any ball can lose load in it."""
        spall, bearing = self.spall, self.spall.bearing
        if spall.depth_m == 0.0:  # a sham
            return False
        half = bearing.half_zone_rad(self.zone.deflection_m)
        if spall.element != "outer":
            return half > 0.0
        reach = half + 0.5 * spall.length_m / bearing.outer_radius_m
        return half > 0.0 and cos(spall.place_rad) > cos(min(reach, pi))


def mean_zone(spall: RollingSpall, force_n: FloatArray) -> ZoneOfLoad:
    """Return the zone of load under the mean force (2,) of the shaft on its seat, horizontal and vertical [N]."""
    size = float(np.hypot(force_n[0], force_n[1]))
    return ZoneOfLoad(float(np.arctan2(force_n[1], force_n[0])), spall.bearing.deflection_m(size))
