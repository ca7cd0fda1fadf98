"""SpecimenHousing: the housing of one specimen by its modes, and where it is pressed and seen.

x runs from gear to pinion and is horizontal, y is vertical, z runs along the shafts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.dynamics.housing.box import Box
from siggen.dynamics.housing.modes import ALL, NaturalModes
from siggen.dynamics.housing.motion import WallMotion
from siggen.dynamics.structure.drivetrain import Modes
from siggen.dynamics.structure.gear_stage import Point
from siggen.dynamics.structure.makers import Housing, housing_of_modes

MODES_ON_BOLTS = 6
COUPLED_HZ, MOST = 1500.0, 9
"""Modes below this frequency move with the gears, at least the six on the bolts. With what all others give way in
series with the bearings k_b |R - R_0| stays below 0.5 nearly everywhere (drawn boxes, November 2026)."""
SETTLED_DECAYS = 7.0
"""Decay times after which a mode has forgotten how it was started: 1e-3 of it is left."""
LONGEST_S = 1.2
BoltMotions = tuple[tuple[Point, str, float, WallMotion], ...]
"""Place from the middle between both shafts, axis, stiffness [N/m] and motion of what a base takes along."""


@dataclass(frozen=True, slots=True)
class SpecimenHousing:
    """A housing with its modes.

    Attributes
    ----------
    damping_ratio : (m,)
    seats, motions, entries : place/axis -> motion of bearings, of sensors, and of where other forces press
    bolts : returns what a base under the housing moves
    box : what the modes were computed from; None where they were given
    """

    modes: NaturalModes
    damping_ratio: FloatArray
    seats: Mapping[str, WallMotion]
    motions: Mapping[str, WallMotion]
    entries: Mapping[str, WallMotion]
    bolts: Callable[[], BoltMotions]
    box: Box | None = None

    @property
    def coupled(self) -> int:
        """Number of modes that move with the gears."""
        least = min(MODES_ON_BOLTS, self.modes.vibrating)
        return min(max(least, int((self.modes.frequency_hz < COUPLED_HZ).sum())), MOST)

    @property
    def forces(self) -> tuple[str, ...]:
        """Bearing forces that press on it, as place/axis."""
        return tuple(self.seats)

    @property
    def pairs(self) -> list[tuple[float, float]]:
        """Natural frequencies [Hz] and damping ratios, ascending."""
        return list(zip(self.modes.frequency_hz.tolist(), self.damping_ratio.tolist(), strict=True))

    def accelerance(
        self, seen: WallMotion, inputs: tuple[str, ...], frequency_hz: FloatArray, which: slice = ALL
    ) -> ComplexArray:
        """Return the accelerance (inputs, k) [m/s² per N] from seats, entries or motions, of some of the modes."""
        places = {**self.motions, **self.seats, **self.entries}
        motions = [places[name] for name in inputs]
        return np.asarray(self.modes.accelerance([seen], motions, frequency_hz, self.damping_ratio, which)[0])

    def shown_accelerance(
        self, weights: Mapping[str, float], inputs: tuple[str, ...], frequency_hz: FloatArray, which: slice = ALL
    ) -> ComplexArray:
        """Return the accelerance (inputs, k) of what a channel sees: motions times factors."""
        (name, weight), *others = weights.items()
        total = WallMotion(weight * self.motions[name].even, weight * self.motions[name].odd)
        for name, weight in others:
            total = total.plus(self.motions[name], weight)
        return self.accelerance(total, inputs, frequency_hz, which)


def modes_settle_s(frequency_hz: FloatArray, damping_ratio: FloatArray) -> float:
    """Return the time over which modes settle [s]."""
    return settle_s(float((2.0 * pi * frequency_hz * damping_ratio).min()))


def settle_s(slowest_per_s: float) -> float:
    """Return the time over which what decays at a rate settles [s]."""
    return min(SETTLED_DECAYS / slowest_per_s, LONGEST_S) if slowest_per_s > 0.0 else LONGEST_S


def moving_with_gears(housing: SpecimenHousing) -> Housing:
    """Return the lowest modes of a housing, those that move with the gears."""
    modes, n = housing.modes, housing.coupled
    seats = list(housing.seats.values())
    places = {**housing.seats, **housing.motions, **housing.entries}
    shapes = modes.shapes(list(places.values()))[:, :n]
    lowest = Modes(
        name="housing",
        frequency_hz=modes.frequency_hz[:n],
        damping_ratio=housing.damping_ratio[:n],
        shapes=dict(zip(places, shapes, strict=True)),
        seats=tuple(housing.seats),
        give_m_per_n=modes.flexibility_beyond(n, seats, seats),
        base=participation(housing)[:n],
    )
    return housing_of_modes(lowest, tuple(housing.motions), tuple(housing.entries))


def participation(housing: SpecimenHousing) -> FloatArray:
    """Return how far each mode moves (m, 3) at rest with a base: horizontally, vertically, rocking about the middle.

    Derived: g_r = φ_rᵀ K_b t/ω_r², t the base's motion at the bolts. A mode's spring acts between η_r and g_r, so that
    a base that moves slowly takes the whole box along.
    """
    bolts, omega = housing.bolts(), 2.0 * pi * housing.modes.frequency_hz
    taken = np.zeros((omega.size, 3))
    shapes = housing.modes.shapes([motion for *_, motion in bolts]) if bolts else ()
    for ((h, v), axis, stiffness, _), shape in zip(bolts, shapes, strict=True):
        moved = (1.0, 0.0, -v) if axis == "horizontal" else (0.0, 1.0, h)
        taken += np.outer(stiffness * shape / (omega * omega), moved)
    return taken


def second_stage(seats: Mapping[str, WallMotion], bearings: Sequence[str], pressure_angle_rad: float) -> WallMotion:
    """Return where a second mesh presses: opposed forces on the seats of both shafts.

    They lie along the line of action of the mesh that is simulated, which stands for its own. `bearings` are those of
    its driver and its driven gear.
    """
    driver, driven = (
        WallMotion(0.0 * seats[f"{bearing}/vertical"].even, 0.0 * seats[f"{bearing}/vertical"].odd)
        .plus(seats[f"{bearing}/vertical"], cos(pressure_angle_rad))
        .plus(seats[f"{bearing}/horizontal"], sin(pressure_angle_rad))
        for bearing in bearings
    )
    return driver.plus(driven, -1.0)
