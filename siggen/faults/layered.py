"""Layers of pits: rows of equal count, one above the other, as in paper A, section 2.1."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from siggen.errors import Problem
from siggen.faults.fault import Fault
from siggen.faults.flank_place import (
    DAMAGED_GEAR,
    FACE_CENTRE,
    READING,
    AnyGear,
    Height,
    HeightReading,
    Length,
    LengthAcross,
    PlaceOnFace,
    drawn_height_m,
    heights_m,
    length_m,
)
from siggen.faults.growth import Growth
from siggen.faults.single_pit import PitPlace, PitSize, drawn_pit, largest_pit, pit_place_problems
from siggen.gears.damage.layouts import layered_centres
from siggen.gears.damage.part import Parts
from siggen.gears.damage.pit import FlankPit
from siggen.gears.damage.tooth_damage import Damage
from siggen.gears.geometry.gear_pair import GearPair
from siggen.keys.number import bounds
from siggen.keys.section import Whole
from siggen.keys.teeth import DAMAGED_TEETH, Teeth
from siggen.names import PINION

SPACING = "between pits of a row, and between rows"


class LayeredPits(PitSize, Fault):
    """Rows of equal count, one above the other, as in paper A."""

    words: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "pits"

    kind: Literal["layered"] = "layered"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    layers: Annotated[Whole, Field(ge=1, le=1000)] = Field(description="rows of pits")
    pits_per_layer: Annotated[Whole, Field(ge=1, le=1000)] = Field(description="pits in a row, across the face")
    first_height_mm: Height = Field(default="pitch", description="height of the first row above the base circle")
    height_reading: HeightReading = Field(default="axial", description=READING)
    spacing_face_mm: LengthAcross = Field(default=1.0, description=SPACING)
    spacing_profile_mm: Length = Field(default=0.4, description=SPACING)
    face_centre_mm: PlaceOnFace = Field(default=None, description=FACE_CENTRE)

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'layers' for no more layers nor pits than the milder state has on the same teeth."""
        if not isinstance(milder, LayeredPits) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "layers" if self.layers <= milder.layers and self.pits_per_layer <= milder.pits_per_layer else None

    def drawn(self, growth: Growth) -> Parts:
        """Return the pits that a state adds to its layers, tooth by tooth."""
        return tuple(pit for tooth in growth.teeth(self) for pit in self._pits(growth, tooth))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with the outermost pits."""
        for place in self._places(pair):
            yield from pit_place_problems(pair, place)

    def widest(self, pair: GearPair) -> Damage:
        """Return one row."""
        height_m = heights_m(pair, self.side, self.first_height_mm, self.height_reading)[0]
        return tuple(largest_pit(self.side, 0, height_m, face_m, self) for face_m in self._row_faces_m(pair))

    def _pits(self, growth: Growth, tooth: int) -> Iterator[FlankPit]:
        for index, centre in enumerate(self._centres_m(growth, tooth)):
            rng = growth.rng(f"{self.gear}.{tooth}.pit{index}")
            yield drawn_pit(self, self.side, growth.pair, tooth, centre, rng)

    def _milder(self, growth: Growth, tooth: int) -> list[LayeredPits]:
        """Return the layers that milder states of this growth have on a tooth, the nearest state first."""
        layers = (older for _, older in growth.milder if isinstance(older, LayeredPits))
        return [older for older in layers if older.gear == self.gear and tooth in growth.teeth(older)]

    def _centres_m(self, growth: Growth, tooth: int) -> list[tuple[float, float]]:
        """Return the centres [m] of free places of the layers; columns of a layer count from its middle outwards."""
        milder = self._milder(growth, tooth)
        uniform, pair = growth.place(self.gear, LayeredPits), growth.pair
        first = drawn_height_m(self.first_height_mm, self.height_reading, pair, self.side, uniform("first_height_mm"))
        middle = 0.5 * pair.face_width_m if self.face_centre_mm is None else length_m(self, "face_centre_mm", uniform)
        # An even number of columns is centred between two of them; what grows keeps the lattice that it began on.
        between = (milder[-1] if milder else self).pits_per_layer % 2 == 0
        heights, faces = layered_centres(
            self.layers,
            self.pits_per_layer,
            length_m(self, "spacing_face_mm", uniform),
            length_m(self, "spacing_profile_mm", uniform),
            first,
            middle,
            between=between,
        )
        centres = zip(heights.tolist(), faces.tolist(), strict=True)
        slots = [(i, j) for i in range(self.layers) for j in range(self.pits_per_layer)]
        taken = {(i, j) for m in milder for i in range(m.layers) for j in range(m.pits_per_layer)}
        return [centre for slot, centre in zip(slots, centres, strict=True) if slot not in taken]

    def _places(self, pair: GearPair) -> Iterator[PitPlace]:
        """Yield the outermost pits of the first and of the last row."""
        centres_m = (
            [pair.face_width_m / 2] if self.face_centre_mm is None else [x / 1e3 for x in bounds(self.face_centre_mm)]
        )
        reach_m = (self.pits_per_layer - 1) / 2 * bounds(self.spacing_face_mm)[1] / 1e3
        climb_m = (self.layers - 1) * bounds(self.spacing_profile_mm)[1] / 1e3
        face_key = "spacing_face_mm" if self.pits_per_layer > 1 else "face_centre_mm"
        for first_m in heights_m(pair, self.side, self.first_height_mm, self.height_reading):
            for row, height_m in ((1, first_m), (self.layers, first_m + climb_m)):
                for face_m in (centres_m[0] - reach_m, centres_m[-1] + reach_m):
                    remark = f"outermost pit of row {row} of {self.layers}: "
                    yield PitPlace(self.side, height_m, face_m, self, "first_height_mm", face_key, "depth_mm", remark)

    def _row_faces_m(self, pair: GearPair) -> list[float]:
        centre_m = pair.face_width_m / 2 if self.face_centre_mm is None else bounds(self.face_centre_mm)[0] / 1e3
        spacing_m = bounds(self.spacing_face_mm)[1] / 1e3
        return [centre_m + (i - (self.pits_per_layer - 1) / 2) * spacing_m for i in range(self.pits_per_layer)]
