"""An irregular spall: two skewed, wavy edges across the face, a rough or dished floor, rounded edges.

Derived. At every place w across the face the spall takes one stretch of the flank, from its lower to its upper edge.
Both are straight between stations, so the spall is a chain of strips that each have a depth of their own. A wavy edge
is a normal process with the covariance exp(-(d/L)²) over the distance d, as a sum of cosines, cut off at two standard
deviations and scaled to a mean square of 1: so edges never come nearer than the waviness allows.

A spall that has grown takes in the milder one: at each station the lower of both lower edges and the higher of both
upper ones. The milder one's stations are stations of the grown one, so it lies inside everywhere, not only there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from math import isfinite, sqrt
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from siggen.arrays import FloatArray
from siggen.damage.fault import Fault
from siggen.damage.flank_damage import damage_problems, single_problems
from siggen.damage.flank_place import (
    ARC,
    DAMAGED_GEAR,
    DEPTH,
    EDGE_RADIUS,
    FACE_CENTRE,
    FLOOR,
    LENGTHS,
    MIDDLE_HEIGHT,
    MM,
    MODULE,
    PROBE_M,
    SKEW,
    AnyGear,
    FloorShape,
    Length,
    OptionalLength,
    PlaceOnFace,
    axial_heights_m,
    axial_m,
    height_m_of,
    read_m,
    size_that_adds_nothing,
)
from siggen.damage.growth import Growth
from siggen.damage.heights import clipped_arcs_m, flank_heights, initiation_height_m
from siggen.damage.on_flank import OnFlank, floor_problems
from siggen.damage.outlines import Polygon, rectangle
from siggen.damage.part import Damage, Part, Parts, Refusal
from siggen.damage.spalls import FlankSpall
from siggen.errors import Problem, mm
from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear
from siggen.keys.distributions import Uniform
from siggen.keys.drawing import draw
from siggen.keys.number import Number, Within, at, bounds, constant, number_text
from siggen.keys.scaling import Grows
from siggen.keys.section import Real, Section, Whole
from siggen.keys.teeth import DAMAGED_TEETH, Teeth
from siggen.keys.usual import Usual
from siggen.keys.wording import AllowedText
from siggen.names import PINION, Side

STRIPS = 64
"""Strips of a whole face; their ends stay where they are while a spall grows."""
COSINES = 32
"""Of a wavy edge: enough for a process that looks normal."""
CUT = 2.0
WAVE_LIMIT = CUT / 0.959_39
"""Largest value of a wave of mean square 1: the cut over the root mean square of what a cut at 2 leaves."""
NEAR = 1e-6
"""Stations nearer than this share of the face are one."""

Station = tuple[float, float, float]
"""Face coordinate, height of the lower and of the upper edge [m]."""


@dataclass(frozen=True, slots=True)
class Waves:
    """A wavy edge of mean square 1 over places across the face, drawn once; `turns` (n,) and `phases` (n,)."""

    turns: FloatArray
    phases: FloatArray

    def __call__(self, face_m: FloatArray, length_m: float) -> FloatArray:
        """Return the wave at places (k,) [m] for a correlation length [m]; at most `WAVE_LIMIT` either way."""
        angles = np.multiply.outer(face_m / length_m, self.turns) + self.phases
        found = np.sqrt(2.0 / self.turns.size) * np.cos(angles).sum(axis=-1)
        return np.asarray(np.clip(found, -CUT, CUT) * (WAVE_LIMIT / CUT))


def drawn_waves(rng: np.random.Generator) -> Waves:
    """Return a wavy edge; wave numbers are normal with the standard deviation √2/L."""
    return Waves(np.sqrt(2.0) * rng.standard_normal(COSINES), 2.0 * np.pi * rng.random(COSINES))


@dataclass(frozen=True, slots=True)
class IrregularSpall(OnFlank):
    """One irregular spall.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    stations_m : tuple of (face, lower height, upper height)
        Ascending across the face, at least two [m].
    strip_depths_m : tuple of float
        Depth between neighbouring stations, one less than stations [m].
    edge_radius_m : float
        Of its edges [m].
    floor : str
        'flat' or 'dish': half an elliptic cylinder over the height range of the whole outline.
    milder : IrregularSpall or None
        The one that it has grown from and holds. Near its rim a longer dish is shallower than a shorter one; there the
        deeper one counts.
    """

    gear: Side
    tooth: int
    stations_m: tuple[Station, ...]
    strip_depths_m: tuple[float, ...]
    edge_radius_m: float
    floor: str = "flat"
    # The stations tell spalls apart as a rule: a hash of the whole chain would cost more than what it looks up.
    milder: IrregularSpall | None = field(default=None, hash=False)

    @property
    def kind(self) -> str:
        """Kind of damage: a spall as any other."""
        return "spall"

    @property
    def depth_m(self) -> float:
        """Largest depth [m]."""
        return max(self.strip_depths_m)

    @property
    def outline(self) -> Polygon:
        """The lower edge across the face and the upper one back."""
        lower = [(low, face) for face, low, _ in self.stations_m]
        upper = [(high, face) for face, _, high in reversed(self.stations_m)]
        return Polygon(tuple(dict.fromkeys((*lower, *upper))))

    def rows(self) -> list[tuple[float, ...]]:
        """Return the rows of all strips, with those of the milder spall where a dish could be shallower than it."""
        held = self.milder.rows() if self.floor == "dish" and self.milder is not None else []
        return [*_strip_rows(self), *held]

    def profile_arc_m(self, gear: SpurGear) -> float:
        """Return the longest arc between both edges at one place across the face, clipped to the flank [m]."""
        return float(np.max(clipped_arcs_m(gear, *np.array(self.stations_m)[:, 1:].T)))

    def hides(self, other: Part) -> bool:
        """Return whether `other` is one that it has grown from, or lies inside one of its strips and nowhere deeper."""
        milder = self.milder
        while milder is not None:
            if milder == other:
                return True
            milder = milder.milder
        return OnFlank.hides(self, other)

    def own_problems(self) -> Iterator[Refusal]:
        """Yield stations that do not ascend, edges that cross, and floor, depth or edge radius that are none.

        Between stations that ascend and edges that do not cross the outline cannot meet itself.
        """
        face, low, high = np.array(self.stations_m).T
        if not (np.isfinite(face).all() and np.all(np.diff(face) > 0.0) and face.size > 1):
            yield Refusal(
                "stations_m", f"stations at {(1e3 * face).tolist()} mm", "at least two, ascending across the face"
            )
        elif not np.all(low <= high):
            i = int(np.argmin(low <= high))
            received = f"a lower edge at {mm(low[i])} and an upper one at {mm(high[i])}, {mm(face[i])} across the"
            yield Refusal("stations_m", f"{received} face", "edges that do not cross")
        if len(self.strip_depths_m) != face.size - 1:
            received = f"{len(self.strip_depths_m)} depths of strips between {face.size} stations"
            yield Refusal("strip_depths_m", received, "one between neighbouring stations")
        if not (np.isfinite(self.edge_radius_m) and self.edge_radius_m >= 0.0):
            yield Refusal("edge_radius_m", f"edge radius {mm(self.edge_radius_m)}", "finite and at least 0")
        yield from floor_problems(self)

    def table_row(self) -> dict[str, object]:
        """Return place, size, outline and floor in mm, with the radius of the edges and the depth of every strip."""
        depths = [1e3 * depth for depth in self.strip_depths_m]
        return {**OnFlank.table_row(self), "edge_radius_mm": 1e3 * self.edge_radius_m, "strip_depth_mm": depths}


def _strip_rows(spall: IrregularSpall) -> tuple[tuple[float, ...], ...]:
    dish, span = spall.floor == "dish", spall.outline.height_range_m
    found: list[tuple[float, ...]] = []
    for (one, two), depth in zip(pairwise(spall.stations_m), spall.strip_depths_m, strict=True):
        corners = ((one[1], one[0]), (two[1], two[0]), (two[2], two[0]), (one[2], one[0]))
        strip = Polygon(tuple(dict.fromkeys(corners)))
        found += strip.rows(depth, dish, spall.edge_radius_m, span)
    return tuple(found)


def stations_across(
    face_width_m: float, left_m: float, right_m: float, milder: IrregularSpall | None = None
) -> FloatArray:
    """Return where the stations of a spall lie across the face (k,) [m]: the ends of strips, its own, the milder's."""
    if milder is not None:
        left_m, right_m = min(left_m, milder.stations_m[0][0]), max(right_m, milder.stations_m[-1][0])
    fixed = [left_m, right_m] + ([] if milder is None else [face for face, _, _ in milder.stations_m])
    ends = face_width_m * np.arange(STRIPS + 1) / STRIPS
    near = np.abs(np.subtract.outer(ends, fixed)).min(axis=1) < NEAR * face_width_m
    inside = (ends > left_m) & (ends < right_m) & ~near
    return np.unique(np.concatenate([ends[inside], fixed]))


def grown_spall(
    gear: Side,
    tooth: int,
    face_m: FloatArray,
    edges_m: tuple[FloatArray, FloatArray],
    strip_depths_m: FloatArray,
    edge_radius_m: float,
    floor: str,
    milder: IrregularSpall | None = None,
) -> IrregularSpall:
    """Return a spall with its own edges and depths, or the milder one's where those go beyond.

    Parameters
    ----------
    gear, tooth, edge_radius_m, floor, milder
        As in `IrregularSpall`.
    face_m : (k,)
        `stations_across` [m].
    edges_m : (k,), (k,)
        Heights x of the lower and the upper edge at the stations [m].
    strip_depths_m : (k - 1,)
        [m].
    """
    low, high = (np.array(edge) for edge in edges_m)
    depths = np.array(strip_depths_m)
    if milder is not None:
        face, lower, upper = np.array(milder.stations_m).T
        inside = (face_m >= face[0]) & (face_m <= face[-1])
        low[inside] = np.minimum(low, np.interp(face_m, face, lower))[inside]
        high[inside] = np.maximum(high, np.interp(face_m, face, upper))[inside]
        middle = 0.5 * (face_m[1:] + face_m[:-1])
        strip = np.clip(np.searchsorted(face, middle) - 1, 0, face.size - 2)
        older = np.where((middle > face[0]) & (middle < face[-1]), np.array(milder.strip_depths_m)[strip], 0.0)
        depths = np.maximum(depths, older)
    keep = _bends(low, high, depths)
    stations = tuple(zip(face_m[keep].tolist(), low[keep].tolist(), high[keep].tolist(), strict=True))
    return IrregularSpall(gear, tooth, stations, tuple(depths[keep[:-1]].tolist()), edge_radius_m, floor, milder)


def _bends(low: FloatArray, high: FloatArray, depths: FloatArray) -> np.ndarray:
    """Return the stations that matter (k,): not those at which both edges go on level and the depth stays."""
    keep = np.ones(low.size, np.bool_)
    for edge in (low, high):
        keep[1:-1] &= (edge[1:-1] == edge[:-2]) & (edge[1:-1] == edge[2:])
    keep[1:-1] = ~(keep[1:-1] & (depths[1:] == depths[:-1]))
    return keep


# Irregular spalls of a state: skewed and wavy edges, a rough floor; one on each damaged tooth, growing with the state.
#
# Ranges that no source gives are assumed: skews up to a few tenths of the length per 10 mm of face, waviness of 5 to
# 20 % of the length, edge radii of 0.02 to 0.2 mm, depths from the depth of the largest shear stress (0.3 to 0.8 Hertz
# half widths) to several tenths of a millimetre.

FLOOR_ROUGHNESS = 0.15
"""Rms of the depth from strip to strip across the face, over it (assumed)."""
PER_10MM = 0.1
"""mm of arc per 10 mm of face as a slope."""
WAVE_SHARE = 0.1
"""Distance across the face, over its width, in which the correlation of the waves falls to 1/e; assumed."""
DEPTH_SHARE = 0.05
"""Depth over the root of profile length x face length, where none is given; assumed."""

SIZES = ("profile_length_mm", "face_share", "depth_mm")
START: Literal["below_pitch"] = "below_pitch"
Middle = Annotated[Number | Literal["below_pitch", "pitch"], Within(least=0, words=(START, "pitch")), Grows(MODULE)]
Skew = Annotated[Number, Within(least=-5, most=5), Usual(0.005, 5), Grows(SKEW)]
Share = Annotated[Number, Within(above=0, most=1), Usual(0.01, 1)]


class IrregularSpalls(Fault):
    """An irregular spall on each damaged tooth; drawn once, so that a more severe state holds the milder one."""

    words: ClassVar[tuple[str, ...]] = ("spalling",)
    outranked: ClassVar[tuple[str, ...]] = ("pitting",)
    nouns: ClassVar[str] = "spalls"

    kind: Literal["irregular"] = "irregular"
    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    teeth: Teeth = Field(default=1, description=DAMAGED_TEETH)
    centre_height_mm: Middle = Field(
        default=START,
        description=MIDDLE_HEIGHT,
    )
    profile_length_mm: Length = Field(description=LENGTHS)
    face_share: Share = Field(description="length across the face over the face width")
    face_centre_mm: PlaceOnFace = Field(default=None, description=FACE_CENTRE)
    skew_mm_per_10mm: Skew = Field(
        default=Uniform(low=-0.15, high=0.15),
        description="rise of each edge towards the tip, mm of arc over 10 mm of face (assumed)",
    )
    waviness: Annotated[Number, Within(least=0, most=0.2), Usual(0.002, 0.2)] = Field(
        default=0.1, description="rms of each edge's waves over the profile length (default assumed)"
    )
    edge_radius_mm: Annotated[Number, Within(least=0, most=1), Usual(0.002, 1), Grows(MODULE)] = Field(
        default=Uniform(low=0.02, high=0.2), description=EDGE_RADIUS
    )
    depth_mm: OptionalLength = Field(
        default=None,
        description=DEPTH,
    )
    floor: FloorShape = Field(default="dish", description=FLOOR)

    def key_that_adds_nothing(self, milder: Fault) -> str | None:
        """Return the size that is smaller, for spalls in no direction larger than the milder ones at the same place."""
        return size_that_adds_nothing(self, milder, SIZES)

    def drawn(self, growth: Growth) -> Parts:
        """Return a spall on each damaged tooth, with the draws of the first one that it has grown from."""
        return tuple(_on_tooth(self, growth, tooth) for tooth in growth.teeth(self))

    def place_problems(self, pair: GearPair) -> Iterator[Problem]:
        """Yield what is wrong at the bounds, whatever the waves turn out to be: they never go beyond `WAVE_LIMIT`."""
        return _problems(pair, self)

    def widest(self, pair: GearPair) -> Damage:
        """Return a rectangle as long as the longest spall: on the safe side, since skewed edges leave land earlier."""
        gear, across = pair.member(self.side), MM * _longest_face_mm(self, pair.face_width_m / MM)
        middle = 0.5 * pair.face_width_m if self.face_centre_mm is None else MM * bounds(self.face_centre_mm)[0]
        along = read_m(gear, _heights_m(pair, self)[0], ARC)
        half = 0.5 * MM * bounds(self.profile_length_mm)[1]
        heights = axial_m(gear, along - half, ARC), axial_m(gear, along + half, ARC)
        return (FlankSpall(self.side, 0, rectangle(heights, (middle - 0.5 * across, middle + 0.5 * across)), PROBE_M),)

    @property
    def own_edge_radius(self) -> tuple[str, Number]:
        """Each has one."""
        return "edge_radius_mm", self.edge_radius_mm

    def straight_edges(self, face_width_mm: float) -> tuple[bool, bool]:  # noqa: ARG002 - its share is given
        """Return whether nothing bends its edges, and whether it then may go through the face."""
        straight = all(bounds(number) == (0.0, 0.0) for number in self._bending())
        return straight, straight and bounds(self.face_share)[1] >= 1.0

    def _bending(self) -> Iterator[Number]:
        yield from (self.skew_mm_per_10mm, self.waviness)


def _on_tooth(model: IrregularSpalls, growth: Growth, tooth: int) -> IrregularSpall:
    pair, name = growth.pair, f"irregular.{model.gear}.{tooth}"
    uniform = growth.place(model.gear, IrregularSpalls)
    size = draw(model, uniform, name)
    gear, width = pair.member(Side(model.gear)), pair.face_width_m
    length, across = MM * constant(size.profile_length_mm), width * constant(size.face_share)
    middle = 0.5 * width if size.face_centre_mm is None else MM * constant(size.face_centre_mm)
    milder = _milder(growth, model.gear, tooth)
    face = stations_across(width, middle - 0.5 * across, middle + 0.5 * across, milder)
    along = read_m(gear, _middle_height_m(pair, size), ARC)

    def slope(edge: str) -> float:
        return PER_10MM * at(model.skew_mm_per_10mm, uniform(f"{name}.{edge}_skew_mm_per_10mm"))

    arcs = [
        along + side * (0.5 * length) + (slope(edge) * (face - middle) + _waves_m(size, growth, f"{name}.{edge}", face))
        for side, edge in zip((-1.0, 1.0), _edges(model.gear), strict=True)
    ]
    edges = [axial_heights_m(gear, arc, ARC) for arc in arcs]
    return grown_spall(
        Side(model.gear),
        tooth,
        face,
        (edges[0], edges[1]),
        _depth_m(size, length, across) * _rough(size, growth, name, face, width),
        MM * constant(size.edge_radius_mm),
        size.floor,
        milder,
    )


def _milder(growth: Growth, gear: str, tooth: int) -> IrregularSpall | None:
    found = [one for one in growth.before if isinstance(one, IrregularSpall) and (one.gear, one.tooth) == (gear, tooth)]
    return found[-1] if found else None


def _edges(gear: str) -> tuple[str, str]:
    """Return which edge is the lower and which the upper one: contact climbs the driving pinion's flank."""
    return ("leading", "trailing") if gear == Side.DRIVER else ("trailing", "leading")


def _middle_height_m(pair: GearPair, size: IrregularSpalls) -> float:
    centre = size.centre_height_mm
    if centre == "below_pitch":
        return initiation_height_m(pair, Side(size.gear))
    return height_m_of(pair, Side(size.gear), centre if isinstance(centre, str) else constant(centre), ARC)


def _waves_m(size: IrregularSpalls, growth: Growth, name: str, face_m: FloatArray) -> FloatArray:
    """Return how far an edge lies above its straight line by its waves, at stations (k,) [m]."""
    waves = drawn_waves(growth.shape(size.gear, IrregularSpalls, name))
    rms = constant(size.waviness) * MM * constant(size.profile_length_mm)
    return rms * waves(face_m, WAVE_SHARE * growth.pair.face_width_m)


def _depth_m(size: IrregularSpalls, length_m: float, across_m: float) -> float:
    if size.depth_mm is not None:
        return MM * constant(size.depth_mm)
    return DEPTH_SHARE * sqrt(length_m * across_m)


def _rough(size: IrregularSpalls, growth: Growth, name: str, face_m: FloatArray, width_m: float) -> FloatArray:
    """Return the depth of the strips between stations over the mean one (k - 1,): uniform, of the rms asked for."""
    draws = growth.shape(size.gear, IrregularSpalls, f"{name}.floor").random(STRIPS)
    strip = np.clip((0.5 * (face_m[1:] + face_m[:-1]) / width_m * STRIPS).astype(int), 0, STRIPS - 1)
    return np.asarray(1.0 + FLOOR_ROUGHNESS * sqrt(3.0) * (2.0 * draws[strip] - 1.0))


def _problems(pair: GearPair, size: IrregularSpalls) -> Iterator[Problem]:
    """Yield what is wrong at the bounds, whatever the waves turn out to be: they never go beyond `WAVE_LIMIT`.

    A spall at an earlier stage is the same but smaller, and its edges are as far from crossing.
    """
    width_mm = pair.face_width_m / MM
    yield from _face_problems(size, width_mm)
    yield from _edge_problems(pair, size, width_mm)


def _longest_face_mm(size: IrregularSpalls, width_mm: float) -> float:
    """Return the largest length across the face [mm]."""
    return width_mm * bounds(size.face_share)[1]


def _face_problems(size: IrregularSpalls, width_mm: float) -> Iterator[Problem]:
    length_mm = _longest_face_mm(size, width_mm)
    for centre_mm in (0.5 * width_mm,) if size.face_centre_mm is None else bounds(size.face_centre_mm):
        low, high = centre_mm - 0.5 * length_mm, centre_mm + 0.5 * length_mm
        if low < -1e-9 * width_mm or high > width_mm * (1.0 + 1e-9):
            received = f"{length_mm:.6g} mm about {centre_mm:.6g} mm, from {low:.6g} to {high:.6g} mm across the face"
            yield Problem("face_share", received, f"allowed: on the face, 0 to {width_mm:.6g} mm")
            return


def _edge_problems(pair: GearPair, size: IrregularSpalls, width_mm: float) -> Iterator[Problem]:
    across_mm = _longest_face_mm(size, width_mm)
    shortest, longest = bounds(size.profile_length_mm)
    waves = WAVE_LIMIT * bounds(size.waviness)[1]
    least, most = bounds(size.skew_mm_per_10mm)
    apart = most - least
    room = 2.0 * shortest * (1.0 - 2.0 * waves) / (PER_10MM * across_mm)
    if apart >= room:
        key, skew, at_face = "skew_mm_per_10mm", number_text(size.skew_mm_per_10mm), f"{across_mm:.6g} mm of face"
        received, narrower = (
            f"{skew}: the edges of {shortest:.6g} mm cross",
            f"a range of less than {room:.6g} mm per 10 mm",
        )
        if key in size.model_fields_set:
            yield Problem(key, received, f"allowed: {narrower}, over {at_face}")
        else:  # the default, which nobody wrote
            received = f"{number_text(size.profile_length_mm)} mm: over {at_face} its edges, with {key} {skew}, cross"
            allowed = f"allowed: above {shortest * apart / room:.6g} mm, or {key} with {narrower}"
            yield Problem("profile_length_mm", received, allowed)
        return
    reach = 0.5 * PER_10MM * across_mm * max(abs(least), abs(most)) + waves * longest
    yield from _height_problems(pair, size, MM * (0.5 * longest + reach))


def _height_problems(pair: GearPair, size: IrregularSpalls, reach_m: float) -> Iterator[Problem]:
    """Yield a middle or an edge off the flank, else a floor deeper than the tooth allows."""
    gear, reading = pair.member(Side(size.gear)), ARC
    foot, tip = flank_heights(gear)
    ends = [MM * value for value in (read_m(gear, foot, reading) / MM, read_m(gear, tip, reading) / MM)]
    for height in _heights_m(pair, size):
        if not foot <= height <= tip:
            received = f"a middle {height / MM:.6g} mm above the base circle, along the tooth's axis"
            yield Problem("centre_height_mm", received, f"allowed: {foot / MM:.6g} to {tip / MM:.6g} mm, the flank")
            return
        along = read_m(gear, height, reading)
        if along - reach_m < ends[0] or along + reach_m > ends[1]:
            received = f"{number_text(size.profile_length_mm)} mm: with skew and waves the edges reach from "
            received += f"{(along - reach_m) / MM:.4g} to {(along + reach_m) / MM:.4g} mm above the base circle"
            yield Problem(
                "profile_length_mm", received, f"allowed: {ends[0] / MM:.4g} to {ends[1] / MM:.4g} mm, the flank"
            )
            return
        heights = axial_m(gear, along - reach_m, reading), axial_m(gear, along + reach_m, reading)
        spall = FlankSpall(Side(size.gear), 0, rectangle(heights, (0.0, pair.face_width_m)), _deepest_m(pair, size))
        for problem in single_problems(pair, (spall,)):
            if problem.name == "depth_m":
                yield _depth_problem(size, problem.received, f"allowed: {problem.allowed}")
                return


def _depth_problem(size: IrregularSpalls, received: str, allowed: str) -> Problem:
    if size.depth_mm is not None:
        return Problem("depth_mm", f"{number_text(size.depth_mm)} mm: its rough floor reaches {received}", allowed)
    follows = f"a depth of {received} follows from profile and face length ({DEPTH_SHARE:g} of the root of both)"
    return Problem("profile_length_mm", f"{number_text(size.profile_length_mm)} mm: {follows}", f"depth {allowed}")


def _heights_m(pair: GearPair, size: IrregularSpalls) -> list[float]:
    centre = size.centre_height_mm
    values = (centre,) if isinstance(centre, str) else dict.fromkeys(bounds(centre))
    return [_middle_height_m(pair, size.model_copy(update={"centre_height_mm": value})) for value in values]


def _deepest_m(pair: GearPair, size: IrregularSpalls) -> float:
    rough = 1.0 + sqrt(3.0) * FLOOR_ROUGHNESS
    if size.depth_mm is not None:
        return MM * bounds(size.depth_mm)[1] * rough
    area = bounds(size.profile_length_mm)[1] * _longest_face_mm(size, pair.face_width_m / MM)
    return MM * DEPTH_SHARE * sqrt(area) * rough


# One listed irregular spall: its very outline, station by station, as a user or a life writes it.

EdgePoint = Annotated[
    tuple[Real, Real, Real],
    AllowedText("three numbers in mm: [place across the face, height of the lower edge, height of the upper edge]"),
]


class ListedIrregular(Section):
    """One irregular spall with a flat floor at a given place."""

    gear: AnyGear = Field(default=PINION, description=DAMAGED_GEAR)
    tooth: Annotated[Whole, Field(ge=0)] = Field(default=0, description="index of the tooth, from 0")
    edges_mm: Annotated[tuple[EdgePoint, ...], Field(min_length=2)] = Field(
        description="[place across the face, ascending; heights of lower and upper edge above the base circle]"
    )
    depth_mm: Annotated[Real, Field(gt=0)] = Field(description=DEPTH)
    edge_radius_mm: Annotated[Real, Field(ge=0, le=1)] = Field(description=EDGE_RADIUS)

    def spall(self, pair: GearPair, reading: str) -> IrregularSpall:
        """Return the spall on the flank of a drawn gear, its heights as a reading measures them."""
        face, low, high = MM * np.array(self.edges_mm).T
        gear = pair.member(Side(self.gear))
        edges = (axial_heights_m(gear, edge, reading) for edge in (low, high))
        stations = tuple(zip(face.tolist(), *(edge.tolist() for edge in edges), strict=True))
        depths = (MM * self.depth_mm,) * (len(stations) - 1)
        return IrregularSpall(Side(self.gear), self.tooth, stations, depths, MM * self.edge_radius_mm)

    @property
    def probe_depths_m(self) -> tuple[float, ...]:
        """Depths of its strips for a check of its place alone [m]."""
        return (PROBE_M,) * (len(self.edges_mm) - 1)

    def problems(self, pair: GearPair, reading: str, prefix: str) -> Iterator[Problem]:
        """Yield edges that do not ascend or that cross, else what is wrong with its place."""
        for number, (one, two) in enumerate(pairwise(self.edges_mm), start=1):
            if not (isfinite(two[0]) and two[0] > one[0]):
                yield Problem(
                    f"{prefix}edges_mm.{number}", f"{two[0]:g} mm", f"allowed: beyond {one[0]:g} mm, ascending"
                )
                return
        for number, (_, low, high) in enumerate(self.edges_mm):
            if low > high:
                received = f"a lower edge at {low:g} mm above the upper one at {high:g} mm"
                yield Problem(f"{prefix}edges_mm.{number}", received, "allowed: edges that do not cross")
                return
        spall = self.model_copy(update={"tooth": 0}).spall(pair, reading)
        for problem in damage_problems(pair, (spall,)):
            if problem.name != "contact":
                key = "depth_mm" if problem.name == "depth_m" else "edges_mm"
                yield Problem(prefix + key, problem.received, f"allowed: {problem.allowed}")
