"""Outline of one damage on the flank, to scale: the only thing that drawing needs to know about its shape."""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.gears.damage.outlines import Outline


def outline_mm(outline: Outline, points: int = 181) -> FloatArray:
    """Return the corners of a closed outline (n, 2): face coordinate and height above the base circle [mm].

    The height is along the tooth's centre line, as in the configuration. Not clipped to the flank. A smooth outline is
    a polygon on it; the first corner is not repeated.

    Source: paper A, section 2.1 (ellipses); polygons derived.
    """
    return 1e3 * outline.drawn_m(points)[:, ::-1]
