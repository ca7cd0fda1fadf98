r"""Largest elastic pressure where a line contact meets a rounded edge.

Derived, but for two numbers. Deep in a gap the flank of radius R rests on the rounding r alone: Hertz with the radius
R r/(R + r). Near the edge the sharp contact's pressure is K/√x at the distance x, K = √(2 c a) (c a - d)/(π κ R) from
the solution of `edge_law`; the rounding cuts it at A (K²/(κ r))^⅓ (dimensions; A fitted). The two join by a power sum,
and a contact away from the edge keeps Hertz's pressure on R. A and the power are fitted to pressure cells
(`tests.reference.contact`, r 0.02 to 0.2 mm, 30 to 100 N/mm, d̂ -11 to 0.9): within 4 %.

Steel yields below: 4 to 5 GPa at 60 N/mm and r = 0.1 mm. So real edges are rounder than they broke out.
"""

from __future__ import annotations

from math import pi, sqrt

from siggen.compiled import entry
from siggen.gears.contact.edge_law import half_length

ROUNDED_FACTOR, JOINING_POWER = 0.9325, 7.26


@entry(cache=True)
def largest_edge_pressure(
    ahead_m: float, radius_m: float, rounding_m: float, line_load_n_per_m: float, kappa_per_pa: float
) -> float:
    """Return the largest pressure [Pa] of a line load at a rounded edge.

    Parameters
    ----------
    ahead_m : d, distance from the common normal to the edge, negative beyond it [m]
    radius_m, rounding_m : R, and the edge's radius r > 0 [m]
    line_load_n_per_m : F > 0
    kappa_per_pa : κ = 2/(π E*)
    """
    load = kappa_per_pa * line_load_n_per_m
    width = sqrt(2.0 * radius_m * load)
    plain = 2.0 * load / (pi * width)
    if ahead_m >= width:
        return plain / kappa_per_pa
    half = half_length(ahead_m / width) * width
    singular = sqrt(2.0 * half) * (half - ahead_m) / (pi * radius_m)
    cut = ROUNDED_FACTOR * (singular * singular / rounding_m) ** (1.0 / 3.0)
    deep = plain * sqrt((radius_m + rounding_m) / rounding_m)
    joined = cut * (1.0 + (cut / deep) ** JOINING_POWER) ** (-1.0 / JOINING_POWER)
    return float(max(plain, joined) / kappa_per_pa)
