r"""Sink of a line contact at one edge of the surface: exact for a half plane, fitted for the notch behind the edge.

A contact of relative radius R and line load F has the Hertz half width a = √(2 R κ F), κ = 2/(π E*). The surface ends
at the signed distance d ahead of the common normal (negative: the normal is already beyond the edge), d̂ = d/a. The
*sink* is the approach less Hertz's approach at the same load and the same far datum.

Derived. The contact [-b, d] is bounded at -b and singular at d; the singular integral equation of a parabola gives its
half length c a and

    c = (d̂ + √(d̂² + 3))/3,   sink/(κF) = G = -ln c + (3c² - 1)(c² - 1)/(4c²)   for d̂ < 1,   0 beyond,

and the distance of the load's centroid from the edge, a c² (2c - d̂). Deep in the gap G = d̂² + ½ + ln(2|d̂|): the first
term is the rigid sink d²/2R, the rest the elasticity of a contact that narrows to c a = a²/(2|d|).

The notch of depth D behind the edge takes away material that would have carried: + N. Derived: a narrow load at the
corner of a quarter plane is softer than on a half plane by ½ [(π/2)(1/(π/2 + 1) + 1/(π/2 - 1)) - 1] = 1.1815 κ per unit
of ln(D/distance), Poisson's ratio drops out. Fitted to plane finite elements (`reference.contact`, ν = 0.3, D/a from
0.35 to 8.4, d̂ from -16 to 2): the course in between, with z = D/(x a) over the distance x a = a (2c + c⁴)/3 from the
edge (d beyond d̂ = 1). Error 3 % of N for D > a/2 and d̂ <= 0.5, at most 0.02 κF beyond d̂ = 1.

A rounded edge (radius r, tangent to the flank where the outline is, falling away inside the gap) has two limits, the
sharp edge and Hertz's contact of the two radii; between them the elastic parts combine by their contact widths,

    e = d²/(2(R + r)) - κF · ½ ln(w + ε (1 - w⁸)),   ε = r/(R + r),   w = exp(-2 (G - d̂²)) (d̂² for d̂ < 0 only);

the eighth power, fitted, lets the rounding end with the sink at d̂ = 1. The law holds

within 7 % of the elastic part against pressure cells (`tests.reference.contact`, r 0.02 to 0.2 mm).
"""

from __future__ import annotations

from math import exp, log, sqrt
from typing import NamedTuple

from siggen.compiled import entry, njit

QUARTER_PLANE = 1.1815
"""Derived: see the module's docstring."""
NOTCH_POWER = 1.25
NOTCH_SCALE, NOTCH_ON_LAND, NOTCH_SHALLOW, NOTCH_SHALLOW_LINEAR = 0.311, 0.278, 0.262, 0.363
"""Fitted by `python -m tests.reference.contact`."""
NO_EDGE = 1e30
"""Distance of an edge that does not exist [m]."""


class EdgeTerms(NamedTuple):
    """Of one edge under the load u = κF [m]: what the coupled law of two edges needs, with derivatives to ln u.

    `factor`: sink over u; `factor_slope`: its derivative to ln u; `centroid_m`: distance of the load from the edge;
    `centroid_slope_m`: its derivative to ln u.
    """

    factor: float
    factor_slope: float
    centroid_m: float
    centroid_slope_m: float


@njit(cache=True, _nrt=False, error_model="numpy")
def half_length(ahead: float) -> float:
    """Return c, the contact's half length over a, at d̂ = `ahead` (1 at d̂ = 1)."""
    return _length_and_slope(ahead)[0]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _length_and_slope(ahead: float) -> tuple[float, float]:
    """Return c and dc/dd̂."""
    root = sqrt(ahead * ahead + 3.0)
    # the same number; the first form loses all digits deep in the gap
    c = 1.0 / (root - ahead) if ahead < 0.0 else (ahead + root) / 3.0
    return c, c / root


@entry(cache=True, _nrt=False, error_model="numpy")
def half_plane_factor(ahead: float) -> float:
    """Return G at d̂ = `ahead`: sink at an edge of a half plane over κF."""
    if ahead >= 1.0:
        return 0.0
    c = half_length(ahead)
    return -log(c) + (3.0 * c * c - 1.0) * (c * c - 1.0) / (4.0 * c * c)


@entry(cache=True, _nrt=False, error_model="numpy")
def notch_factor(ahead: float, depth: float, rounding: float = 0.0) -> float:
    """Return N: what a notch behind the edge adds to G.

    Parameters
    ----------
    ahead : d̂
    depth : D/a; 0 for none
    rounding : ε = r/(R + r) of the edge, which keeps the load at least 2/3 √ε a from the corner
    """
    return _notch_and_slope(ahead, depth, rounding, _length_and_slope(ahead))[0]


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def _notch_and_slope(ahead: float, depth: float, rounding: float, length: tuple[float, float]) -> tuple[float, float]:
    """Return N and dN/d(ln u), d̂ and D/a both falling as u^-½; `length` of `_length_and_slope`."""
    if depth <= 0.0 or ahead > 1e3:
        return 0.0, 0.0
    c, c_slope = length
    if ahead < 1.0:
        distance, distance_slope = (2.0 * c + c**4) / 3.0, (2.0 + 4.0 * c**3) / 3.0 * c_slope
    else:
        distance, distance_slope = ahead, 1.0
    if rounding > 0.0:
        sharp = distance
        distance = sqrt(sharp * sharp + 4.0 / 9.0 * rounding)
        distance_slope *= sharp / distance
    z = depth / distance
    # logarithmic slopes to ln u
    z_log = -0.5 + 0.5 * ahead * distance_slope / distance
    w = c**4
    w_log = 4.0 * (-0.5 * ahead * c_slope / c)
    land = NOTCH_ON_LAND * w / (1.0 + w / 6.0)
    scale = NOTCH_SCALE * (1.0 + land)
    scale_log = land / (1.0 + land) * w_log / (1.0 + w / 6.0)
    shallow = NOTCH_SHALLOW + NOTCH_SHALLOW_LINEAR * z
    below = w * shallow + z * z
    below_log = (w * (shallow * w_log + NOTCH_SHALLOW_LINEAR * z * z_log) + 2.0 * z * z * z_log) / below
    base = scale * z
    # base^NOTCH_POWER by roots, three times as fast as a power
    power = base * sqrt(sqrt(base)) * z * z / below
    power_log = NOTCH_POWER * (scale_log + z_log) + 2.0 * z_log - below_log
    strength = QUARTER_PLANE / NOTCH_POWER
    return strength * log(1.0 + power), strength * power / (1.0 + power) * power_log


@entry(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def edge_terms(ahead_m: float, depth_m: float, radius_m: float, rounding_m: float, load_m: float) -> EdgeTerms:
    """Return the terms of one edge.

    Parameters
    ----------
    ahead_m : d, distance from the common normal to the edge, negative beyond it [m]
    depth_m : D, depth of the notch behind the edge, 0 for none [m]
    radius_m, rounding_m : R, and the edge's radius r, 0 for a sharp one [m]
    load_m : κF > 0 [m]
    """
    width = sqrt(2.0 * radius_m * load_m)
    ahead = ahead_m / width
    share = rounding_m / (radius_m + rounding_m)
    if ahead >= 1.0 and depth_m <= 0.0:
        return EdgeTerms(0.0, 0.0, ahead_m, 0.0)
    c, c_slope = _length_and_slope(ahead)
    notch, notch_slope = _notch_and_slope(ahead, depth_m / width, share, (c, c_slope))
    if ahead >= 1.0:
        return EdgeTerms(notch, notch_slope, ahead_m, 0.0)
    square = c * c
    factor = -log(c) + (3.0 * square - 1.0) * (square - 1.0) / (4.0 * square)
    by_c = -1.0 / c + 1.5 * c - 0.5 / (square * c)
    slope = by_c * c_slope * (-0.5 * ahead)
    if rounding_m > 0.0:
        rigid = ahead * ahead if ahead < 0.0 else 0.0
        narrow = exp(-2.0 * (factor - rigid))
        mixed = narrow + share * (1.0 - narrow**8)
        elastic_slope = slope + rigid
        factor = rigid * (1.0 - share) - 0.5 * log(mixed)
        slope = -rigid * (1.0 - share) + narrow * (1.0 - 8.0 * share * narrow**7) / mixed * elastic_slope
    reach = square * (2.0 * c - ahead)
    reach_by_ahead = 2.0 * c * c_slope * (2.0 * c - ahead) + square * (2.0 * c_slope - 1.0)
    centroid_slope = 0.5 * width * (reach - ahead * reach_by_ahead)
    return EdgeTerms(factor + notch, slope + notch_slope, width * reach, centroid_slope)
