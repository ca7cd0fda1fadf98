"""Excitation: what acts on a structure besides the constant torque, as inputs along constant vectors (derived)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.drive import Rotation, Turning
from siggen.drivetrain.drivetrain import PLANE, Place
from siggen.drivetrain.structure import Structure
from siggen.uniform_spline import UniformSpline


class InputSource(Protocol):
    """One cause of inputs; to be derived from."""

    @property
    def vectors(self) -> FloatArray:
        """Generalised forces (m, n) per unit of the source's inputs."""

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the inputs (k, m) at k times."""

    @property
    def sharp_turn_rad(self) -> float:
        """Turn of the pinion over which inputs show all that they change within few steps of integration; 0: nothing.

        No coarser grid can stand for such inputs.
        """
        return 0.0

    @property
    def seat_forces(self) -> Mapping[str, FloatArray]:
        """Place/axis -> force (m,) on a seat per unit of the inputs, beside what its spring and damper bear."""
        return {}


@dataclass(frozen=True, slots=True)
class Excitation:
    """Sources that act together; their inputs stand side by side in this order."""

    sources: tuple[InputSource, ...]

    @property
    def sharp_turn_rad(self) -> float:
        """The largest of all sources."""
        return max(source.sharp_turn_rad for source in self.sources)

    @property
    def vectors(self) -> FloatArray:
        """Generalised forces (m, n) per unit of the inputs, as motions take them."""
        return np.concatenate([source.vectors for source in self.sources])

    def inputs(self, time_s: FloatArray, drive: Rotation) -> FloatArray:
        """Return the inputs (k, m) at the times (k,) [s]."""
        turning = drive.turning(time_s)
        return np.ascontiguousarray(np.concatenate([source.inputs(turning) for source in self.sources], axis=1))

    def seat_force_rows(self, places: Sequence[str]) -> FloatArray:
        """Return the forces (places, m) on seats per unit of the inputs, beside what springs and dampers bear."""
        parts = [_rows(source, places) for source in self.sources]
        return np.concatenate(parts, axis=1)


@dataclass(frozen=True, slots=True)
class SpeedDeviation(InputSource):
    """Ω/Ω_0 - 1, which pushes nothing, but by which tooth pairs slide faster or slower."""

    coordinates: Sequence[str]
    nominal_rad_s: float

    @property
    def vectors(self) -> FloatArray:
        """Zeros (1, n)."""
        return np.zeros((1, len(self.coordinates)))

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the deviation (k, 1)."""
        return (turning.speed_rad_s / self.nominal_rad_s - 1.0)[:, None]


def _rows(source: InputSource, places: Sequence[str]) -> FloatArray:
    none, found = np.zeros(source.vectors.shape[0]), source.seat_forces
    return np.array([found.get(place, none) for place in places]).reshape(len(places), none.size)


# SampledExcitation: inputs on a grid as coarse as they allow, with cubic splines in between (derived).
#
# Shaft forces, bearing tones and slow variations move far slower than a step of integration. The grid is doubled until
# the spline, half an interval from its knots, errs by less than a millionth of the largest value of its input.

COARSEST_HZ = 2000.0
LARGEST_ERROR = 1e-6
CHECKED = 64
"""Midpoints, spread over the whole time, at which the error is measured."""
MARGIN = 4
"""Knots beyond either end, where a spline knows less; even, so that a finer grid begins on a knot of the coarser."""


class SampledExcitation:
    """Inputs of an excitation from `first_s` to `last_s`; at `finest_hz` and above it asks the excitation itself.

    So it does where a source is sharp: between the knots of a coarse grid a pulse could pass unseen.

    With `window_s` a spline covers that much from the first time asked for, and the next one follows when it is passed:
    memory does not grow with the duration.
    """

    def __init__(
        self,
        excitation: Excitation,
        drive: Rotation,
        first_s: float,
        last_s: float,
        finest_hz: float,
        window_s: float | None = None,
    ) -> None:
        self._excitation, self._drive = excitation, drive
        self._last_s, self._finest_hz, self._window_s = last_s, finest_hz, window_s
        self._rate_hz, self._until_s = COARSEST_HZ, -np.inf
        self._spline: UniformSpline | None = None
        if window_s is None:
            self._cover(first_s, last_s)

    def inputs(self, time_s: FloatArray, drive: Rotation) -> FloatArray:
        """Return the inputs (k, m) at the times (k,) [s], which ascend, from one call to the next too."""
        if self._window_s is not None and time_s[-1] > self._until_s:
            self._cover(time_s[0], min(max(time_s[0] + self._window_s, time_s[-1]), self._last_s))
        if self._spline is None:
            return self._excitation.inputs(time_s, drive)
        return self._spline(time_s)

    def seat_force_rows(self, places: Sequence[str]) -> FloatArray:
        """Return the forces (places, m) on seats per unit of the inputs, as `Excitation`."""
        return self._excitation.seat_force_rows(places)

    def _cover(self, first_s: float, last_s: float) -> None:
        """Make the spline of a span, no coarser than the one before; none if its grid were finer than the steps."""
        self._spline, self._until_s = None, last_s
        coarser: FloatArray | None = None
        while self._rate_hz < self._finest_hz and self._excitation.sharp_turn_rad == 0.0:
            knots = _knots(first_s, last_s, self._rate_hz)
            values = self._values(knots, coarser)
            spline = UniformSpline(knots[0], 1.0 / self._rate_hz, values)
            if self._is_close(spline, knots):
                self._spline = spline
                return
            self._rate_hz *= 2.0
            coarser = values

    def _values(self, knots: FloatArray, coarser: FloatArray | None) -> FloatArray:
        """Return the inputs (k, m) at knots, every other one of which may be known from a grid of half the rate."""
        if coarser is None:
            return self._excitation.inputs(knots, self._drive)
        fresh = self._excitation.inputs(knots[1::2], self._drive)
        values = np.empty((knots.size, fresh.shape[1]))
        values[1::2] = fresh
        values[::2] = coarser[MARGIN // 2 :][: values[::2].shape[0]]
        return values

    def _is_close(self, spline: UniformSpline, knots: FloatArray) -> bool:
        """Return whether the spline errs little half an interval from knots."""
        chosen = np.linspace(MARGIN, knots.size - MARGIN - 2, CHECKED).astype(np.int64)
        middle = 0.5 * (knots[chosen] + knots[chosen + 1])
        wanted = self._excitation.inputs(middle, self._drive)
        return bool((np.abs(spline(middle) - wanted) <= LARGEST_ERROR * np.abs(wanted).max(axis=0)).all())


def _knots(first_s: float, last_s: float, rate_hz: float) -> FloatArray:
    """Return the knots of a grid; those with even numbers are knots at half the rate, to the last bit."""
    numbers = np.arange(-MARGIN, np.ceil((last_s - first_s) * rate_hz) + MARGIN + 1)
    return np.asarray(first_s + numbers / rate_hz)


# External forces on any body that come with the rotation: unbalance.
#
# Equations: centrifugal and tangential inertia of an eccentric mass, -m d²/dt² [e (cos Θ, sin Θ)] (derived). Angles
# are those of the pinion times an order, so the gear's shaft has the order z_1/z_2.


@dataclass(frozen=True, slots=True)
class Unbalance(InputSource):
    """An eccentric mass m e [kg m] on a shaft that turns at `order` times the pinion.

    `directions` (2, n) are unit forces along two axes at right angles; the shaft turns from the first to the second, or
    back if `order` is negative. At angle 0 the mass stands at `phase_rad` from the first.
    """

    directions: FloatArray
    moment_kg_m: float
    order: float
    phase_rad: float

    @property
    def vectors(self) -> FloatArray:
        """The directions (2, n)."""
        return self.directions

    def inputs(self, turning: Turning) -> FloatArray:
        """Return the forces (k, 2) [N]."""
        angle = self.order * turning.angle_rad + self.phase_rad
        outward = self.moment_kg_m * (self.order * turning.speed_rad_s) ** 2
        backward = self.moment_kg_m * self.order * turning.acceleration_rad_s2
        cosine, sine = np.cos(angle), np.sin(angle)
        return np.stack([outward * cosine + backward * sine, outward * sine - backward * cosine], axis=1)


def bearing_direction(structure: Structure, place: str, axis: str) -> FloatArray:
    """Return the generalised force (n,) of 1 N between a shaft and its seat: on the shaft along the axis, and back.

    Raises
    ------
    ValueError
        If the structure has no such bearing.
    """
    key = f"{place}/{axis}"
    if key not in structure.bearing_directions:
        allowed = ", ".join(structure.bearing_directions) or "none in a model of rotations alone"
        raise ValueError(f"bearing: received {key}; allowed are {allowed}")
    return structure.bearing_directions[key]


def shaft_directions(structure: Structure, place: str) -> FloatArray:
    """Return the generalised forces (2, n) of 1 N on the rotor at a bearing, horizontal and vertical."""
    return np.array([shaft_direction(structure, f"{place}/{axis}") for axis in PLANE])


def shaft_direction(structure: Structure, name: str) -> FloatArray:
    """Return the generalised force (n,) of 1 N on the rotor at a bearing along an axis, by place/axis."""
    place, axis = name.split("/")
    bearing_direction(structure, place, axis)
    gears = structure.drivetrain.held[place]
    rows = [structure.drivetrain.row(Place(gear), axis) for gear in gears]
    return np.asarray(np.add.reduce(rows) / len(gears))


def bearing_places(structure: Structure) -> tuple[str, ...]:
    """Return what the bearings of each shaft that turns are called, in the order of power; a planet's pin is none."""
    machine = structure.drivetrain
    return tuple(place for place, gears in machine.held.items() if machine.turning[gears[0]] != 0.0)


def gear_directions(structure: Structure, gear: str) -> FloatArray:
    """Return the generalised forces (2, n) of 1 N on one gear, horizontal and vertical."""
    return np.array([structure.drivetrain.row(Place(gear), axis) for axis in PLANE])


def shaft_mass(structure: Structure, place: str) -> tuple[float, FloatArray]:
    """Return the mass [kg] that moves with a shaft at a bearing, and 1 N (2, n) that acts on each gear by its share."""
    rows = [gear_directions(structure, gear) for gear in structure.drivetrain.held[place]]
    masses = [float(row[0] @ structure.mass @ row[0]) for row in rows]
    whole = sum(masses)
    return whole, np.add.reduce([mass / whole * row for mass, row in zip(masses, rows, strict=True)])


def turning_sense(structure: Structure, place: str) -> float:
    """Return 1 if the shaft at a bearing turns from horizontal to vertical, -1 if back."""
    machine = structure.drivetrain
    gear = machine.held[place][0]
    return float(np.sign(machine.rigid(gear).sense * machine.turning[gear]))
