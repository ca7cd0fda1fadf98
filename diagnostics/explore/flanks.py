"""Damaged flanks of a record to scale: face width, ends of the flank, and the outline of every pit or spall."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import acos, cos, pi, radians, tan
from typing import Any

import numpy as np

ELLIPSE_CORNERS = 48
DIGITS = 3


def flank_size(
    module_mm: object, pressure_angle_deg: object, face_width_mm: object, profile_shift: object, teeth: int
) -> dict[str, float] | None:
    """Return face width and heights of pitch circle and tip above the flank's point on the base circle [mm].

    Heights lie along the tooth's axis, as in the table of damage: r cos(g_r) - R_b cos(g_b) with the half tooth angle
    g_r = pi/2z + 2 x tan(alpha)/z + inv(alpha) - inv(alpha_r). Source: derived from the involute.

    Returns
    -------
    dict or None
        None where the configuration draws one of these numbers.
    """
    numbers = module_mm, pressure_angle_deg, face_width_mm, profile_shift
    plain = [number for number in numbers if isinstance(number, float)]
    if len(plain) < len(numbers):
        return None
    module, degrees, face, shift = plain
    alpha, tip, pitch = radians(degrees), module * (teeth / 2 + 1.0 + shift), module * teeth / 2
    base = pitch * cos(alpha)
    half = pi / (2 * teeth) + 2 * shift * tan(alpha) / teeth + tan(alpha) - alpha

    def height_mm(radius: float) -> float:
        slope = acos(base / radius)
        return round(radius * cos(half - (tan(slope) - slope)) - base * cos(half), DIGITS)

    return {"face_mm": face, "pitch_mm": height_mm(pitch), "tip_mm": height_mm(tip)}


def outlines(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the damage of a record: gear, tooth, kind, depth, and corners (face, height) of the outline [mm]."""
    return [
        {
            "gear": row["gear"],
            "tooth": row["tooth"],
            "kind": row["kind"],
            "depth_mm": round(float(row["depth_mm"]), DIGITS),
            "corners": _corners(row),
        }
        for row in rows
    ]


def _corners(row: Mapping[str, Any]) -> list[list[float]]:
    face, height = np.asarray(row["polygon_face_mm"], float), np.asarray(row["polygon_height_mm"], float)
    if face.size == 0:
        angle = 2.0 * np.pi * np.arange(ELLIPSE_CORNERS) / ELLIPSE_CORNERS
        face = row["face_mm"] + row["semi_axis_face_mm"] * np.cos(angle)
        height = row["height_mm"] + row["semi_axis_profile_mm"] * np.sin(angle)
    corners: list[list[float]] = np.round(np.stack([face, height], axis=1), DIGITS).tolist()
    return corners
