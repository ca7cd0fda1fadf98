"""HousingModes: natural modes of a box on its bolts, shapes anywhere on it, residual flexibility, accelerance.

    A_oi = Σ_r φ_r(o) φ_r(i) (-ω²)/(ω_r² - ω² + 2 i ζ_r ω_r ω) - ω² R_oi,   R_oi = u_i(o) - Σ_r φ_r(o) φ_r(i)/ω_r²

(reference: standard literature, modal analysis). Every modal mass is 1 kg: all information is in the shapes. u_i is the
static displacement under a unit force, so R stands for all modes above the last one kept.

Design. Six plates, each a sum of products of polynomials whose degree follows the number of waves that fit into it
(p-version of the finite-element method): 310 to 350 coordinates for either half of the modes. They are solved anew for
every box; nothing is looked up, scaled or interpolated. `resolved_hz` says up to where shapes follow the waves of the
thinnest plate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sqrt
from typing import NamedTuple, Protocol

import numpy as np

from siggen.arrays import ComplexArray, FloatArray, IntArray
from siggen.compiled import entry
from siggen.drivetrain.box import SIDES, Axis, Bolt, Box, Seat, plane_axes
from siggen.drivetrain.box_energy import bolt_rows, box_energy, sheet
from siggen.drivetrain.box_functions import Degrees, HalfFunctions
from siggen.drivetrain.stiff_pencil import LowestModes, lowest_modes, solve_lower, squares

# modal_sum: accelerances as sums over modes, in one order, so that they have the same bits on any processor.
#
# A block of frequencies at a time: what a mode does there is computed once for all rows and stays in the cache.

BLOCK = 512


@entry(cache=True, error_model="numpy")
def modal_sum(
    residues: FloatArray, natural: FloatArray, damping_ratio: FloatArray, residual: FloatArray, omega: FloatArray
) -> ComplexArray:
    """Return Σ_r R_r (-ω²)/(ω_r² - ω² + 2 i ζ_r ω_r ω) - ω² R_oi (rows, k).

    Parameters
    ----------
    residues : (rows, modes) φ_r(o) φ_r(i)
    natural, damping_ratio : (modes,) ω_r [rad/s] and ζ_r
    residual : (rows,) R_oi [m/N]
    omega : (k,) ω [rad/s]
    """
    rows, count = residues.shape[0], omega.size
    total = np.empty((rows, count), dtype=np.complex128)
    real, imaginary = np.empty(BLOCK), np.empty(BLOCK)
    sums = np.empty((2, rows, BLOCK))
    for start in range(0, count, BLOCK):
        w = omega[start : start + BLOCK]
        sums[:] = 0.0
        for r in range(natural.size):
            square, double = natural[r] * natural[r], 2.0 * damping_ratio[r] * natural[r]
            for i in range(w.size):
                stiff, damped = square - w[i] * w[i], double * w[i]
                share = -w[i] * w[i] / (stiff * stiff + damped * damped)
                real[i], imaginary[i] = share * stiff, -share * damped
            for row in range(rows):
                residue = residues[row, r]
                for i in range(w.size):
                    sums[0, row, i] += residue * real[i]
                    sums[1, row, i] += residue * imaginary[i]
        for row in range(rows):
            for i in range(w.size):
                total[row, start + i] = complex(sums[0, row, i] - w[i] * w[i] * residual[row], sums[1, row, i])
    return total


# Motion: what a sensor, a bearing or a bolt sees of a housing; forces act on it by the same numbers.
#
# A motion is a row of numbers for either half of the modes. The displacement is row · coordinates, the load of a unit
# force the row itself, so forces and motions are reciprocal and the sum of works is right.

RIM_POINTS = 16
"""Points around a bore; their means are exact for all that varies less than 16 times around it."""


class WallMotion(NamedTuple):
    """Rows (coordinates,) of both halves: walls that move alike, and against each other."""

    even: FloatArray
    odd: FloatArray

    def plus(self, other: WallMotion, factor: float = 1.0) -> WallMotion:
        """Return this motion and a multiple of another together: a pair of forces, a relative motion."""
        return WallMotion(self.even + factor * other.even, self.odd + factor * other.odd)


@dataclass(frozen=True, slots=True)
class PlatePlace:
    """A place on a plate, at distances [m] along its two axes in order, and the direction of motion."""

    plate: str
    first_m: float
    second_m: float
    direction: Axis


def motion_at(halves: tuple[HalfFunctions, HalfFunctions], place: PlatePlace) -> WallMotion:
    """Return the motion of a place of the middle surface.

    Raises
    ------
    ValueError
        If the place lies beyond the plate's edges.
    """
    axes = plane_axes(SIDES[place.plate][0])
    at = (place.first_m, place.second_m)
    size = tuple(halves[0].size_m[axis] for axis in axes)
    if not all(0.0 <= distance <= length for distance, length in zip(at, size, strict=True)):
        raise ValueError(f"{place.plate}: received a place at {at} m; allowed: 0 to {size} m")
    even, odd = (_at(half, place)[0] for half in halves)
    return WallMotion(even, odd)


def seat_motions(halves: tuple[HalfFunctions, HalfFunctions], seat: Seat, wall: str) -> dict[str, WallMotion]:
    """Return the motions of a bearing in its seat in the front or back wall: x, y, z and the slopes along x and y.

    The rim of the bore moves the bearing as its mean. Radial motion is that of the bearing's middle, which overhangs:
    its force has a moment about the wall. The force of a slope is a moment: `slope_x` turns about y.
    """
    found = [_seat_rows(half, seat, wall) for half in halves]
    return {name: WallMotion(found[0][name], found[1][name]) for name in found[0]}


def bolt_motions(halves: tuple[HalfFunctions, HalfFunctions], bolt: Bolt) -> dict[str, WallMotion]:
    """Return the motions along x, y, z of the floor at a bolt (front half) and at its mirror image."""
    even, odd = (bolt_rows(bolt, half) for half in halves)
    found = {}
    for axis in Axis:
        mirrored = [half.mirror_sign(axis) for half in halves]
        found[f"front/{axis.name.lower()}"] = WallMotion(even[axis], odd[axis])
        found[f"back/{axis.name.lower()}"] = WallMotion(mirrored[0] * even[axis], mirrored[1] * odd[axis])
    return found


def _at(half: HalfFunctions, place: PlatePlace) -> FloatArray:
    plate, sign = place.plate, 1.0
    if plate == "back":
        plate, sign = "front", half.mirror_sign(place.direction)
    tables = half.tables(plate, (np.array([place.first_m]), np.array([place.second_m])))
    return sign * half.rows(tables, place.direction)


def _seat_rows(half: HalfFunctions, seat: Seat, wall: str) -> dict[str, FloatArray]:
    angle = 2.0 * np.pi * (np.arange(RIM_POINTS) + 0.5) / RIM_POINTS
    cosine, sine, radius = np.cos(angle), np.sin(angle), seat.bore_radius_m
    places = seat.x_m + radius * cosine, seat.y_m + radius * sine
    tables = half.tables("front", places)
    signs = [half.mirror_sign(axis) if wall == "back" else 1.0 for axis in Axis]
    x, y, z = (sign * half.rows(tables, axis) for axis, sign in zip(Axis, signs, strict=True))
    # Plane through the rim by least squares: mean of w cos over that of cos², 1/2.
    slopes = [2.0 / radius * (share[:, None] * z).mean(axis=0) for share in (cosine, sine)]
    outwards = seat.overhang_m if wall == "back" else -seat.overhang_m
    return {
        "x": x.mean(axis=0) - outwards * slopes[0],
        "y": y.mean(axis=0) - outwards * slopes[1],
        "z": z.mean(axis=0),
        "slope_x": slopes[0],
        "slope_y": slopes[1],
    }


# Modes: what carries bearings and sensors as natural modes of modal mass 1, wherever they come from.
#
#     A_oi = Σ_r φ_r(o) φ_r(i) (-ω²)/(ω_r² - ω² + 2 i ζ_r ω_r ω) - ω² R_oi
#
# (reference: standard literature, modal analysis). All information is in the shapes; R stands for the modes above the
# last one. Forces and motions share their numbers, so reciprocity is exact.

ALL = slice(None)
VIBRATING_HZ = 1e6
"""What lies above in a table is a residual vector: it only gives way."""


class NaturalModes(Protocol):
    """Natural modes in ascending order; `frequency_hz` (m,). To be derived from."""

    frequency_hz: FloatArray

    @property
    def vibrating(self) -> int:
        """How many of them may move with the gears."""

    def shapes(self, motions: Sequence[WallMotion]) -> FloatArray:
        """Return the shapes (motions, m) [kg^-1/2] of all modes, as displacements; slopes per metre."""

    def flexibility_beyond(self, modes: int, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what all modes above the first so many give way, (outputs, inputs) [m/N]."""

    def residual_flexibility(self, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what all modes above the last one give way, (outputs, inputs) [m/N]."""
        return self.flexibility_beyond(self.frequency_hz.size, outputs, inputs)

    def accelerance(
        self,
        outputs: Sequence[WallMotion],
        inputs: Sequence[WallMotion],
        frequency_hz: FloatArray,
        damping_ratio: FloatArray,
        which: slice = ALL,
    ) -> ComplexArray:
        """Return accelerances (outputs, inputs, k) [m/s² per N] at frequencies (k,) with damping ratios (m,).

        Of all modes, or of some; where these go up to the last one, with what stands for those above.
        """
        at_outputs, at_inputs = self.shapes(outputs)[:, which], self.shapes(inputs)[:, which]
        residues = (at_outputs[:, None, :] * at_inputs[None, :, :]).reshape(
            len(outputs) * len(inputs), -1 if at_outputs.size else 0
        )
        residual = np.zeros(len(residues))
        if which.stop is None:
            residual = self.residual_flexibility(outputs, inputs).reshape(-1)
        total = modal_sum(
            np.ascontiguousarray(residues),
            2.0 * pi * self.frequency_hz[which],
            damping_ratio[which],
            residual,
            2.0 * pi * frequency_hz,
        )
        return np.asarray(total.reshape(len(outputs), len(inputs), frequency_hz.size))


@dataclass(frozen=True, slots=True)
class TableModes(NaturalModes):
    """Modes from a table: the shapes at a place are its motion, all of them in the first half; nothing lies above."""

    frequency_hz: FloatArray

    @property
    def vibrating(self) -> int:
        """How many of them may move with the gears: residual vectors do not."""
        return int((self.frequency_hz < VIBRATING_HZ).sum())

    def shapes(self, motions: Sequence[WallMotion]) -> FloatArray:
        """Return the shapes (motions, m) [kg^-1/2]."""
        return np.array([motion.even for motion in motions]).reshape(len(motions), -1)

    def flexibility_beyond(self, modes: int, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what the modes above the first so many give way, (outputs, inputs) [m/N]."""
        left, right = (np.ascontiguousarray(self.shapes(side).T[modes:]) for side in (outputs, inputs))
        omega = 2.0 * pi * self.frequency_hz[modes:, None]
        return squares(left / (omega * omega), right)


def table_motion(shape: FloatArray) -> WallMotion:
    """Return the motion of a place by its shapes (m,)."""
    return WallMotion(shape, np.empty(0))


WAVES = 8.5
"""Bubbles along a length over its share of the root of three neighbouring plates' area."""
FINER = 6
"""More bubbles on the walls with bearings: bosses are far stiffer than the wall around them."""
IN_PLANE = 1
"""Bubbles of motion in the plane, polynomials of degree 4."""
LEAST_BUBBLES = 4
REACH = 2.0
"""95 % of third octaves hold within 6 dB up to so many times `resolved_hz` (drawn boxes, November 2026)."""
BEYOND = 3.0
"""Modes are kept up to so many times the resolved frequency: they serve as a statistical tail."""


class BoxModes(NaturalModes, Protocol):
    """Modes of a box in ascending order. To be derived from.

    Attributes
    ----------
    frequency_hz, bolt_share : (m,) natural frequencies, and the share of the strain energy that bolts hold
    halves : functions of both halves, for `motion_at` and its like
    """

    bolt_share: FloatArray
    halves: tuple[HalfFunctions, HalfFunctions]

    @property
    def vibrating(self) -> int:
        """How many of them may move with the gears: all."""
        return self.frequency_hz.size

    def static_flexibility(self, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return static displacements (outputs, inputs) under unit forces, bolts included [m/N]."""

    def flexibility_beyond(self, modes: int, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return what all modes above the first so many give way, (outputs, inputs) [m/N]."""
        left, right = (np.ascontiguousarray(self.shapes(side).T[:modes]) for side in (outputs, inputs))
        omega = 2.0 * pi * self.frequency_hz[:modes, None]
        return self.static_flexibility(outputs, inputs) - squares(left / (omega * omega), right)


@dataclass(frozen=True, slots=True)
class HousingModes(BoxModes):
    """Modes of a symmetric box.

    Attributes
    ----------
    found : modes of both halves
    order : (m,) number of each mode among those of the first half (walls alike), then of the second (oppositely)
    """

    frequency_hz: FloatArray
    bolt_share: FloatArray
    halves: tuple[HalfFunctions, HalfFunctions]
    found: tuple[LowestModes, LowestModes]
    order: IntArray

    def shapes(self, motions: Sequence[WallMotion]) -> FloatArray:
        """Return the shapes (motions, m) [kg^-1/2] of all modes, as displacements; slopes per metre."""
        both = [squares(columns(motions, h), self.found[h].shapes) for h in (0, 1)]
        return np.concatenate(both, axis=1)[:, self.order]

    def static_flexibility(self, outputs: Sequence[WallMotion], inputs: Sequence[WallMotion]) -> FloatArray:
        """Return static displacements (outputs, inputs) under unit forces, bolts included [m/N]."""
        total = np.zeros((len(outputs), len(inputs)))
        for h in (0, 1):
            root = self.found[h].root
            total += squares(*(solve_lower(root, columns(side, h)) for side in (outputs, inputs)))
        return total


def columns(motions: Sequence[WallMotion], half: int) -> FloatArray:
    """Return the rows of motions in one half side by side, (coordinates, motions)."""
    return np.ascontiguousarray(np.array([motion[half] for motion in motions]).T)


def mixed_damping(modes: BoxModes, of_walls: FloatArray | float, of_bolts: float) -> FloatArray:
    """Return damping ratios (m,): walls' and bolts' weighted with their shares of the strain energy.

    Source: modal strain energy (reference: standard literature).
    """
    return np.asarray(of_walls + (of_bolts - of_walls) * modes.bolt_share, dtype=np.float64)


def housing_modes(box: Box, highest_hz: float | None = None, waves: float | None = None) -> HousingModes:
    """Return the modes of a box below `highest_hz` (None: three times the resolved frequency), at least six.

    More `waves` resolve higher frequencies, in proportion to their square; the cost grows with their fifth power. None
    takes as many as `highest_hz` needs, within limits.

    Raises
    ------
    ValueError
        If the bolts leave the box free to move.
    """
    waves = waves_for(box, highest_hz) if waves is None else waves
    highest = BEYOND * resolved_hz(box, waves) if highest_hz is None else highest_hz
    halves = tuple(HalfFunctions(box.size_m, degrees(box, waves), odd) for odd in (False, True))
    found, shares = [], []
    for half in halves:
        energies, bolts = box_energy(box, half)
        modes = lowest_modes(energies.stiffness, energies.mass, 2.0 * pi * highest)
        found.append(modes)
        shares.append((modes.shapes * squares(bolts, modes.shapes)).sum(axis=0) / modes.omega_squared)
    omega_squared = np.concatenate([modes.omega_squared for modes in found])
    order = np.argsort(omega_squared, kind="stable")
    return HousingModes(
        frequency_hz=np.sqrt(omega_squared[order]) / (2.0 * pi),
        bolt_share=np.concatenate(shares)[order],
        halves=(halves[0], halves[1]),
        found=(found[0], found[1]),
        order=order,
    )


def waves_for(box: Box, highest_hz: float | None) -> float:
    """Return how many waves resolve a frequency [Hz]; at least `WAVES`, at most twice as many."""
    if highest_hz is None:
        return WAVES
    return WAVES * min(max(1.0, sqrt(highest_hz / (REACH * resolved_hz(box)))), 2.0)


def degrees(box: Box, waves: float = WAVES) -> Degrees:
    """Return the numbers of bubbles along x, y, z: even waves on all plates, for about the same number in all."""
    per_metre = waves / sqrt(_area_m2(box))
    bubbles = tuple(max(LEAST_BUBBLES, round(per_metre * length)) for length in box.size_m)
    return Degrees((bubbles[0] + FINER, bubbles[1] + FINER, bubbles[2]), (bubbles[0], bubbles[1], bubbles[2]), IN_PLANE)


def resolved_hz(box: Box, waves: float = WAVES) -> float:
    """Return the frequency [Hz] whose bending wave on the thinnest plate has one bubble for every half wave."""
    thinnest = min(box.thickness.of(plate) for plate in SIDES)
    own = sheet(box.material, thinnest)
    wave_number = pi * waves / sqrt(_area_m2(box))
    return wave_number**2 * sqrt(own.bending / own.mass) / (2.0 * pi)


def _area_m2(box: Box) -> float:
    """Return the area of three plates that meet at a corner."""
    return 0.5 * sum(box.size_m[a] * box.size_m[b] for a, b in (plane_axes(normal) for normal, _ in SIDES.values()))
