"""LostShape: material that is missing from one flank by a depth of any shape over height and face.

Derived. A slice of the face meets a smooth flank, so the mate rests on it as a parabola of the relative radius R does:
it misses min over t of depth(a + t) + t²/(2R) at the arc a of its normal. Where the depth varies little over the width
of the contact, this is the depth itself; in a hole it is the distance to the nearer edge squared over 2R, as rigid
flanks sink in. How the contact narrows at the edges of a hole is left out: pits and spalls have that. Sections stay as
they were, and so does what happens beside the path of contact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.heights import flank_heights
from siggen.damage.part import Damage, Part, Refusal
from siggen.damage.sham import Sham
from siggen.errors import mm
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.names import Side

Shape = Callable[[FloatArray, FloatArray], FloatArray]
"""Heights above the base circle along the tooth's axis and places across the face (n,) -> depths (n,) [m]."""
POINTS = 1025
"""Of a flank from its foot to its tip, a few µm apart."""
LEAST_M = 1e-10
"""Tails of a shape that are less deep are none: a pair is a sound one there."""


@dataclass(frozen=True, slots=True, eq=False)
class LostShape:
    """A shape on one tooth; equal to itself alone.

    Attributes
    ----------
    gear : Side
        Its gear.
    tooth : int
    shape : callable
    kind : str
    """

    gear: Side
    tooth: int
    shape: Shape
    kind: str
    outline: None = None

    def depths_m(self, pair: GearPair, slices: int) -> FloatArray:
        """Return the depths over the flank, (POINTS, slices), from its foot to its tip [m]."""
        low, high = flank_heights(pair.member(self.gear))
        face = pair.face_width_m / slices * (np.arange(slices) + 0.5)
        height, across = np.meshgrid(np.linspace(low, high, POINTS), face, indexing="ij")
        depths = np.asarray(self.shape(height.ravel(), across.ravel()), dtype=np.float64).reshape(POINTS, slices)
        return np.where(np.abs(depths) < LEAST_M, 0.0, depths)

    def touching_m(self, pair: GearPair, place_m: FloatArray) -> FloatArray:
        """Return what slices miss at their places on the path of contact (k, n), of the same shape [m]."""
        gear, depths = pair.member(self.gear), self.depths_m(pair, place_m.shape[1])
        roll = gear.roll_at_height(np.linspace(*flank_heights(gear), POINTS))
        arcs, found = 0.5 * gear.base_radius_m * roll**2, np.zeros(place_m.shape)
        for i in np.flatnonzero(depths.any(axis=0)):
            place = np.clip(place_m[:, i, np.newaxis], pair.contact_start_m, pair.contact_end_m)
            radius = place * (pair.line_of_action_m - place) / pair.line_of_action_m
            along = place if self.gear == Side.DRIVER else pair.line_of_action_m - place
            arc = 0.5 * along**2 / gear.base_radius_m
            beside = ((arcs - arc) ** 2 / (2.0 * radius) + depths[:, i]).min(axis=1)
            found[:, i] = np.minimum(beside, np.interp(arc[:, 0], arcs, depths[:, i]))
        return found

    @property
    def depth_m(self) -> float:
        """0: what it takes is in `touching_m`."""
        return 0.0

    def rows(self) -> list[tuple[float, ...]]:
        """Return none: it has no outline."""
        return []

    def tooth_compliance_m_per_n(self, pair: GearPair, roll_rad: FloatArray, sound_m_per_n: FloatArray) -> float:  # noqa: ARG002
        """Return 0: the tooth stays as stiff."""
        return 0.0

    def profile_arc_m(self, gear: SpurGear) -> float:  # noqa: ARG002
        """Return 0: it has no outline."""
        return 0.0

    def hides(self, other: Part) -> bool:
        """Return whether it is the other one."""
        return other is self

    def sham(self) -> Sham:
        """Return a sham in its place."""
        return Sham(self)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield nothing."""
        return iter(())

    def place_problems(self, pair: GearPair) -> Iterator[Refusal]:
        """Yield a tooth that there is not, and depths that are none."""
        count = pair.member(self.gear).teeth
        if not 0 <= self.tooth < count:
            yield Refusal("tooth", f"tooth {self.tooth!r}", f"0 to {count - 1}")
            return
        depths = self.depths_m(pair, 16)
        if not (np.isfinite(depths).all() and depths.min() >= 0.0):
            received = f"depths from {1e3 * depths.min():.6g} to {mm(depths.max())}"
            yield Refusal("missing_m", received, "finite depths of at least 0 m, one for each point")

    def table_row(self) -> dict[str, object]:
        """Return gear, tooth and kind."""
        return {"gear": self.gear, "tooth": self.tooth, "kind": self.kind, "shape": "none", "depth_law": "none"}


def shapes_touching_m(pair: GearPair, pits: Iterable[Damage], place_m: FloatArray) -> FloatArray | None:
    """Return what both flanks of a pair miss by shapes at places of slices (k, n) [m]; None without any."""
    shapes = [one for of_tooth in pits for one in of_tooth if isinstance(one, LostShape)]
    return np.sum([one.touching_m(pair, place_m) for one in shapes], axis=0) if shapes else None
