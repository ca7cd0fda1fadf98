"""Normal force of a tooth pair whose flanks carry pits, from slices across the face that share one tooth deflection.

Derived:

* N = Σ_j k_j max(0, d - C N - e_j) with the penetration d, the compliance C = 1/k_n - 1/k_h of everything but the
  contact, and the Hertz stiffness k_h of the face split over the slices; every slice again over its land (e = 0) and
  its pit (e = sink). For springs sorted by e the force is max over m of (K_m d - S_m)/(1 + C K_m), K_m and S_m the sums
  of k and k e over the first m: exact, without iteration. The force is convex and piecewise linear in d.
* Sink of the mating flank into a pit: Δ = min(floor depth, r²/(2 (R_e + R_r))) with the distance r along the arc to the
  nearest edge (for a pit of length l centred at g = 0: r = l/2 - |g|), R_e the relative radius of curvature and R_r the
  radius of a rounded edge that starts at the pit's outline. 0 with zero slope at the outline, l²/(8 R_e) at most, with
  a kink where the contact changes from one edge to the other.

So a pit that leaves lands beside it gives no displacement excitation: the lands carry the load, the contact only gets
softer. Where no land is left the mating flank sinks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import njit


class SliceSprings(NamedTuple):
    """Springs of a contact at one position (a named tuple, since compiled code takes no dataclass).

    `gap_m` (n,): e ascending; `stiffness_n_per_m` (n,): k, any from 0; `compliance_m_per_n`: C that they share.
    """

    gap_m: FloatArray
    stiffness_n_per_m: FloatArray
    compliance_m_per_n: float


def sink_depths(edge_m: FloatArray, depth_m: FloatArray, radius_m: FloatArray, edge_radius_m: float) -> FloatArray:
    """Return the sink Δ [m] of contacts at a distance `edge_m` from the nearest edge of a pit; arrays that broadcast.

    The floor of a dish is taken where the contact is, an upper bound of the exact sink (equal to it for flat floors
    and wherever the edges carry).
    """
    return np.minimum(depth_m, np.square(edge_m) / (2.0 * (radius_m + edge_radius_m)))


def slice_springs(covered: FloatArray, sink_m: FloatArray, contact_n_per_m: float, compliance: float) -> SliceSprings:
    """Return the springs at one position: the lands of all slices as the first, then the pits by rising sink.

    Parameters
    ----------
    covered, sink_m : (slices,)
        Share of each slice over pits, and the sink into them [m].
    contact_n_per_m : float
        Hertz stiffness k_h of the whole face [N/m].
    compliance : float
        C [m/N].
    """
    pitted = np.flatnonzero(covered)
    order = pitted[np.argsort(sink_m[pitted], kind="stable")]
    land = contact_n_per_m * float(np.mean(1.0 - covered))
    stiffness = np.concatenate([[land], contact_n_per_m / covered.size * covered[order]])
    return SliceSprings(np.concatenate([[0.0], sink_m[order]]), stiffness, float(compliance))


def grouped_sinks(covered: FloatArray, sink_m: FloatArray, groups: int) -> FloatArray:
    """Return the mean sink (positions, groups) [m] of parts of what lies over pits, ascending: a table of springs.

    Parameters
    ----------
    covered, sink_m : (positions, slices)
        As for `slice_springs`.
    groups : int
        Springs that stand for what lies over pits, beside one for the lands: number j takes the part from (j/groups)²
        to ((j + 1)/groups)², since the least sinks are the first to carry.

    Derived: sorted by sink, what lies over pits is a step function of its share from 0 to 1; every group is its mean
    over one part. Exact where all slices over pits sink alike.
    """
    ends = np.square(np.linspace(0.0, 1.0, groups + 1))
    out = np.zeros((covered.shape[0], groups))
    for i in np.flatnonzero(np.any(covered > 0.0, axis=1)):
        order = np.argsort(sink_m[i], kind="stable")
        share = np.concatenate([[0.0], np.cumsum(covered[i, order])])
        integral = np.concatenate([[0.0], np.cumsum(covered[i, order] * sink_m[i, order])])
        means = np.diff(np.interp(ends, share / share[-1], integral / share[-1])) / np.diff(ends)
        # Differences of sums of equal sinks come out unequal by rounding; the springs must ascend.
        out[i] = np.maximum.accumulate(means)
    return out


@njit(cache=True)
def slice_force(springs: SliceSprings, penetration_m: float) -> float:
    """Return the normal force N [N] at the penetration d [m]; 0 where no slice touches."""
    force, stiffness, preload = 0.0, 0.0, 0.0
    for j in range(springs.gap_m.size):
        if springs.gap_m[j] >= penetration_m - springs.compliance_m_per_n * force:
            break
        stiffness += springs.stiffness_n_per_m[j]
        preload += springs.stiffness_n_per_m[j] * springs.gap_m[j]
        force = (stiffness * penetration_m - preload) / (1.0 + springs.compliance_m_per_n * stiffness)
    return max(force, 0.0)
