"""Shaft: how thick the shafts of a rig are, which bearings they stand on, and how far apart these are.

Sized for what the gears bear (`rating`), or the torque that is asked for where that is more. The shaft end bears it at
20 N/mm² in torsion. Each bearing's seat is one step of the catalogue thicker than the end, and the seat of the gear,
which is the piece between the bearings, one more: a bearing rests on a shoulder. Where balls would not last in all
of them, all have rollers. Thinner are they where only then
the bearings stand side by side, and where a pinion is cut from its shaft, 0.9 of its root circle.
"""

from __future__ import annotations

from math import cos, pi, radians
from typing import NamedTuple

from siggen.rig.bearings import BORES_MM, LEAST_LIFE_H, BearingSize, bearing_from, bearing_like, life_h, step_above_mm
from siggen.rig.rating import rated_torque_nm
from siggen.rig.rig import Rig

SHEAR_N_MM2 = 20.0
"""Allowed in a shaft that also bends; a usual value for a first size."""
LARGEST_BORE = 0.6
"""Diameter of a bore over that of the root circle."""
LARGEST_SHAFT = 0.9
"""Diameter of a shaft from which a pinion is cut, over that of its root circle: the hob runs out above it."""
WALL_GAP_MM = 20.0
"""From the face of the gear to the near end of a bearing: 10 mm to the wall, 10 mm of wall (usual; second-hand)."""


class ShaftSize(NamedTuple):
    """One shaft of a rig.

    `bore_mm`: of its gear, at most 0.6 of the root circle; `diameter_mm`: between the bearings; `span_mm`: between the
    middles of both bearings.
    """

    bore_mm: float
    diameter_mm: float
    bearing: BearingSize
    span_mm: float


def shafts(rig: Rig) -> tuple[ShaftSize, ShaftSize]:
    """Return the shafts of pinion and gear: as thick as the given bores, or of the catalogue's sizes."""
    if rig.bores_mm is not None:
        first, second = (_given(bore_mm, rig.face_width_mm) for bore_mm in rig.bores_mm)
        return first, second
    thicker, thinner = _sizes(rig, 1), _sizes(rig, 0)
    sizes = thinner if _stand_side_by_side(rig, thinner) and not _stand_side_by_side(rig, thicker) else thicker
    span_mm = rig.face_width_mm + 2.0 * WALL_GAP_MM + max(bearing.width_mm for _, bearing in sizes)
    first, second = (
        ShaftSize(min(thick_mm, LARGEST_BORE * root_diameter_mm(rig, i)), thick_mm, bearing, span_mm)
        for i, (thick_mm, bearing) in enumerate(sizes)
    )
    return first, second


def root_diameter_mm(rig: Rig, i: int) -> float:
    """Return the diameter of the root circle of a rig's pinion (0) or gear (1), without profile shift [mm]."""
    return rig.module_mm * (rig.teeth[i] - 2.5)


def shaft_end_mm(torque_nm: float, root_mm: float) -> float:
    """Return the least diameter of a shaft that bears a torque, at least a quarter of the gear's root circle [mm]."""
    return max(float((16e3 * torque_nm / (pi * SHEAR_N_MM2)) ** (1.0 / 3.0)), 0.25 * root_mm)


def _given(bore_mm: float, face_width_mm: float) -> ShaftSize:
    return ShaftSize(bore_mm, bore_mm, bearing_like(bore_mm), face_width_mm + 3.0 * bore_mm)


def _sizes(rig: Rig, steps: int) -> tuple[tuple[float, BearingSize], tuple[float, BearingSize]]:
    """Return diameter and bearing of both shafts, with seats of bearings so many steps above the shaft end."""
    rated = rated_torque_nm(rig.teeth, rig.module_mm, rig.face_width_mm, rig.pressure_angle_deg)
    torque_nm = max(rig.torque_nm[1], rated)
    force_n = 2e3 * torque_nm / (rig.module_mm * rig.teeth[0] * cos(radians(rig.pressure_angle_deg)))
    ratios = [teeth / rig.teeth[0] for teeth in rig.teeth]
    sizes = [_size(torque_nm * ratio, root_diameter_mm(rig, i), steps) for i, ratio in enumerate(ratios)]
    balls_last = all(
        life_h(bearing, 0.5 * force_n, rig.speed_hz[1] / ratio) >= LEAST_LIFE_H
        for (_, bearing), ratio in zip(sizes, ratios, strict=True)
    )
    first, second = ((thick_mm, bearing._replace(rollers=not balls_last)) for thick_mm, bearing in sizes)
    return first, second


def _size(torque_nm: float, root_mm: float, steps: int) -> tuple[float, BearingSize]:
    seat_mm = bearing_from(shaft_end_mm(torque_nm, root_mm)).bore_mm
    for _ in range(steps):
        seat_mm = step_above_mm(seat_mm)
    thick_mm = min(step_above_mm(seat_mm), LARGEST_SHAFT * root_mm)
    within = [bore for bore in BORES_MM if bore <= thick_mm]
    thick_mm = float(within[-1]) if within and thick_mm <= BORES_MM[-1] else thick_mm
    return thick_mm, bearing_from(min(seat_mm, thick_mm))


def _stand_side_by_side(rig: Rig, sizes: tuple[tuple[float, BearingSize], tuple[float, BearingSize]]) -> bool:
    return sum(bearing.outer_mm for _, bearing in sizes) < rig.module_mm * sum(rig.teeth)
