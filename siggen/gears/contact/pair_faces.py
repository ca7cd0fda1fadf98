"""FaceSlices of a tooth pair at its contact positions, from geometry, gaps, lead and compliance."""

from __future__ import annotations

from math import cos, pi
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.contact.covered_slice import spread_of_cells
from siggen.gears.contact.face_gaps import FaceGaps
from siggen.gears.contact.face_slices import FaceSlices
from siggen.gears.contact.line_kernel import kernel_family, line_kernels
from siggen.gears.contact.pair_rest import PairRest
from siggen.gears.contact.table_options import half_width
from siggen.gears.contact.tooth_kernel import ToothKernel, tooth_kernel, unit_tooth
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.hertz import centre_line_depth
from siggen.names import Side


class FaceOptions(NamedTuple):
    """How contacts across the face are reckoned.

    `line_load_n_per_m`: a typical load, which sets from which depth slices count as not carrying; `edge_radius_m`: of
    the edges of damage, 0 for sharp ones; `coupled`: whether slices act on each other.
    """

    line_load_n_per_m: float
    edge_radius_m: float = 0.0
    coupled: bool = True


def contact_kappa(pair: GearPair) -> float:
    """Return κ = 2/(π E*) = 4 (1 - ν²)/(π E) of gears of one material [1/Pa]; over cos β_b in the transverse plane."""
    return 4.0 * (1.0 - pair.poisson_ratio**2) / (pi * pair.youngs_modulus_pa) / cos(pair.base_helix_rad)


def pair_faces(
    pair: GearPair,
    gaps: FaceGaps,
    position_m: FloatArray,
    rest: PairRest,
    options: FaceOptions,
    lead_m: FloatArray | None = None,
    radii_m: FloatArray | None = None,
    rough: FloatArray | None = None,
) -> list[FaceSlices]:
    """Return the slices at positions s (k,) [m].

    Parameters
    ----------
    pair : GearPair
    gaps : FaceGaps
        At these positions, (k, n).
    position_m : (k,)
    rest : PairRest
        Compliance of the pair without its contact, (k,).
    options : FaceOptions
    lead_m : (n,), (k, n) or None
        Missing material across the face, of any sign; None: none.
    radii_m : (k, n) or None
        Relative radii of curvature of the slices [m]; None: as in the middle.
    rough : (k, n) or None
        Parts of slices that are rough land; None: none.

    Raises
    ------
    ValueError
        If the arrays do not fit.
    """
    count = gaps.left_m.shape[1]
    if gaps.left_m.shape[0] != position_m.size or rest.rigid_m_per_n.shape != position_m.shape:
        raise ValueError(
            f"gaps at {gaps.left_m.shape[0]} and compliances at {rest.rigid_m_per_n.size} positions; "
            f"allowed: as many as positions ({position_m.size})"
        )
    leads = np.zeros(count) if lead_m is None else np.ascontiguousarray(lead_m, dtype=np.float64)
    if leads.shape not in ((count,), (position_m.size, count)):
        raise ValueError(f"lead_m: received shape {leads.shape}; allowed: ({count},), one for each slice")
    cell = pair.face_width_m / count
    face = cell * (np.arange(count) + 0.5) - 0.5 * pair.face_width_m
    rolls = {Side.DRIVER: position_m / pair.pinion.base_radius_m}
    rolls[Side.DRIVEN] = (pair.line_of_action_m - position_m) / pair.gear.signed_base_radius_m
    first, second = (centre_line_depth(pair, side, roll) for side, roll in rolls.items())
    depth = np.sqrt(first * second)
    radius = position_m * (pair.line_of_action_m - position_m) / pair.line_of_action_m
    kappa = contact_kappa(pair)
    unit = unit_tooth(count, pair.face_width_m, rest.length_m)
    spread = spread_of_cells(cell / _reference_width(pair))
    family = kernel_family(count, cell, _typical_depth(pair))
    kernels = line_kernels(family, depth, pair.poisson_ratio, coupled=options.coupled)
    lengths = carrying_length(gaps, leads, cell, radius, kappa * options.line_load_n_per_m)
    out = []
    for i in range(position_m.size):
        here = FaceGaps(*(np.ascontiguousarray(array[i]) for array in gaps))
        slices = FaceSlices(
            left_m=here.left_m,
            right_m=here.right_m,
            notch_m=here.notch_m,
            floor_m=here.floor_m,
            rough=np.zeros(count) if rough is None else np.ascontiguousarray(rough[i]),
            covered=here.covered,
            lead_m=leads if leads.ndim == 1 else leads[i],
            face_m=face,
            tips_m=here.tips_m,
            spread=spread,
            kernel=kernels[i],
            teeth=_teeth(unit, rest, i, pair.face_width_m, kappa),
            radius_m=float(radius[i]),
            radii_m=np.full(count, radius[i]) if radii_m is None else np.ascontiguousarray(radii_m[i]),
            rounding_m=options.edge_radius_m,
            kappa_per_pa=kappa,
            compliance_m_per_n=float(rest.rigid_m_per_n[i]),
            carrying_m=float(lengths[i]),
        )
        out.append(slices)
    return out


def _teeth(unit: ToothKernel, rest: PairRest, i: int, face_width_m: float, kappa_per_pa: float) -> ToothKernel:
    """Return how the teeth give way at position i."""
    if rest.uneven is not None:
        return rest.uneven.kernel(unit, i, face_width_m, kappa_per_pa)
    return tooth_kernel(unit, float(rest.tooth_m_per_n[i]), face_width_m, kappa_per_pa)


def _reference_width(pair: GearPair) -> float:
    """Return Hertz's half width of the reference force in the middle of the path [m]."""
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m)])
    return float(half_width(pair, middle, pair.reference_force_n)[0])


def _typical_depth(pair: GearPair) -> float:
    """Return Weber and Banaschek's depth in the middle of the path [m]."""
    middle = 0.5 * (pair.contact_start_m + pair.contact_end_m)
    rolls = {
        Side.DRIVER: middle / pair.pinion.base_radius_m,
        Side.DRIVEN: (pair.line_of_action_m - middle) / pair.gear.signed_base_radius_m,
    }
    return float(
        np.sqrt(np.prod([float(centre_line_depth(pair, side, np.array([roll]))[0]) for side, roll in rolls.items()]))
    )


def carrying_length(
    gaps: FaceGaps, lead_m: FloatArray, cell_m: float, radius_m: FloatArray, load_m: float
) -> FloatArray:
    """Return L (...,) [m] of slices (..., n): each weighted by how little it lies below the least sunk one.

    Derived: a slice that lies lower by several κq [m] (`load_m`, of a typical load) does not carry; one that sinks with
    all others does. The weight is smooth, so that L is continuous over the position. A slice that a gap
    covers in part counts by its parts.
    """
    round_m = 2.0 * np.asarray(radius_m)[..., np.newaxis]
    near = np.maximum(np.minimum(gaps.left_m, gaps.right_m), 0.0)
    floor = np.where(gaps.floor_m > 0.0, gaps.floor_m, np.inf)
    sunk = np.minimum(near**2 / round_m, floor) + lead_m
    partly = (gaps.covered > 0.0) & (gaps.covered < 1.0)
    land = np.where(partly, lead_m + np.maximum(gaps.nearest_tip_m, 0.0) ** 2 / round_m, np.inf)
    least = np.minimum(sunk, land).min(axis=-1, keepdims=True)
    weight, beside = (1.0 / (1.0 + ((depth - least) / (4.0 * load_m)) ** 2) for depth in (sunk, land))
    whole = np.where(partly, gaps.covered, 1.0)
    return np.asarray(cell_m * (whole * weight + (1.0 - whole) * beside).sum(axis=-1))
