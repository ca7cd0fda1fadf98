"""Crack in the root of a tooth, on the loaded side: it softens the tooth and shows on no flank.

It leaves the chord of the root (`root_chord`) at an angle to the tooth's centre line and runs straight into the body.
Its depth across the face is the same everywhere, or falls from one end, q = q_0 √(1 - w/w_0) (Chen and Shao 2011,
memory). Where the contact is solved across the face, each slice has the crack of its own depth, and the load moves to
the other end (`siggen.mesh.face_slices`). Elsewhere slices stand in parallel: k = (1/b) ∫ k(q(w)) dw.
Under load it is open; the other flank closes it, and then the tooth is as it was.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from math import cos, degrees, inf, pi, radians, sqrt
from typing import Annotated, ClassVar, Literal, TypeAlias

import numpy as np
import pyarrow as pa
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.damage.crack_law import ANGLE_RANGE_RAD, DEEPEST_SHARE, unit_compliance
from siggen.damage.fault import Fault
from siggen.damage.flank_place import DAMAGED_GEAR, AnyGear
from siggen.damage.growth import Growth
from siggen.damage.part import Part, Parts, Refusal
from siggen.damage.sham import Sham
from siggen.errors import Problem, mm
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear, root_chord
from siggen.keys.column import MILLIMETRE, Column
from siggen.keys.drawing import corners, draw
from siggen.keys.number import Number, Within, bounds, constant, number_text
from siggen.keys.teeth import DAMAGED_TEETH, Teeth, TeethValue
from siggen.keys.usual import Usual
from siggen.names import PINION, Side

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


# Cracks in the roots of teeth: one on each damaged tooth, deeper in every more severe state.

LEAST_DEG, MOST_DEG = (round(degrees(angle)) for angle in ANGLE_RANGE_RAD)
LONGEST_RUN = 1e3
"""Faces over which a depth may fall to nothing; beyond, it is the same everywhere."""
CRACK_KEYS = {"depth_m": "depth_share", "angle_rad": "angle_deg", "run_m": "face_share", "gear": "gear"}


class RootCracks(Fault):
    """A crack in the root of each damaged tooth."""

    words: ClassVar[tuple[str, ...]] = ("crack",)
    acts: ClassVar[str] = (
        "Cracks in roots soften their teeth, by a law fitted to finite elements, and leave contact and mass as "
        "they are; loads on the back flank close them, except under dynamics.mesh.law: linear."
    )
    columns: ClassVar[tuple[Column, ...]] = (
        Column("crack_angle_deg", pa.float64(), "deg", "of a crack, between it and the tooth's centre line"),
        Column(
            "crack_run_mm",
            pa.float64(),
            MILLIMETRE,
            "of a crack, place across the face where its depth falls to 0; 0: the same depth everywhere",
        ),
    )

    kind: Literal["crack"] = "crack"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    depth_share: Annotated[Number, Within(above=0, most=DEEPEST_SHARE), Usual(0.02, 0.5)] = Field(
        description="depth along the crack over the chord between the 30 degree tangents (ISO 6336-3)"
    )
    angle_deg: Annotated[Number, Within(least=LEAST_DEG, most=MOST_DEG)] = Field(
        default=45.0, description="from the tooth's centre line, straight into the body"
    )
    face_share: Annotated[Number | None, Within(above=0, most=LONGEST_RUN, words=(None,)), Usual(0.01, 1)] = Field(
        default=None, description=(
            "where the depth, falling from one end, is 0, over the face width; null: nowhere"
        ),
    )  # fmt: skip

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'depth_share' for cracks as deep and as long as those of the milder state on the same teeth."""
        if not isinstance(milder, RootCracks) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "depth_share" if self._sizes == milder._sizes else None

    def contradictions(self, milder: Fault) -> Iterator[Problem]:
        """Yield another angle than that of the milder crack on the same gear, less depth or a shorter run."""
        if not isinstance(milder, RootCracks) or milder.gear != self.gear or _apart(milder.teeth, self.teeth):
            return
        kept = "as in the milder state, or like in place of grows"
        if milder.angle_deg != self.angle_deg:
            allowed = f"allowed: {number_text(milder.angle_deg)}, {kept}"
            yield Problem("angle_deg", number_text(self.angle_deg), allowed)
        for key, before in milder._sizes.items():
            own = self._sizes[key]
            if own[0] < before[0] or own[1] < before[1]:
                least = "null" if before[0] == inf else f"at least {_span(before)}"
                yield Problem(key, _span(own), f"allowed: {least}, {kept}")

    def drawn(self, growth: Growth) -> Parts:
        """Return a crack in each damaged tooth: the milder one, where it has one, deeper and longer."""
        return tuple(self._grown(growth, tooth) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with a crack at every combination of its bounds."""
        for corner in corners(partial(draw, self, path="")):
            try:
                crack = corner._on_tooth(pair, 0)
            except ValueError as error:
                yield Problem("gear", str(error), "allowed: a gear whose root has one")
                return
            for problem in crack.place_problems(pair):
                yield Problem(CRACK_KEYS[problem.name], problem.received, f"allowed: {problem.allowed}")

    @property
    def _sizes(self) -> dict[str, tuple[float, float]]:
        run = (inf, inf) if self.face_share is None else bounds(self.face_share)
        return {"depth_share": bounds(self.depth_share), "face_share": run}

    def _grown(self, growth: Growth, tooth: int) -> RootCrack:
        one = draw(self, growth.place(self.gear, RootCracks), f"crack.{self.gear}.{tooth}")
        new = one._on_tooth(growth.pair, tooth)
        for old in growth.before:
            if isinstance(old, RootCrack) and (old.gear, old.tooth) == (new.gear, new.tooth):
                deepest, longest = max(old.depth_m, new.depth_m), max(old.run_m, new.run_m)
                return RootCrack(new.gear, tooth, deepest, old.angle_rad, longest)
        return new

    def _on_tooth(self, pair: GearPair, tooth: int) -> RootCrack:
        """Return the crack of drawn numbers on a tooth."""
        depth_m = constant(self.depth_share) * root_chord(pair.member(self.side)).length_m
        run_m = inf if self.face_share is None else constant(self.face_share) * pair.face_width_m
        return RootCrack(self.side, tooth, depth_m, radians(constant(self.angle_deg)), run_m)


def _apart(teeth: TeethValue, others: TeethValue) -> bool:
    """Whether two lists of teeth share none; counts begin at one tooth and share some."""
    return isinstance(teeth, tuple) and isinstance(others, tuple) and not set(teeth) & set(others)


def _span(values: tuple[float, float]) -> str:
    low, high = values
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"
