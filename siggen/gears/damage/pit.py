"""A pit: an ellipse on the flank with a flat or dished floor.

Source: paper A (Influence of Tooth Pitting on TVMS and Vibration Response of a Spur Gear Pair), sections 2.1 and 3.1:
elliptic cylinders with the semi-axis a along the face and b along the height.
"""

from __future__ import annotations

from dataclasses import dataclass

from siggen.gears.damage.on_flank import OnFlank
from siggen.gears.damage.outlines import Ellipse
from siggen.gears.damage.part import Part
from siggen.names import Side


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
