"""A spall: an ellipse, a rectangle, a V or any polygon on the flank. Derived."""

from __future__ import annotations

from dataclasses import dataclass

from siggen.gears.damage.heights import profile_arc_m
from siggen.gears.damage.on_flank import FLOORS, OnFlank
from siggen.gears.damage.outlines import Outline
from siggen.gears.geometry.spur_gear import SpurGear

SPALL_FLOORS = (*FLOORS, "length_squared")


@dataclass(frozen=True, slots=True)
class Spall(OnFlank):
    """One spall of any outline.

    Parameters
    ----------
    gear : str
        'pinion' or 'gear'.
    tooth : int
        Tooth index, from 0.
    outline : Ellipse or Polygon
        On the flank's plane of height and face.
    depth_m : float
        Depth normal to the tooth's centre plane [m]; of a dish at its deepest.
    floor : str
        'flat'; 'dish': an ellipse's is half an ellipsoid, a polygon's is half an elliptic cylinder with its axis
        across the face, depth sqrt(1 - u^2) with u = -1 and 1 at the polygon's lowest and highest point: like the
        flank that rolls over it, such a floor is curved along the profile and straight across the face;
        'length_squared': flat, its depth set by `length_squared_depth_m`.
    """

    gear: str
    tooth: int
    outline: Outline
    depth_m: float
    floor: str = "flat"

    @property
    def kind(self) -> str:
        """Kind of damage."""
        return "spall"

    @property
    def floors(self) -> tuple[str, ...]:
        """Floors that a spall can have."""
        return SPALL_FLOORS


def length_squared_depth_m(gear: SpurGear, outline: Outline, depth_per_square_length_per_m: float) -> float:
    """Return the depth c l^2 of a spall whose arc along the involute, clipped to the flank, is l [m].

    Measured spalls of growing length follow c = 16.3 um/mm^2 = 16.3 1/m.
    """
    return depth_per_square_length_per_m * profile_arc_m(gear, outline) ** 2
