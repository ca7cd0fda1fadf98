"""FaceSlices: one tooth pair at one position, cut into slices across the face, and what a slice answers on its own."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.gears.contact.covered_slice import CoveredSlice, covered_sink
from siggen.gears.contact.line_kernel import LineKernel, reckoned_width
from siggen.gears.contact.tooth_kernel import ToothKernel
from siggen.gears.contact.two_edges import GapSink, gap_sink


class FaceSlices(NamedTuple):
    """The slices at one position (a named tuple, since compiled code takes no dataclass); arrays are (n,).

    `left_m`, `right_m`, `notch_m`, `floor_m`: the gap that each slice meets, as for `two_edges.gap_sink`; `rough`: part
    of a slice that is rough land; `covered`: part of a slice that has this gap, the rest has
    only the edges `tips_m` (n, 2; left, right) of the teeth; `spread`: k of `covered_slice`; `lead_m`: missing material
    across the face, of any sign; `face_m`: y from the middle of the face; `kernel`: K; `teeth`: T; `radius_m`: R by
    which slices act on each other; `radii_m`: R of each; `rounding_m`: radius of the edges; `kappa_per_pa`: κ;
    `compliance_m_per_n`: C, of what is rigid across the face; `carrying_m`: L.
    """

    left_m: FloatArray
    right_m: FloatArray
    notch_m: FloatArray
    floor_m: FloatArray
    rough: FloatArray
    covered: FloatArray
    lead_m: FloatArray
    face_m: FloatArray
    tips_m: FloatArray
    spread: float
    kernel: LineKernel
    teeth: ToothKernel
    radius_m: float
    radii_m: FloatArray
    rounding_m: float
    kappa_per_pa: float
    compliance_m_per_n: float
    carrying_m: float


@entry(cache=True, _nrt=False, error_model="numpy")
def slice_of(slices: FaceSlices, i: int) -> CoveredSlice:
    """Return slice i on its own."""
    gap = slices.left_m[i], slices.right_m[i], slices.notch_m[i], slices.floor_m[i]
    tips = slices.tips_m[i, 0], slices.tips_m[i, 1]
    return CoveredSlice(gap, tips, slices.covered[i], slices.spread, (slices.radii_m[i], slices.rounding_m))


@entry(cache=True, _nrt=False, error_model="numpy")
def slice_sink(one: CoveredSlice, load: float) -> GapSink:
    """Return the sink of a slice under a load κq [m]."""
    if 0.0 < one.covered < 1.0:
        return covered_sink(one, load)
    gap, (radius, rounding) = one.gap, one.radii
    return gap_sink(gap[0], gap[1], gap[2], gap[3], radius, rounding, load)


@entry(cache=True, _nrt=False, error_model="numpy")
def contact_half_width(slices: FaceSlices, square: float) -> tuple[float, float, float]:
    """Return a [m] of loads with the sum of squares `square`, as `reckoned_width` does."""
    cell = slices.kernel.cell_m
    width = sqrt(2.0 * slices.radius_m * sqrt(cell * square / slices.carrying_m))
    return reckoned_width(width, cell) if slices.kernel.coupled else (width, 1.0, 0.0)
