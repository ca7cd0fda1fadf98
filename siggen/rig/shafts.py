"""Shaft: how thick the shafts of a rig are, which bearings they stand on, and how far apart these are.

Sized for the torque that the rig's maker chose (`RigDesign`), which the shaft end bears in torsion. Each bearing's
seat is one step of the catalogue thicker than the end, and the seat of the gear, which is the piece between the
bearings, one more: a bearing rests on a shoulder. Thinner are they where only then the bearings stand side by side, and
where a pinion is cut from its shaft, 0.9 of its root circle. Where balls of the chosen series would not last, or not
stand side by side, another series has its place, the next heavier one first; where none does, all have rollers.
"""

from __future__ import annotations

from itertools import product
from math import cos, pi, radians
from typing import NamedTuple

from siggen.rig.bearings import (
    BORES_MM,
    LEAST_LIFE_H,
    SIZES_MM,
    BearingSize,
    bearing_from,
    bearing_like,
    life_h,
    step_above_mm,
)
from siggen.rig.rig import Rig, RigDesign

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
    first, second = (
        shaft if span_mm is None else shaft._replace(span_mm=span_mm)
        for shaft, span_mm in zip(_shafts(rig), rig.spans_mm, strict=True)
    )
    return first, second


def _shafts(rig: Rig) -> tuple[ShaftSize, ShaftSize]:
    """Return both shafts, their bearings as near to the gear as walls leave them."""
    if rig.bores_mm is not None:
        first, second = (_given(bore_mm, rig.face_width_mm) for bore_mm in rig.bores_mm)
        return first, second
    sizes = _sizes(rig)
    span_mm = rig.face_width_mm + 2.0 * WALL_GAP_MM + max(bearing.width_mm for _, bearing in sizes)
    first, second = (
        ShaftSize(min(thick_mm, LARGEST_BORE * root_diameter_mm(rig, i)), thick_mm, bearing, span_mm)
        for i, (thick_mm, bearing) in enumerate(sizes)
    )
    return first, second


def root_diameter_mm(rig: Rig, i: int) -> float:
    """Return the diameter of the root circle of a rig's pinion (0) or gear (1), without profile shift [mm]."""
    return rig.module_mm * (rig.teeth[i] - 2.5)


def shaft_end_mm(torque_nm: float, root_mm: float, design: RigDesign) -> float:
    """Return the least diameter of a shaft that bears a torque, at least a quarter of the gear's root circle [mm]."""
    torque_nmm, shear = 1e3 * design.torque_factor * torque_nm, design.shear_n_per_mm2
    return max(float((16.0 * torque_nmm / (pi * shear)) ** (1.0 / 3.0)), 0.25 * root_mm)


def _given(bore_mm: float, face_width_mm: float) -> ShaftSize:
    return ShaftSize(bore_mm, bore_mm, bearing_like(bore_mm), face_width_mm + 3.0 * bore_mm)


Sizes = tuple[tuple[float, BearingSize], tuple[float, BearingSize]]
"""Diameter and bearing of both shafts."""


def _sizes(rig: Rig) -> Sizes:
    own = rig.design.series
    order = [*(one for one in SIZES_MM if one >= own), *(one for one in reversed(SIZES_MM) if one < own)]
    left: Sizes | None = None
    for series, steps in product(order, (1, 0)):
        sizes = _of_series(rig, series, steps)
        if _stand_side_by_side(rig, sizes):
            if _last(rig, sizes):
                return sizes
            left = left or sizes
    first, second = (
        (thick_mm, bearing._replace(rollers=True)) for thick_mm, bearing in left or _of_series(rig, own, steps=1)
    )
    return first, second


def _of_series(rig: Rig, series: int, steps: int) -> Sizes:
    """Return diameter and ball bearing of both shafts, with seats of bearings so many steps above the shaft end."""
    ratio, torque_nm = rig.teeth[1] / rig.teeth[0], rig.torque_nm[1]
    ends = (shaft_end_mm(torque_nm * (ratio if i else 1.0), root_diameter_mm(rig, i), rig.design) for i in range(2))
    first, second = (_size(end, root_diameter_mm(rig, i), series, steps) for i, end in enumerate(ends))
    return first, second


def _size(end_mm: float, root_mm: float, series: int, steps: int) -> tuple[float, BearingSize]:
    seat_mm = bearing_from(end_mm).bore_mm
    for _ in range(steps):
        seat_mm = step_above_mm(seat_mm)
    thick_mm = min(step_above_mm(seat_mm), LARGEST_SHAFT * root_mm)
    within = [bore for bore in BORES_MM if bore <= thick_mm]
    thick_mm = float(within[-1]) if within and thick_mm <= BORES_MM[-1] else thick_mm
    return thick_mm, bearing_from(min(seat_mm, thick_mm), series)


def _last(rig: Rig, sizes: Sizes) -> bool:
    """Tell whether balls last under the largest torque and speed of the rig."""
    force_n = 2e3 * rig.torque_nm[1] / (rig.module_mm * rig.teeth[0] * cos(radians(rig.pressure_angle_deg)))
    turns = (1.0, rig.teeth[0] / rig.teeth[1])
    return all(
        life_h(bearing, 0.5 * force_n, rig.speed_hz[1] * turning) >= LEAST_LIFE_H
        for (_, bearing), turning in zip(sizes, turns, strict=True)
    )


def _stand_side_by_side(rig: Rig, sizes: Sizes) -> bool:
    return sum(bearing.outer_mm for _, bearing in sizes) < rig.module_mm * sum(rig.teeth)
