"""Pits: one, in layers, in a cluster or listed; what a user writes of them, and what they take from a flank.

A pit: an ellipse on the flank with a flat or dished floor.

Source: paper A (Influence of Tooth Pitting on TVMS and Vibration Response of a Spur Gear Pair), sections 2.1 and 3.1:
elliptic cylinders with the semi-axis a along the face and b along the height.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field, model_validator

from siggen.arrays import FloatArray
from siggen.damage.fault import Fault, HitTeeth
from siggen.damage.flank_place import (
    ARC,
    AXIAL,
    DAMAGED_GEAR,
    DEPTH,
    FACE_CENTRE,
    FACE_WIDTH,
    FLOOR,
    MIDDLE_HEIGHT,
    MM,
    PROBE_M,
    AnyGear,
    FloorShape,
    Height,
    Length,
    LengthAcross,
    PlaceOnFace,
    drawn_height_m,
    found_problems,
    height_m_of,
    heights_m,
    length_m,
)
from siggen.damage.growth import Growth
from siggen.damage.heights import flank_heights
from siggen.damage.irregular import ListedIrregular
from siggen.damage.on_flank import OnFlank
from siggen.damage.outlines import Ellipse
from siggen.damage.part import Damage, Part, Parts
from siggen.errors import Problem
from siggen.gears.gear_pair import GearPair
from siggen.keys.number import Number, Within, at, bounds
from siggen.keys.problems import refusal
from siggen.keys.scaling import Grows
from siggen.keys.section import Section, Whole
from siggen.keys.teeth import DAMAGED_TEETH, Teeth
from siggen.names import PINION, Side


@dataclass(frozen=True, slots=True)
class FlankPit(OnFlank):
    """One pit of elliptical outline.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    height_m : float
        Centre's height x above the base circle, along the tooth centre line [m].
    face_m : float
        Centre's coordinate across the face, 0 to the face width [m].
    semi_axis_face_m, semi_axis_profile_m : float
        Semi-axes across the face and along the height [m].
    depth_m : float
        Depth normal to the tooth's centre plane [m]; of a dish at its centre.
    floor : str
        'flat' or 'dish' (half ellipsoid).
    """

    gear: Side
    tooth: int
    height_m: float
    face_m: float
    semi_axis_face_m: float
    semi_axis_profile_m: float
    depth_m: float
    floor: str = "flat"

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "pit"

    @property
    def outline(self) -> Ellipse:
        """The pit's ellipse."""
        return Ellipse(self.height_m, self.face_m, self.semi_axis_face_m, self.semi_axis_profile_m)

    def hides(self, other: Part) -> bool:  # noqa: ARG002
        """Return False: pits count one by one, however they overlap."""
        return False


# Where pits sit on a flank: layers one above the other, or a cluster.
#
# Source: paper A, sections 2.1 and 3.3 (layers of equal pits, the first at the height mu); numbers and spacings are
# free, as the paper does not give them. Only positions: sizes belong to the caller. Fewer pits of a layout are always
# the first ones of more.


def layered_centres(
    layers: int,
    per_layer: int,
    spacing_face_m: float,
    spacing_height_m: float,
    first_height_m: float,
    face_centre_m: float,
    *,
    between: bool = False,
) -> tuple[FloatArray, FloatArray]:
    """Return heights and face coordinates of pits in aligned layers, layer by layer upwards, (n,) each [m].

    Inside a layer pits go from the centre outwards on one lattice, 0, +1, -1, +2, ... spacings from `face_centre_m`,
    so that a layer of fewer pits is a subset of a layer of more. An even number therefore stands half a spacing off
    centre, unless `between` puts the lattice at +-1/2, +-3/2, ... spacings, where odd numbers stand off centre
    instead.

    Parameters
    ----------
    layers, per_layer : int
        At least 1 each.
    spacing_face_m, spacing_height_m : float
        Distance of neighbours across the face and of layers along the height [m].
    first_height_m, face_centre_m : float
        Height of the first layer and centre of the layers across the face [m].
    between : bool
        Whether the centre lies between two pits.
    """
    index = np.arange(per_layer)
    side = np.where(index % 2 == 1, 1.0, -1.0)
    steps = -side * (index // 2 + 0.5) if between else side * ((index + 1) // 2)
    height = first_height_m + spacing_height_m * np.repeat(np.arange(layers, dtype=np.float64), per_layer)
    face = np.tile(face_centre_m + spacing_face_m * steps, layers)
    return height, face


def clustered_centres(
    rng: np.random.Generator,
    count: int,
    height_centre_m: float,
    height_spread_m: float,
    face_low_m: float,
    face_high_m: float,
    *,
    height_low_m: float = -np.inf,
    height_high_m: float = np.inf,
) -> tuple[FloatArray, FloatArray]:
    """Return heights and face coordinates of a cluster, (n,) each [m].

    Heights are normal about their centre, cut off at their limits; face coordinates are uniform. Each pit takes two
    uniform numbers from `rng`, so that a smaller cluster is the beginning of a larger one.

    Parameters
    ----------
    rng : numpy.random.Generator
    count : int
        At least 1.
    height_centre_m, height_spread_m : float
        Mean and standard deviation of the heights before the cut [m].
    face_low_m, face_high_m : float
        Limits across the face [m].
    height_low_m, height_high_m : float
        Limits of the heights [m].
    """
    uniform = rng.random((count, 2))
    height = _cut_normal(uniform[:, 0], height_centre_m, height_spread_m, height_low_m, height_high_m)
    return height, face_low_m + (face_high_m - face_low_m) * uniform[:, 1]


def _cut_normal(uniform: FloatArray, mean: float, spread: float, low: float, high: float) -> FloatArray:
    from scipy.special import ndtr, ndtri

    if not spread >= 0.0:
        raise ValueError(f"received spread {spread!r} m; allowed: at least 0")
    if spread == 0.0:
        return np.full(uniform.size, min(max(mean, low), high))
    first, last = ndtr((low - mean) / spread), ndtr((high - mean) / spread)
    # Far out in a tail both probabilities round to the same number and the inverse leaves the limits.
    return np.asarray(np.clip(mean + spread * ndtri(first + (last - first) * uniform), low, high))


# One pit: its size as a user writes it, drawn at a place, checked at a place (pits: paper A, section 2.1).
#
# Sizes are those of one pit: an ellipse on the flank with semi-axes across the face and along the profile, and a
# depth. A distribution of a size is drawn once per pit.

SEMI_AXES = "half the length across the face, and along the profile"


class PitSize(Section):
    """Size and floor of a pit."""

    semi_axis_face_mm: Length = Field(description=SEMI_AXES)
    semi_axis_profile_mm: Length = Field(description=SEMI_AXES)
    depth_mm: Length = Field(description=DEPTH)
    floor: FloorShape = Field(default="flat", description=FLOOR)


@dataclass(frozen=True, slots=True)
class PitPlace:
    """A place where pits of a state may come to lie, and the keys of the configuration that put them there."""

    gear: Side
    height_m: float
    face_m: float
    size: PitSize
    height_key: str
    face_key: str
    depth_key: str
    remark: str = ""


def drawn_pit(
    size: PitSize, gear: Side, pair: GearPair, tooth: int, centre_m: tuple[float, float], rng: np.random.Generator
) -> FlankPit:
    """Return a pit with its own sizes at a height and across the face [m].

    A centre that a random shift took off the flank is put on its edge.
    """
    low, high = flank_heights(pair.member(gear))
    semi_face, semi_profile, depth = (
        MM * at(n, rng.random()) for n in (size.semi_axis_face_mm, size.semi_axis_profile_mm, size.depth_mm)
    )
    return FlankPit(
        gear=gear,
        tooth=tooth,
        height_m=min(max(centre_m[0], low), high),
        face_m=min(max(centre_m[1], 0.0), pair.face_width_m),
        semi_axis_face_m=semi_face,
        semi_axis_profile_m=semi_profile,
        depth_m=depth,
        floor=size.floor,
    )


def pit_place_problems(pair: GearPair, place: PitPlace) -> list[Problem]:
    """Return what is wrong with one place: its height and its place on the face first, then the depth there."""
    middle_m = pair.face_width_m / 2
    at_height = found_problems(pair, (_probe(place, place.height_m, middle_m),), place.height_key, place.remark)
    pitch_m = height_m_of(pair, Side(place.gear), "pitch", "axial")
    at_face = found_problems(pair, (_probe(place, pitch_m, place.face_m),), place.face_key, place.remark)
    if at_height or at_face:
        return [*at_height, *at_face]
    deepest = replace(
        _probe(place, place.height_m, middle_m),
        semi_axis_profile_m=bounds(place.size.semi_axis_profile_mm)[1] / 1e3,
        depth_m=bounds(place.size.depth_mm)[1] / 1e3,
    )
    return found_problems(pair, (deepest,), place.depth_key, place.remark)


def _probe(place: PitPlace, height_m: float, face_m: float) -> FlankPit:
    return FlankPit(Side(place.gear), 0, height_m, face_m, PROBE_M, PROBE_M, PROBE_M, place.size.floor)


def largest_pit(gear: Side, tooth: int, height_m: float, face_m: float, size: PitSize) -> FlankPit:
    """Return a pit with its sizes at their upper bounds, without depth to speak of."""
    across_m, along_m = bounds(size.semi_axis_face_mm)[1] / 1e3, bounds(size.semi_axis_profile_mm)[1] / 1e3
    return FlankPit(gear, tooth, height_m, face_m, across_m, along_m, PROBE_M, size.floor)


# Layers of pits: rows of equal count, one above the other, as in paper A, section 2.1.

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
        height_m = heights_m(pair, self.side, self.first_height_mm, AXIAL)[0]
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
        first = drawn_height_m(self.first_height_mm, AXIAL, pair, self.side, uniform("first_height_mm"))
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
        for first_m in heights_m(pair, self.side, self.first_height_mm, AXIAL):
            for row, height_m in ((1, first_m), (self.layers, first_m + climb_m)):
                for face_m in (centres_m[0] - reach_m, centres_m[-1] + reach_m):
                    remark = f"outermost pit of row {row} of {self.layers}: "
                    yield PitPlace(self.side, height_m, face_m, self, "first_height_mm", face_key, "depth_mm", remark)

    def _row_faces_m(self, pair: GearPair) -> list[float]:
        centre_m = pair.face_width_m / 2 if self.face_centre_mm is None else bounds(self.face_centre_mm)[0] / 1e3
        spacing_m = bounds(self.spacing_face_mm)[1] / 1e3
        return [centre_m + (i - (self.pits_per_layer - 1) / 2) * spacing_m for i in range(self.pits_per_layer)]


# A cluster of pits: scattered around a height.


class ClusteredPits(PitSize, Fault):
    """Pits scattered around a height."""

    words: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "pits"

    kind: Literal["clustered"] = "clustered"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    count: Annotated[Whole, Field(ge=1, le=10_000)] = Field(description="pits")
    centre_height_mm: Height = Field(default="pitch", description=MIDDLE_HEIGHT)
    spread_profile_mm: Length = Field(description="standard deviation of the heights; across the face pits lie evenly")

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return 'count' for no more pits than the milder state has on the same teeth."""
        if not isinstance(milder, ClusteredPits) or (milder.gear, milder.teeth) != (self.gear, self.teeth):
            return None
        return "count" if self.count <= milder.count else None

    def drawn(self, growth: Growth) -> Parts:
        """Return the pits that a state adds to its cluster, tooth by tooth."""
        return tuple(pit for tooth in growth.teeth(self) for pit in self._pits(growth, tooth))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with pits in the middle and at either end of the flank."""
        middle_m, keys = pair.face_width_m / 2, ("centre_height_mm", "spread_profile_mm", "depth_mm")
        for height_m in heights_m(pair, self.side, self.centre_height_mm, AXIAL):
            yield from pit_place_problems(pair, PitPlace(self.side, height_m, middle_m, self, *keys))
        for height_m in flank_heights(pair.member(self.side)):
            remark = "a pit scattered to the end of the flank: "
            yield from pit_place_problems(pair, PitPlace(self.side, height_m, middle_m, self, *keys, remark))

    def _pits(self, growth: Growth, tooth: int) -> Iterator[FlankPit]:
        present = sum(one.gear == self.gear and one.tooth == tooth for one in growth.before)
        for index, centre in enumerate(self._centres_m(growth, tooth, max(self.count - present, 0))):
            rng = growth.rng(f"{self.gear}.{tooth}.pit{index}")
            yield drawn_pit(self, self.side, growth.pair, tooth, centre, rng)

    def _centres_m(self, growth: Growth, tooth: int, count: int) -> list[tuple[float, float]]:
        """Return centres [m] scattered around a height and over the face."""
        if count == 0:
            return []
        uniform, pair = growth.place(self.gear, ClusteredPits), growth.pair
        low, high = flank_heights(pair.member(self.side))
        heights, faces = clustered_centres(
            growth.rng(f"{self.gear}.{tooth}.centres"),
            count,
            drawn_height_m(self.centre_height_mm, AXIAL, pair, self.side, uniform("centre_height_mm")),
            length_m(self, "spread_profile_mm", uniform),
            0.0,
            pair.face_width_m,
            height_low_m=low,
            height_high_m=high,
        )
        return list(zip(heights.tolist(), faces.tolist(), strict=True))


# Pits and outlines that are listed one by one.


class ListedPit(PitSize):
    """One pit at a given place."""

    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    tooth: Annotated[Whole, Field(ge=0)] = Field(default=0, description="index of the tooth, from 0")
    height_mm: Height = Field(default="pitch", description=MIDDLE_HEIGHT)
    face_mm: Annotated[Number, Within(least=0), Grows(FACE_WIDTH)] = Field(description=FACE_CENTRE)


class ListedPits(Fault):
    """Pits, and irregular spalls by their outlines, one by one."""

    words: ClassVar[tuple[str, ...]] = ("pitting", "spalling")
    nouns: ClassVar[str] = "pits and spalls"
    one_flank: ClassVar[bool] = True

    kind: Literal["list"] = "list"
    pits: tuple[ListedPit, ...] = Field(default=(), description="the pits")
    outlines: tuple[ListedIrregular, ...] = Field(default=(), description="irregular spalls by their very edges")

    @model_validator(mode="after")
    def _not_empty(self) -> ListedPits:
        if not (self.pits or self.outlines):
            raise refusal([Problem("pits", "no pits and no outlines", "allowed: at least 1 of either")])
        return self

    @classmethod
    def default_word(cls, read: Callable[[str], object]) -> str:
        """Return spalling for a list of outlines alone."""
        return "spalling" if read("outlines") and not read("pits") else "pitting"

    @property
    def own_words(self) -> tuple[str, ...]:
        """Whatever is listed may be called pitting, and with a spall spalling."""
        return self.words if self.outlines else ("pitting",)

    @property
    def hit_gear(self) -> str:
        """The gear of the first entry: all are in one mesh."""
        return self.hit_gears[0]

    @property
    def hit_gears(self) -> tuple[str, ...]:
        """Those of all entries."""
        return (*(one.gear for one in self.pits), *(one.gear for one in self.outlines))

    def with_gears(self, name: Callable[[str], str]) -> ListedPits:
        """Return the same on gears of other names."""
        lists = {
            key: tuple(one.model_copy(update={"gear": name(one.gear)}) for one in getattr(self, key))
            for key in ("pits", "outlines")
        }
        return self.model_copy(update=lists)

    def hit_teeth(self) -> HitTeeth:
        """Yield every listed tooth."""
        yield from ((f"pits.{number}.tooth", pit.gear, (pit.tooth,)) for number, pit in enumerate(self.pits))
        yield from ((f"outlines.{number}.tooth", one.gear, (one.tooth,)) for number, one in enumerate(self.outlines))

    @property
    def own_edge_radius(self) -> tuple[str, Number] | None:
        """Those of irregular spalls have one each, of which the largest is told."""
        if not self.outlines:
            return None
        number = max(range(len(self.outlines)), key=lambda i: self.outlines[i].edge_radius_mm)
        return f"outlines.{number}.edge_radius_mm", self.outlines[number].edge_radius_mm

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool] | None:  # noqa: ARG002
        """Return that outlines are no rectangles; None without."""
        return (False, False) if self.outlines else None

    def drawn(self, growth: Growth) -> Parts:
        """Return what is listed."""
        listed = (one.spall(growth.pair, ARC) for one in self.outlines)
        return (*self._pits(growth), *listed)

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong with each of them."""
        for index, pit in enumerate(self.pits):
            keys = (f"pits.{index}.height_mm", f"pits.{index}.face_mm", f"pits.{index}.depth_mm")
            for height_m in heights_m(pair, Side(pit.gear), pit.height_mm, AXIAL):
                for face_mm in bounds(pit.face_mm):
                    yield from pit_place_problems(pair, PitPlace(Side(pit.gear), height_m, face_mm / 1e3, pit, *keys))
        for index, outline in enumerate(self.outlines):
            yield from outline.problems(pair, ARC, f"outlines.{index}.")

    def widest(self, pair: GearPair) -> Damage:
        """Return all of them, as large as they may be."""
        # Teeth that there are not are refused by name elsewhere.
        pits = tuple(
            largest_pit(
                Side(pit.gear),
                pit.tooth,
                heights_m(pair, Side(pit.gear), pit.height_mm, AXIAL)[0],
                bounds(pit.face_mm)[0] / 1e3,
                pit,
            )
            for pit in self.pits
            if pit.tooth < pair.member(Side(pit.gear)).teeth
        )
        outlined = (one for one in self.outlines if one.tooth < pair.member(Side(one.gear)).teeth)
        return (
            *pits,
            *(replace(one.spall(pair, ARC), strip_depths_m=one.probe_depths_m) for one in outlined),
        )

    def _pits(self, growth: Growth) -> Iterator[FlankPit]:
        for index, pit in enumerate(self.pits):
            rng = growth.rng(f"list.pit{index}")
            height = drawn_height_m(pit.height_mm, AXIAL, growth.pair, Side(pit.gear), rng.random())
            yield drawn_pit(
                pit, Side(pit.gear), growth.pair, pit.tooth, (height, MM * at(pit.face_mm, rng.random())), rng
            )
