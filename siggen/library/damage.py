"""Kinds of damage that a user composes: on gears and bearings, in mm, at places of the user's choice."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, fields
from numbers import Integral
from typing import Any, NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.crack_law import DEEPEST_SHARE
from siggen.damage.pits import clustered_centres, layered_centres
from siggen.gears.gear_pair import Gear, GearPair
from siggen.gears.spur_gear import root_chord
from siggen.library.arguments import finite, of_kind, refused, saying
from siggen.names import PINION, Side
from siggen.seeding import Stream, generator

__all__ = [
    "BearingSpall",
    "Chip",
    "Crack",
    "Damage",
    "Pit",
    "Spall",
    "Wear",
    "all_damages",
    "entries",
    "pits_in_layers",
    "random_pits",
]

Number = int | float


@dataclass(frozen=True)
class Damage:
    """Base of all damage, and of your own: a frozen dataclass with the method `missing_m`.

    `on` and `tooth` come from here; `State` takes it as any other. What it does beside taking material of a flank, such
    as softening its tooth or a force in a bearing, is not asked for yet.

    Attributes
    ----------
    on : str
        A gear, or the bearing of a shaft.
    tooth : int
        Index of the damaged tooth, from 0.
    """

    on: str = PINION
    tooth: int = 0

    def missing_m(self, gear: Gear, profile_m: FloatArray, face_m: FloatArray) -> FloatArray:  # noqa: ARG002
        """Return the depth of material that is missing from the flank at points (n,), (n,) [m]: none of the base.

        Parameters
        ----------
        gear : Gear
        profile_m : (n,)
            Heights above the base circle, along the tooth's axis [m].
        face_m : (n,)
            Places across the face, from one end [m].

        Source: the mate rests on what is left as a rigid parabola of the relative radius, and the load spreads over the
        face (derived). Shapes that vary slowly over the contact's width, about 0.2 mm, are met exactly; how a contact
        narrows at sharp edges is known to `Pit` and `Spall` alone.
        """
        return np.zeros_like(profile_m)

    @property
    def is_shape(self) -> bool:
        """Whether it is a kind of the user's own, given by `missing_m`."""
        return type(self).missing_m is not Damage.missing_m


@dataclass(frozen=True)
class Pit(Damage):
    """An elliptic pit on a flank (paper A, section 2.1).

    Attributes
    ----------
    on : str
        A gear.
    tooth : int
    height_mm : float or None
        Of its middle above the base circle, along the tooth's axis [mm]; None: the pitch line.
    face_mm : float or None
        Place of its middle across the face, from one end [mm]; None: the middle of the face.
    semi_axes_mm : (float, float)
        Across the face and along the profile [mm].
    depth_mm : float
        [mm]
    dish : bool
        Whether its floor is deepest in the middle, else it is flat.
    offset_mm : float
        What its place across the face is beside `face_mm` [mm].
    """

    height_mm: float | None = None
    face_mm: float | None = None
    semi_axes_mm: tuple[float, float] = (0.3, 0.2)
    depth_mm: float = 0.2
    dish: bool = False
    offset_mm: float = 0.0

    def _entry(self, seat: DamagedPlace) -> dict[str, Any]:
        middle = 5e2 * seat.pair.face_width_m if self.face_mm is None else self.face_mm
        axes = self.semi_axes_mm
        if not isinstance(axes, Sequence) or len(axes) != 2:
            raise refused("semi_axes_mm", repr(axes), "two numbers in mm, across the face and along the profile")
        across, along = axes
        return {
            "gear": seat.word, "tooth": self.tooth, "height_mm": "pitch" if self.height_mm is None else self.height_mm,
            "face_mm": middle + self.offset_mm, "semi_axis_face_mm": across, "semi_axis_profile_mm": along,
            "depth_mm": self.depth_mm, "floor": "dish" if self.dish else "flat",
        }  # fmt: skip


@dataclass(frozen=True)
class Spall(Damage):
    """A spall of any outline with a flat floor.

    Attributes
    ----------
    on : str
        A gear.
    tooth : int
    outline_mm : sequence of (float, float)
        Corners in order: height above the base circle along the tooth's axis, place across the face [mm]. Lines along
        the profile cross it once.
    depth_mm : float
        [mm]
    edge_radius_mm : float
        Of its edges; 0: sharp [mm].
    """

    outline_mm: Sequence[tuple[float, float]] = ()
    depth_mm: float = 0.3
    edge_radius_mm: float = 0.1

    def _entry(self, seat: DamagedPlace) -> dict[str, Any]:
        return {
            "gear": seat.word, "tooth": self.tooth, "edges_mm": _stations_mm(self.outline_mm),
            "depth_mm": self.depth_mm, "edge_radius_mm": self.edge_radius_mm,
        }  # fmt: skip


@dataclass(frozen=True)
class Crack(Damage):
    """A crack in the root of a tooth.

    Attributes
    ----------
    on : str
        A gear.
    tooth : int
    depth_mm : float
        Along the crack, the same over the face [mm].
    angle_deg : float
        Between the crack and the tooth's centre line [degrees].
    """

    depth_mm: float = 1.0
    angle_deg: float = 45.0

    def _entry(self, seat: DamagedPlace) -> dict[str, Any]:
        chord_mm = 1e3 * root_chord(seat.pair.member(seat.side)).length_m
        allowed = f"above 0 up to {DEEPEST_SHARE * chord_mm:.4g}, {DEEPEST_SHARE:g} of the root's chord"
        share = finite("depth_mm", self.depth_mm, allowed, 1e-9, DEEPEST_SHARE * chord_mm) / chord_mm
        return {
            "kind": "crack", "gear": seat.word, "teeth": [self.tooth], "depth_share": share, "angle_deg": self.angle_deg
        }  # fmt: skip


@dataclass(frozen=True)
class Chip(Damage):
    """A tooth without its tip, over the face or a part of it.

    Attributes
    ----------
    on : str
        A gear.
    tooth : int
    height_mm : float or None
        What is lost from the tip down, along the radius [mm]; None: the tooth is gone.
    width_mm : float or None
        From the end of the face at 0 [mm]; None: the whole face.
    """

    height_mm: float | None = 1.0
    width_mm: float | None = None

    def _entry(self, seat: DamagedPlace) -> dict[str, Any]:
        share, face_mm = None, 1e3 * seat.pair.face_width_m
        if self.width_mm is not None:
            share = finite("width_mm", self.width_mm, f"above 0 up to {face_mm:g}, the face", 1e-9, face_mm) / face_mm
        height = "whole" if self.height_mm is None else self.height_mm
        return {"kind": "chip", "gear": seat.word, "teeth": [self.tooth], "height_mm": height, "face_share": share}


@dataclass(frozen=True)
class Wear(Damage):
    """Worn flanks of all teeth of the first mesh, after Archard under a steady load.

    Attributes
    ----------
    depth_um : float
        Largest depth, of all flanks of both gears [µm].
    """

    on: str = field(default=PINION, init=False, repr=False)
    tooth: int = field(default=0, init=False, repr=False)
    depth_um: float = 10.0

    def _entry(self, seat: DamagedPlace) -> dict[str, Any]:  # noqa: ARG002
        return {"kind": "wear", "depth_um": self.depth_um}


@dataclass(frozen=True)
class BearingSpall(Damage):
    """A spall in a ball bearing of one of the first two shafts.

    Attributes
    ----------
    on : str
        The bearing, such as `input.bearing`.
    element : str
        'outer', 'inner' or 'ball'.
    length_mm, depth_mm : float
        Along the path of the balls, and normal to it [mm].
    """

    on: str = "input.bearing"
    tooth: int = field(default=0, init=False, repr=False)
    element: str = "outer"
    length_mm: float = 2.0
    depth_mm: float = 0.1

    def _entry(self, seat: DamagedPlace) -> dict[str, Any]:
        return {
            "kind": "bearing_spall", "bearing": seat.word, "element": self.element, "length_mm": self.length_mm,
            "depth_mm": self.depth_mm,
        }  # fmt: skip


class DamagedPlace(NamedTuple):
    """Where a damage is: a pair and one of its gears, and the word of a file for gear or bearing."""

    pair: GearPair
    side: Side
    word: str

    @property
    def gear(self) -> Gear:
        """The damaged gear as a drawing states it."""
        return self.pair.driver if self.side == Side.DRIVER else self.pair.driven


LISTS = {Pit: "pits", Spall: "outlines"}
"""Kinds that stand together in one section, and their key there."""


def all_damages(damages: object) -> tuple[Damage, ...]:
    """Return damages that all are some.

    Raises
    ------
    UsageError
        If these are no sequence, or one is no damage.
    """
    allowed = "a sequence of Pit, Spall, Crack, ..., or of a class of Damage with missing_m"
    found: tuple[Damage, ...] = tuple(of_kind("damages", damages, Iterable, allowed))  # type: ignore[type-abstract]
    for number, one in enumerate(found):
        if not isinstance(one, Damage) or type(one) is Damage:
            raise refused(f"damages[{number}]", repr(one), allowed)
    return found


def _check_numbers(one: Damage, seat: DamagedPlace) -> None:
    """Refuse a tooth that there is not, and what is no number where one belongs."""
    if not isinstance(one, (Wear, BearingSpall)):
        last = seat.gear.teeth - 1
        allowed = f"a whole number from 0 to {last}"
        tooth = of_kind("tooth", one.tooth, Integral, allowed)  # type: ignore[type-abstract]
        finite("tooth", tooth, allowed, 0, last)
    for own in () if one.is_shape else fields(one):
        value = getattr(one, own.name)
        if own.default is None or type(own.default) is float:
            finite(own.name, 0.0 if value is None else value, "a number")


def entries(
    damages: Iterable[Damage], seat_of: Callable[[Damage], DamagedPlace]
) -> tuple[list[dict[str, Any]], dict[str, str]]:
    """Return damages as a file writes them, without those of the user's own kinds, and where one is -> its argument.

    Raises
    ------
    UsageError
        If one is no damage, or on a tooth that there is not.
    """
    found: list[dict[str, Any]] = []
    listed: dict[str, dict[str, Any]] = {}
    arguments: dict[str, str] = {}
    for number, one in enumerate(all_damages(damages)):
        with saying({"": f"damages[{number}]."}):
            seat = seat_of(one)
            _check_numbers(one, seat)
            if one.is_shape:
                continue
            entry, place = one._entry(seat), str(len(found))  # type: ignore[attr-defined]
        if key := LISTS.get(type(one)):
            if seat.word not in listed:
                listed[seat.word] = {"kind": "list"}
                found.append(listed[seat.word])
            section = listed[seat.word]
            place = f"{found.index(section)}.{key}.{len(section.setdefault(key, []))}"
            section[key].append(entry)
        else:
            found.append(entry)
        arguments[place] = f"damages[{number}]"
    return found, arguments


def pits_in_layers(
    on: str,
    *,
    layers: int,
    pits_per_layer: int,
    first_height_mm: float | None = None,
    semi_axes_mm: tuple[float, float] = (0.3, 0.2),
    depth_mm: float = 0.4,
    spacing_face_mm: float = 1.0,
    spacing_profile_mm: float = 0.4,
    face_centre_mm: float | None = None,
    tooth: int = 0,
) -> tuple[Pit, ...]:
    """Return rows of equal pits from the middle of the face outwards (paper A, section 2.1).

    Parameters
    ----------
    on, tooth, semi_axes_mm, depth_mm
        As of `Pit`.
    layers, pits_per_layer : int
        Rows, and pits of each.
    first_height_mm : float
        Of the first row above the base circle [mm].
    spacing_face_mm, spacing_profile_mm : float
        Between pits of a row, and between rows [mm].
    face_centre_mm : float or None
        Middle of the rows across the face [mm]; None: of the face.
    """
    for name, value in (("layers", layers), ("pits_per_layer", pits_per_layer)):
        finite(name, value, "1 to 1000", 1, 1000)
    first = finite("first_height_mm", first_height_mm, "a height above the base circle in mm")
    centres = layered_centres(layers, pits_per_layer, spacing_face_mm, spacing_profile_mm, first, 0.0)
    return tuple(
        Pit(on, tooth, height, face_centre_mm, semi_axes_mm, depth_mm, offset_mm=offset)
        for height, offset in zip(*(values.tolist() for values in centres), strict=True)
    )


def random_pits(on: str, gear: Gear, *, count: int, seed: int, tooth: int = 0) -> tuple[Pit, ...]:
    """Return pits scattered round the pitch line: heights normal, places across the face even.

    Sizes are those of the preset `bench`, in proportion to the module: semi-axes of a tenth and a fifteenth of it,
    depths up to 0.13 of it (assumed). Fewer pits of a seed are the first ones of more.

    Parameters
    ----------
    on, tooth
        As of `Pit`.
    gear : Gear
        Such as `pair.driver`.
    count, seed : int
    """
    finite("count", count, "1 to 1000", 1, 1000)
    places, sizes = (generator(seed, Stream.DAMAGE, 0, i) for i in range(2))
    module = 1e3 * gear.module_m
    centres = clustered_centres(places, count, 1e3 * gear.pitch_height_m, 0.1 * module, 0.0, 1e3 * gear.face_width_m)
    shares = sizes.uniform((0.067, 0.033, 0.033), (0.133, 0.1, 0.133), (count, 3)) * module
    return tuple(
        Pit(on, tooth, height, face, (across, along), depth, dish=True)
        for height, face, (across, along, depth) in zip(*(v.tolist() for v in centres), shares.tolist(), strict=True)
    )


def _stations_mm(outline_mm: Sequence[tuple[float, float]]) -> list[list[float]]:
    """Return places across the face with the lower and the upper edge there, in order [mm]."""
    try:
        corners = np.array(outline_mm, dtype=np.float64).reshape(-1, 2)
    except ValueError:
        corners = np.empty((0, 2))
    allowed = "three corners or more (height, face) in mm, in order; lines along the profile cross the outline once"
    if len(corners) < 3 or not np.isfinite(corners).all():
        raise refused("outline_mm", repr(outline_mm), allowed)
    (height, face), (behind, beside) = corners.T, np.roll(corners, -1, axis=0).T
    stations = []
    for place in np.unique(face):
        meets = (np.minimum(face, beside) <= place) & (place <= np.maximum(face, beside))
        share = np.divide(place - face, beside - face, out=np.zeros_like(face), where=beside != face)
        met = np.concatenate([(height + share * (behind - height))[meets], height[face == place]])
        stations.append([float(place), float(met.min()), float(met.max())])
    at, low, high = np.array(stations).T
    area = 0.5 * abs(float(np.sum(height * beside - behind * face)))
    if not np.isclose(area, np.trapezoid(high - low, at), rtol=1e-6):
        raise refused("outline_mm", "an outline that crosses itself or a line along the profile twice", allowed)
    return stations
