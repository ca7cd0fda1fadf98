"""Crack in the root of a tooth, on the loaded side: it softens the tooth and shows on no flank.

It leaves the chord of the root (`root_chord`) at an angle to the tooth's centre line and runs straight into the body.
Its depth across the face is the same everywhere, or falls from one end, q = q_0 √(1 - w/w_0) (Chen and Shao 2011,
memory). Where the contact is solved across the face, each slice has the crack of its own depth, and the load moves to
the other end (`siggen.gears.contact.uneven_teeth`). Elsewhere slices stand in parallel: k = (1/b) ∫ k(q(w)) dw.
Under load it is open; the other flank closes it, and then the tooth is as it was.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import cos, degrees, inf, pi, sqrt
from typing import TypeAlias

import numpy as np

from siggen.arrays import FloatArray
from siggen.errors import mm
from siggen.gears.damage.crack_law import ANGLE_RANGE_RAD, DEEPEST_SHARE, unit_compliance
from siggen.gears.damage.part import Part, Refusal
from siggen.gears.damage.sham import Sham
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.root_chord import root_chord
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.names import Side

SLACK = 1e-9
"""Of a share or an angle that was divided and multiplied again."""
Rule: TypeAlias = tuple[FloatArray, FloatArray]
WHOLE: Rule = np.polynomial.legendre.leggauss(16)
"""Over the root of the rest of the run, in which compliances are smooth: exact to 1e-9 (tested against fine sums)."""
SLICE: Rule = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True, slots=True)
class RootCrack:
    """A crack in the root.

    Attributes
    ----------
    gear : Side
        Its gear.
    tooth : int
        Index, from 0.
    depth_m : float
        Largest length along the crack, at the end of the face where it began [m].
    angle_rad : float
        Between the crack and the tooth's centre line.
    run_m : float
        Place across the face at which its depth falls to 0, also beyond the other end; infinite: the same depth
        everywhere [m].
    """

    gear: Side
    tooth: int
    depth_m: float
    angle_rad: float
    run_m: float = inf
    kind: str = "crack"
    outline: None = None

    def rows(self) -> list[tuple[float, ...]]:
        """Return none: contact and sections keep their material."""
        return []

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> FloatArray:
        """Return what it adds to the compliance of its tooth under load (k,) [m/N]."""
        per_unit = pair.youngs_modulus_pa * pair.face_width_m
        gear = pair.member(self.gear)
        share = self.depth_m / root_chord(gear).length_m
        if not self.is_uneven:
            return unit_compliance(gear, roll_rad, share, self.angle_rad) / per_unit
        return self._between(pair, roll_rad, sound_m_per_n, (0.0, pair.face_width_m), WHOLE)

    @property
    def is_uneven(self) -> bool:
        """Whether its depth is not the same everywhere."""
        return self.run_m < inf

    def slice_compliance_m_per_n(
        self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray, slices: int
    ) -> FloatArray:
        """Return what it adds to a tooth that were everywhere as in a slice of the face, (k, n) [m/N]."""
        edges = np.linspace(0.0, pair.face_width_m, slices + 1)
        return np.stack([self._between(pair, roll_rad, sound_m_per_n, e, SLICE) for e in pairwise(edges)], axis=1)

    def _between(
        self, pair: GearPair, roll: FloatArray, sound: FloatArray, edges: tuple[float, float], rule: Rule
    ) -> FloatArray:
        """Return what it adds to a tooth that were as between two places across the face (k,): slices in parallel."""
        low, high = (min(edge / self.run_m, 1.0) for edge in edges)
        if low == high:
            return np.zeros(roll.shape)
        gear, per_unit = pair.member(self.gear), pair.youngs_modulus_pa * pair.face_width_m
        first, last = sqrt(1.0 - high), sqrt(1.0 - low)
        softer = np.zeros(roll.shape)
        for node, weight in zip(0.5 * (last + first) + 0.5 * (last - first) * rule[0], rule[1], strict=True):
            share = self.depth_m / root_chord(gear).length_m * node
            added = unit_compliance(gear, roll, share, self.angle_rad) / per_unit
            softer += weight * (last - first) * node * added / (sound + added)
        softer *= self.run_m / (edges[1] - edges[0])
        return np.asarray(sound * softer / (1.0 - softer))

    def profile_arc_m(self, gear: SpurGear) -> float:  # noqa: ARG002
        """Return 0: it shows on no flank."""
        return 0.0

    def hides(self, other: Part) -> bool:
        """Return whether a milder one on the same tooth is nowhere deeper; q² is straight across the face."""
        if not isinstance(other, RootCrack) or (other.gear, other.tooth) != (self.gear, self.tooth):
            return False
        return self.depth_m >= other.depth_m and self.run_m >= other.run_m

    def sham(self) -> Sham:
        """Return a sham in its place."""
        return Sham(self)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield an impossible depth, angle or run."""
        if not 0.0 < self.depth_m < inf:
            yield Refusal("depth_m", f"depth {mm(self.depth_m)}", "above 0")
        low, high = ANGLE_RANGE_RAD
        if not low - SLACK <= self.angle_rad <= high + SLACK:
            allowed = f"{degrees(low):g} to {degrees(high):g} degrees to the tooth's centre line"
            yield Refusal("angle_rad", f"{degrees(self.angle_rad):.6g} degrees", allowed)
        if not self.run_m > 0.0:
            yield Refusal("run_m", f"run {mm(self.run_m)}", "above 0")

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        """Yield a tooth that there is not, a root without the chord, a crack too deep for it or into the bore."""
        gear = pair.member(self.gear)
        if not 0 <= self.tooth < gear.teeth:
            yield Refusal("tooth", f"tooth {self.tooth!r}", f"0 to {gear.teeth - 1}")
        try:
            chord = root_chord(gear)
        except ValueError as error:
            yield Refusal("gear", str(error), "a gear whose root has one")
            return
        deepest = DEEPEST_SHARE * chord.length_m
        if self.depth_m > deepest * (1.0 + SLACK):
            allowed = f"at most {mm(deepest)}, {DEEPEST_SHARE:g} of the chord of the root {mm(chord.length_m)}"
            yield Refusal("depth_m", f"depth {mm(self.depth_m)}", allowed)
        elif chord.height_m - self.depth_m * cos(self.angle_rad) < gear.bore_radius_m:
            allowed = f"a crack that ends above the bore of {mm(gear.bore_radius_m)}"
            yield Refusal("depth_m", f"depth {mm(self.depth_m)}", allowed)

    def table_row(self) -> dict[str, object]:
        """Return depth, angle and run."""
        return {
            "gear": self.gear, "tooth": self.tooth, "kind": self.kind, "shape": "none",
            "depth_mm": 1e3 * self.depth_m, "crack_angle_deg": 180.0 / pi * self.angle_rad,
            "crack_run_mm": 0.0 if self.run_m == inf else 1e3 * self.run_m,
        }  # fmt: skip
