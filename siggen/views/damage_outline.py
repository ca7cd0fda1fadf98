"""Outline of one damage on the flank, to scale: the only thing that drawing needs to know about its shape."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.damage.flank_damage import Pit, Spall
from siggen.gears.damage.outlines import Polygon


def outline_mm(damage: Pit | Spall, points: int = 181) -> FloatArray:
    """Return the corners of a closed outline (n, 2): face coordinate and height above the base circle [mm].

    The height is along the tooth's centre line, as in the configuration. Not clipped to the flank. A smooth outline is
    a polygon on it; the first corner is not repeated.

    Source: paper A, section 2.1 (ellipses); polygons derived.
    """
    outline = damage.outline
    if isinstance(outline, Polygon):
        return 1e3 * np.array(outline.vertices_m)[:, ::-1]
    turn = 2.0 * np.pi * np.arange(points) / points
    face = outline.face_m + outline.semi_axis_face_m * np.cos(turn)
    height = outline.height_m + outline.semi_axis_profile_m * np.sin(turn)
    return 1e3 * np.stack([face, height], axis=1)
