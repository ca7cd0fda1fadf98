"""A spall: an ellipse, a rectangle or any polygon on the flank. Derived."""

from __future__ import annotations

from dataclasses import dataclass

from siggen.gears.damage.on_flank import FLOORS, OnFlank
from siggen.gears.damage.outlines import Outline
from siggen.names import Side


@dataclass(frozen=True, slots=True)
class FlankSpall(OnFlank):
    """One spall of any outline.

    Parameters
    ----------
    gear : Side
        Its gear.
    tooth : int
        Tooth index, from 0.
    outline : Ellipse or Polygon
        On the flank's plane of height and face.
    depth_m : float
        Depth normal to the tooth's centre plane [m]; of a dish at its deepest.
    floor : str
        'flat'; 'dish': an ellipse's is half an ellipsoid, a polygon's is half an elliptic cylinder with its axis
        across the face, depth sqrt(1 - u^2) with u = -1 and 1 at the polygon's lowest and highest point: like the
        flank that rolls over it, such a floor is curved along the profile and straight across the face.
    """

    gear: Side
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
        return FLOORS
