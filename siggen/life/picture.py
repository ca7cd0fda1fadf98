"""Pictures of flanks, as a camera above the involute would take them after each run: grey PNG, pits dark.

Assumed: land is of one grey, pits are darker the deeper they are, and no light changes. So all teeth without a pit
share one picture, byte by byte. A pixel that is pitted in part is grey in part. Source of the format: PNG specification
(W3C).
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import numpy as np

from siggen.life.flank import Flank
from siggen.life.outline import Edges

PIXEL_M = 5e-5
"""Across the face and along the flank [m]."""
LAND, SHALLOW, DEEP = 200, 110, 30
"""Greys of land, and of pits of no depth and of `DEEP_M`."""
DEEP_M = 3e-4


def flank_png(flank: Flank, outlines: Sequence[Edges], depths_m: Sequence[float]) -> bytes:
    """Return the picture of a flank with pits, the tip above, from where contact begins."""
    return _png(np.rint(_greys(flank, outlines, depths_m)).astype(np.uint8))


def _greys(flank: Flank, outlines: Sequence[Edges], depths_m: Sequence[float]) -> np.ndarray:
    """Return the greys (rows, columns); where pits overlap, the darkest one is seen."""
    columns = np.arange(round(flank.face_m / PIXEL_M))
    rows = np.arange(round((flank.tip_arc_m - flank.active_arc_m) / PIXEL_M))
    face_m = PIXEL_M * (columns + 0.5)
    arc_m = flank.tip_arc_m - PIXEL_M * (rows[:, np.newaxis] + 0.5)
    greys = np.full((rows.size, columns.size), float(LAND))
    for one, depth_m in zip(outlines, depths_m, strict=True):
        low = np.interp(face_m, one.face_m, one.low_m, np.inf, np.inf)
        high = np.interp(face_m, one.face_m, one.high_m, -np.inf, -np.inf)
        top, bottom = np.minimum(high, arc_m + 0.5 * PIXEL_M), np.maximum(low, arc_m - 0.5 * PIXEL_M)
        share = np.clip((top - bottom) / PIXEL_M, 0.0, 1.0)
        floor = SHALLOW + (DEEP - SHALLOW) * min(depth_m / DEEP_M, 1.0)
        greys = np.minimum(greys, LAND + share * (floor - LAND))
    return greys


def _png(greys: np.ndarray) -> bytes:
    """Return a PNG of greys (rows, columns) of 8 bits."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    rows, columns = greys.shape
    head = struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)
    lines = np.concatenate([np.zeros((rows, 1), np.uint8), greys], axis=1).tobytes()
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b"")
