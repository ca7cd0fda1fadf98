"""What each tooth pair adds to the coupled mesh stiffness, split so that a sum over the pairs in contact is exact.

Derived. K = 1' C^-1 1 jumps where a pair enters or leaves, and a table must not jump inside a row. So K is split as
K = sum y_n with every y_n continuous over its own engagement: while the number of pairs is the larger one, with t from
0 where the newest enters to 1 where the oldest leaves, pair j gets

    (1 - t) x_j(without the newest) + t x_j(without the oldest)      x: forces at a unit approach

where the pair that is left out counts with its own stiffness instead, and what is missing to K goes to the newest with
1 - t and to the oldest with t. Hence the entering pair brings all of the jump, K - K(without it) >= 0. Without coupling
y_n is the pair's stiffness. The kinks at the two zone edges are what linear interpolation adds to the error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor

import numpy as np

from siggen.arrays import FloatArray, Int32Array
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.coupled_pairs import approach_forces
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

ROUNDING = 1e-9
"""Share of a base pitch within which a pair at the end of its path counts as in contact."""


@dataclass(frozen=True, slots=True)
class CoupledRows:
    """Contributions to the coupled mesh stiffness, and the coupling itself.

    Parameters
    ----------
    stiffness_n_per_m : (rows, points)
        One row per distinct (pairs before, pair, pairs after); row 0 is the healthy one [N/m].
    row_of_pair : (z1, z2) int32
        Row for pinion tooth i with gear tooth j.
    coupling_m_per_n : (apart, points)
        `siggen.gears.stiffness.body_coupling.body_coupling` on the grid [m/N].
    """

    stiffness_n_per_m: FloatArray
    row_of_pair: Int32Array
    coupling_m_per_n: FloatArray

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for array in (self.stiffness_n_per_m, self.row_of_pair, self.coupling_m_per_n):
            array.setflags(write=False)


def neighbour_runs(pair: GearPair, table_of_pair: Int32Array) -> tuple[Int32Array, Int32Array]:
    """Return the distinct runs of kinds (rows, 2 r + 1) and the run of each pair of teeth (z1, z2).

    Column r is the pair itself, lower ones entered before it; r pairs on either side can be in contact with it. Run 0
    is all healthy.
    """
    reach = floor(pair.total_contact_ratio + ROUNDING)
    shifted = [np.roll(table_of_pair, (-apart, -apart), axis=(0, 1)) for apart in range(-reach, reach + 1)]
    every = np.stack(shifted, axis=-1).reshape(-1, 2 * reach + 1)
    # The healthy run comes first even where every pair of teeth meets damage.
    runs, inverse = np.unique(np.vstack([np.zeros_like(every[:1]), every]), axis=0, return_inverse=True)
    return runs.astype(np.int32), inverse.ravel()[1:].reshape(table_of_pair.shape).astype(np.int32)


def coupled_contributions(
    pair: GearPair,
    options: StiffnessOptions,
    runs: Int32Array,
    stiffness_of_kinds: Callable[[FloatArray], FloatArray],
    position_m: FloatArray,
    own_n_per_m: FloatArray | None = None,
) -> FloatArray:
    """Return what the pair in the middle of each run adds to the mesh stiffness, (rows, k) [N/m].

    Parameters
    ----------
    pair : GearPair
    options : StiffnessOptions
    runs : (rows, 2 r + 1)
        Of `neighbour_runs`.
    stiffness_of_kinds : function
        Positions (m,) -> stiffness of each kind of pair alone, (kinds, m) [N/m].
    position_m : (k,)
        Positions of the pair, of helical ones of the middle of the face [m].
    own_n_per_m : (kinds, k) or None
        What `stiffness_of_kinds` returns for `position_m`, where it is known already.

    Source: derived, see this module.
    """
    reach, pitch = runs.shape[1] // 2, pair.base_pitch_m
    own = np.clip(np.floor((position_m - pair.engagement_start_m) / pitch + ROUNDING).astype(np.int64), 0, reach)
    newest = np.maximum(position_m - own * pitch, pair.engagement_start_m)
    full = newest + reach * pitch <= pair.engagement_end_m + ROUNDING * pitch
    # The kinds of all pairs that are in contact, evaluated in one go: damaged teeth are integrated once.
    places = np.minimum(newest + pitch * np.arange(reach + 1)[:, np.newaxis], pair.engagement_end_m)
    inside = np.ones(places.shape, dtype=np.bool_)
    inside[reach] = full
    alone = np.zeros((int(runs.max()) + 1, *places.shape))
    if own_n_per_m is not None:
        alone[:, own, np.arange(own.size)] = own_n_per_m[: alone.shape[0]]
        inside[own, np.arange(own.size)] = False
    alone[:, inside] = stiffness_of_kinds(places[inside])[: alone.shape[0]]
    out = np.empty((runs.shape[0], position_m.size))
    for index in range(reach + 1):
        kinds = runs[:, reach + index - np.arange(reach + 1)]
        for many in (True, False):
            chosen = np.flatnonzero((own == index) & (full == many))
            if chosen.size:
                pairs = reach + 1 if many else reach
                values = alone[kinds[:, :pairs, np.newaxis], np.arange(pairs)[:, np.newaxis], chosen]
                share = _most_pairs if many else approach_forces
                out[:, chosen] = share(pair, options, newest[chosen], values)[:, index]
    return out


def _most_pairs(pair: GearPair, options: StiffnessOptions, newest_m: FloatArray, alone: FloatArray) -> FloatArray:
    """Return the contributions (rows, q, k) where the number of pairs q is the larger one."""
    last = alone.shape[1] - 1
    width = pair.engagement_end_m - last * pair.base_pitch_m - pair.engagement_start_m
    along = np.clip((newest_m - pair.contact_start_m) / max(width, ROUNDING * pair.base_pitch_m), 0.0, 1.0)
    without_newest, without_oldest = alone.copy(), alone.copy()
    without_newest[:, 1:] = approach_forces(pair, options, newest_m + pair.base_pitch_m, alone[:, 1:])
    without_oldest[:, :-1] = approach_forces(pair, options, newest_m, alone[:, :-1])
    shares: FloatArray = (1.0 - along) * without_newest + along * without_oldest
    rest = approach_forces(pair, options, newest_m, alone).sum(axis=1) - shares.sum(axis=1)
    shares[:, 0] += (1.0 - along) * rest
    shares[:, last] += along * rest
    return shares
