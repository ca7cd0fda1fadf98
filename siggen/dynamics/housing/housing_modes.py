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
from typing import Protocol

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.dynamics.housing.box import SIDES, Box, plane_axes
from siggen.dynamics.housing.box_energy import box_energy
from siggen.dynamics.housing.half_functions import HalfFunctions
from siggen.dynamics.housing.modes import NaturalModes
from siggen.dynamics.housing.motion import WallMotion
from siggen.dynamics.housing.ordered_sums import squares
from siggen.dynamics.housing.plate_energy import sheet
from siggen.dynamics.housing.shared_functions import Degrees
from siggen.dynamics.housing.stiff_pencil import LowestModes, lowest_modes, solve_lower

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
    resolved_hz : shapes follow the bending waves of the thinnest plate up to here
    """

    frequency_hz: FloatArray
    bolt_share: FloatArray
    halves: tuple[HalfFunctions, HalfFunctions]
    found: tuple[LowestModes, LowestModes]
    order: IntArray
    resolved_hz: float

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
    resolved = resolved_hz(box, waves)
    highest = BEYOND * resolved if highest_hz is None else highest_hz
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
        resolved_hz=resolved,
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
