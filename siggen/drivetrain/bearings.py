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

from siggen.arrays import ComplexArray, FloatArray

PALMGREN = 4.4e-4
"""mm N^(-2/3) mm^(1/3), as `siggen.rig.bearings`."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(48)
"""On an angle t with ψ = ψ_0 sin t, over which the load vanishes smoothly: exact to rounding."""


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
        """Return how far the rings are moved under a radial force from 0 on [m], the closed clearance included."""
        low = max(0.5 * self.clearance_m, 0.0) / cos(self.contact_angle_rad)
        if force_n == 0.0:
            return low
        from scipy.optimize import brentq  # here: a tenth of a second that imports need not wait for

        # F^(2/3) is nearly straight over the way, and below 0 by rounding alone.
        def left(way_m: float) -> float:
            return float(max(self.force_n(way_m), 0.0) ** (2.0 / 3.0) - force_n ** (2.0 / 3.0))

        reach = 1e-6
        while left(low + reach) < 0.0:
            reach *= 2.0
        return low if left(low) >= 0.0 else float(brentq(left, low, low + reach, xtol=1e-18, rtol=1e-15))


# LoadedBearing: how stiff a ball bearing is under its load, and how far it moves as its balls pass.
#
# Derived. With the cage at some angle the rings, moved by q, squeeze the ball at ψ_i by s_i = (q · u_i) cos φ - G/2,
# where u_i is its direction and G the clearance; its load is K s_i^(3/2) where s_i > 0 (`BallBearing`). The energy
# (2/5) Σ K s_i^(5/2) - F · q is convex, so Newton finds the q at which balls bear the load F, and its second
# derivatives (3/2) K cos²φ Σ √s_i u_i u_iᵀ are the stiffness there. Both repeat when a ball stands where its neighbour
# stood.
#
# What moves with the gears takes the stiffness as constant: its mean over the angles of the cage. The movement under
# the constant load, less its mean, lies in series with that spring: the bearing varies as its balls pass. Of many
# balls the stiffness is dF/dδ along the load and F/δ across it.

ANGLES = 32
"""Of the cage over the spacing of two balls: the mean stiffness is that of 512 angles within 0.5 % (test)."""
STEPS = 400
TOLERANCE = 1e-9
"""Left of the load when Newton ends; stiffnesses are then exact to about as much."""
ROUNDING = 1e-15
"""Of the way: a step below it moves nothing. Under a light load in a wide clearance that comes first."""
RIDGE = 1e-9
"""Of a ball's stiffness, added while balls on one line leave a direction without any; the solution has none of it."""
LEAST_STEP = 2.0**-40
OVERSHOOT = 0.5
"""Slope of the energy at the end of a step, uphill, over that at its start."""


@dataclass(frozen=True, slots=True, eq=False)
class LoadedBearing:
    """A ball bearing at rest under its mean load.

    Attributes
    ----------
    bearing : BallBearing
    force_n : (2,) on the shaft, along two axes
    moved_m : mean way of the shaft along the load, closed clearance included
    along_n_per_m, across_n_per_m : mean stiffness in the direction of the load and at right angles to it
    passing_m : (ANGLES, 2)
        Way along the load and across it, less its mean, with the first ball at the middles of as many equal parts of
        the spacing ahead of the load; angles count from along to across.
    """

    bearing: BallBearing
    force_n: FloatArray
    moved_m: float
    along_n_per_m: float
    across_n_per_m: float
    passing_m: FloatArray

    @property
    def direction(self) -> FloatArray:
        """Unit vector (2,) of the load; the first axis without load."""
        size = float(np.hypot(*self.force_n))
        return self.force_n / size if size > 0.0 else np.array([1.0, 0.0])

    @property
    def stiffness_n_per_m(self) -> FloatArray:
        """Return the stiffness (2, 2) along both axes."""
        (c, s), along, across = self.direction, self.along_n_per_m, self.across_n_per_m
        mixed = (along - across) * c * s
        return np.array([[along * c * c + across * s * s, mixed], [mixed, along * s * s + across * c * c]])

    def passing_lines_m(self, count: int, sense: float = 1.0) -> ComplexArray:
        """Return p (2, count), complex: along both axes it moves by Re Σ p_h exp(i h θ) as θ passes 2π with every ball.

        `sense`: below 0 for a cage that turns from the second axis to the first.
        """
        angles = len(self.passing_m)
        place = 2.0 * np.pi * (np.arange(angles) + 0.5) / angles
        waves = np.exp(-1j * np.outer(np.arange(1, count + 1), place))
        along, across = (2.0 / angles * (waves * way).sum(axis=1) for way in self.passing_m.T)
        if sense < 0.0:
            along, across = along.conj(), across.conj()
        c, s = self.direction
        return np.array([c * along - s * across, s * along + c * across])

    @property
    def half_zone_rad(self) -> float:
        """Half the angle over which balls bear load, of balls at any angle."""
        return self.bearing.half_zone_rad(self.moved_m)


def loaded_bearing(bearing: BallBearing, force_n: FloatArray, angles: int = ANGLES) -> LoadedBearing:
    """Return a bearing under the force (2,) of its shaft; without force only one with preload has a stiffness.

    Raises
    ------
    ValueError
        If the force is not finite, or balls do not settle under it.
    """
    size = float(np.hypot(*force_n))
    way = bearing.deflection_m(size)
    first = bearing.spacing_rad * (np.arange(angles) + 0.5) / angles
    balls = _Balls(bearing, first)
    if size == 0.0:
        still = np.zeros((angles, 2))
        along, _, across = balls.stiffness(still).mean(axis=0).tolist()
        return LoadedBearing(bearing, np.asarray(force_n), way, along, across, still)
    moved = _at_rest(balls, size, way)
    stiffness = balls.stiffness(moved).mean(axis=0)
    mean = float(moved[:, 0].mean())
    passing = moved - np.array([mean, 0.0])
    return LoadedBearing(bearing, np.asarray(force_n), mean, float(stiffness[0]), float(stiffness[2]), passing)


class _Balls:
    """All balls of a bearing with its cage at angles (k,), the load along the first axis."""

    def __init__(self, bearing: BallBearing, first_rad: FloatArray) -> None:
        angle = first_rad[:, None] + bearing.spacing_rad * np.arange(bearing.balls)
        share = 2.0 * bearing.reach_m / bearing.ball_diameter_m  # cos φ
        self.along, self.across = share * np.cos(angle), share * np.sin(angle)
        self.slack_m, self.k = 0.5 * bearing.clearance_m, bearing.contact_n_per_m15

    def squeezed(self, moved: FloatArray) -> FloatArray:
        """Return how far balls (k, n) are squeezed by a way (k, 2) of the shaft [m]."""
        return np.maximum(moved[:, :1] * self.along + moved[:, 1:] * self.across - self.slack_m, 0.0)

    def force(self, moved: FloatArray) -> FloatArray:
        """Return the force (k, 2) of all balls on the ring [N]."""
        s = self.squeezed(moved)
        load = self.k * s * np.sqrt(s)
        return np.stack([(load * self.along).sum(axis=1), (load * self.across).sum(axis=1)], axis=1)

    def stiffness(self, moved: FloatArray) -> FloatArray:
        """Return along, mixed and across (k, 3) [N/m]."""
        each = 1.5 * self.k * np.sqrt(self.squeezed(moved))
        rows = (self.along * self.along, self.along * self.across, self.across * self.across)
        return np.stack([(each * row).sum(axis=1) for row in rows], axis=1)


def _at_rest(balls: _Balls, force_n: float, way_m: float) -> FloatArray:
    """Return the way (k, 2) at which balls bear a force along the first axis: Newton, each step as long as it helps."""
    load = np.array([force_n, 0.0])
    moved = np.tile([way_m, 0.0], (len(balls.along), 1))
    ridge = RIDGE * 1.5 * balls.k * np.sqrt(max(way_m - balls.slack_m, 1e-3 * way_m))
    for _ in range(STEPS):
        left = load - balls.force(moved)
        a, b, c = balls.stiffness(moved).T
        a, c = a + ridge, c + ridge
        step = np.stack([c * left[:, 0] - b * left[:, 1], a * left[:, 1] - b * left[:, 0]], axis=1)
        step /= (a * c - b * b)[:, None]
        small = (np.abs(left) <= TOLERANCE * force_n).all(axis=1) | (np.abs(step) <= ROUNDING * way_m).all(axis=1)
        if small.all():
            return moved
        moved = _stepped(balls, load, moved, step)
    raise ValueError(f"bearing: balls do not settle under {force_n} N after {STEPS} steps")


def _stepped(balls: _Balls, load: FloatArray, moved: FloatArray, step: FloatArray) -> FloatArray:
    """Return the way after a step, halved at each angle (k,) until it ends not far beyond the least energy on it."""
    downhill, share = ((load - balls.force(moved)) * step).sum(axis=1), np.ones(len(moved))
    while True:
        found = moved + share[:, None] * step
        slope = ((load - balls.force(found)) * step).sum(axis=1)
        far = (slope < -OVERSHOOT * downhill) & (share > LEAST_STEP)
        if not far.any():
            return np.asarray(found)
        share = np.where(far, 0.5 * share, share)
