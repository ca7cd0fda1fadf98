"""BallBearing: how the balls of a bearing turn, and how they share its radial load.

Kinematics (reference: standard literature): with κ = (d/D) cos φ, in turns of the inner ring per turn of it, outer ring
still, FTF = (1 - κ)/2, BPFO = n FTF, BPFI = n (1 - FTF), BSF = (D/2d)(1 - κ²).

Load (reference: Stribeck's zone of load): a ring that is moved by δ_r presses a ball at ψ from the load by
Q(ψ) = K (δ_r cos ψ cos φ - G/2)^(3/2), with the radial clearance G of both sides. Of balls at any angle the mean
n cos φ <Q cos ψ> bears the load F; without clearance Q(0) = 4.37 F/(n cos φ). K is Palmgren's for a ball between two
races of steel: δ = 4.4e-4 Q^(2/3) d^(-1/3) in mm and N (reference: catalogues, from memory).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, cos, pi, sin, sqrt

import numpy as np

from siggen.arrays import FloatArray

PALMGREN = 4.4e-4
"""mm N^(-2/3) mm^(1/3), as `siggen.rig.bearings`."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(48)
"""On an angle t with ψ = ψ_0 sin t, over which the load vanishes smoothly: exact to rounding."""
HALVINGS = 200
"""Of the bracket of a deflection: more than doubles have bits."""


@dataclass(frozen=True, slots=True)
class BallBearing:
    """A ball bearing whose outer ring stands still.

    Parameters
    ----------
    balls : int, from 1
    ball_diameter_m, pitch_diameter_m : float, the balls smaller than the circle of their centres, with room between
    contact_angle_rad : float, from 0 and below π/2
    clearance_m : float, radial play from side to side; below 0 all balls are squeezed without a load, too
    """

    balls: int
    ball_diameter_m: float
    pitch_diameter_m: float
    contact_angle_rad: float = 0.0
    clearance_m: float = 0.0

    @property
    def reach_m(self) -> float:
        """How far the races lie from the circle of the balls' centres, seen along the axis: (d/2) cos φ."""
        return 0.5 * self.ball_diameter_m * cos(self.contact_angle_rad)

    @property
    def outer_radius_m(self) -> float:
        """Radius of the path on the outer race."""
        return 0.5 * self.pitch_diameter_m + self.reach_m

    @property
    def inner_radius_m(self) -> float:
        """Radius of the path on the inner race."""
        return 0.5 * self.pitch_diameter_m - self.reach_m

    @property
    def cage_order(self) -> float:
        """FTF, turns of the cage per turn of the shaft."""
        return 0.5 * (1.0 - 2.0 * self.reach_m / self.pitch_diameter_m)

    @property
    def outer_order(self) -> float:
        """BPFO, balls that pass a place of the outer race."""
        return self.balls * self.cage_order

    @property
    def inner_order(self) -> float:
        """BPFI, balls that pass a place of the inner race."""
        return self.balls * (1.0 - self.cage_order)

    @property
    def spin_order(self) -> float:
        """BSF, turns of a ball about itself, seen from the cage; a place of it meets a race twice a turn."""
        return self.cage_order * self.spin_per_cage

    @property
    def spin_per_cage(self) -> float:
        """Turns of a ball about itself per turn of the cage, by which it rolls on the outer race."""
        return 2.0 * self.outer_radius_m / self.ball_diameter_m

    @property
    def spacing_rad(self) -> float:
        """Angle between two balls."""
        return 2.0 * pi / self.balls

    @property
    def room_m(self) -> float:
        """Distance of two balls' centres, below which their diameter lies."""
        return self.pitch_diameter_m * sin(0.5 * self.spacing_rad)

    @property
    def contact_n_per_m15(self) -> float:
        """K of a ball between both races: Q = K δ^(3/2) [N/m^(3/2)]."""
        return float(sqrt(1e3 * self.ball_diameter_m) * (1e3 / PALMGREN) ** 1.5)

    def squeezed_m(self, deflection_m: float, from_load_rad: FloatArray) -> FloatArray:
        """Return how far races squeeze balls at angles (k,) from the load [m], 0 outside of the zone."""
        along = deflection_m * cos(self.contact_angle_rad) * np.cos(from_load_rad)
        return np.maximum(along - 0.5 * self.clearance_m, 0.0)

    def half_zone_rad(self, deflection_m: float) -> float:
        """Return half the angle over which balls bear load; 0 where the clearance is not closed, π of all balls."""
        along, play = deflection_m * cos(self.contact_angle_rad), 0.5 * self.clearance_m
        if along <= abs(play):
            return pi if play < 0.0 else 0.0
        return acos(play / along)

    def force_n(self, deflection_m: float) -> float:
        """Return the mean radial force over all angles of the cage under which a ring is moved so far [N]."""
        half = self.half_zone_rad(deflection_m)
        place = half * np.sin(0.5 * pi * NODES)
        weights = 0.5 * pi * half * np.cos(0.5 * pi * NODES) * WEIGHTS
        squeezed = self.squeezed_m(deflection_m, place)
        load = self.contact_n_per_m15 * squeezed * np.sqrt(squeezed)
        return float(self.balls * cos(self.contact_angle_rad) * (weights * load * np.cos(place)).sum() / (2.0 * pi))

    def deflection_m(self, force_n: float) -> float:
        """Return how far the rings are moved under a radial force from 0 on [m], the closed clearance included.

        Raises
        ------
        ValueError
            If the force is negative or not finite.
        """
        if not 0.0 <= force_n < np.inf:
            raise ValueError(f"force_n: received {force_n}; allowed are finite forces from 0")
        low = max(0.5 * self.clearance_m, 0.0) / cos(self.contact_angle_rad)
        if force_n == 0.0:
            return low
        high = low + 1e-6
        while self.force_n(high) < force_n:
            high = low + 2.0 * (high - low)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            low, high = (low, middle) if self.force_n(middle) >= force_n else (middle, high)
        return high
