"""Forces of tooth pairs that share two gear bodies, at equal approach: K = 1' C^-1 1 with C = diag(1/k) + c.

Derived: the approach of pair i is f_i/k_i + sum_j c_ij f_j and the same for all pairs in contact; the mesh stiffness is
the sum of the forces at a unit approach. It is also the largest of 2 1'f - f'C f, so it is at least that of any single
pair, at most the plain sum as long as c and f are not negative, and falls when any pair gets softer.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.body_coupling import body_coupling
from siggen.gears.stiffness.stiffness_options import StiffnessOptions


class StiffTeethError(ValueError):
    """Teeth by themselves are stiffer than their effect on a neighbour: one of the models does not fit the gear."""


def approach_forces(
    pair: GearPair, options: StiffnessOptions, newest_m: FloatArray, stiffness_n_per_m: FloatArray
) -> FloatArray:
    """Return the force of each pair in contact per unit of common approach, shape of `stiffness_n_per_m` [N/m].

    Parameters
    ----------
    pair : GearPair
    options : StiffnessOptions
    newest_m : (k,)
        Positions of the pair that entered last [m].
    stiffness_n_per_m : (..., q, k)
        Stiffness of each pair alone, the newest first; 0 where a pair has no contact [N/m].

    Raises
    ------
    StiffTeethError
        If a pair would have to pull: the bodies deflect a neighbour more than the models deflect the tooth itself.
    """
    count = stiffness_n_per_m.shape[-2]
    if count == 1 or options.coupling == "none":
        return stiffness_n_per_m
    cross = np.zeros((count, count, newest_m.size))
    for later in range(count - 1):
        between = body_coupling(pair, options, newest_m + later * pair.base_pitch_m)
        for apart in range(1, count - later):
            cross[later, later + apart] = cross[later + apart, later] = between[apart - 1]
    # In stiffness, not compliance: a pair that damage through the face leaves without contact carries none.
    share = cross * stiffness_n_per_m[..., np.newaxis, :, :]
    if count == 2:
        own, mate = share[..., 1, 0, :], share[..., 0, 1, :]
        deflection = np.stack([1.0 - mate, 1.0 - own], axis=-2) / (1.0 - own * mate)[..., np.newaxis, :]
    else:
        matrix = np.eye(count) + np.moveaxis(share, -1, -3)
        alike = np.asarray(np.linalg.solve(matrix, np.ones((*matrix.shape[:-1], 1)))[..., 0], dtype=np.float64)
        deflection = np.moveaxis(alike, -1, -2)
    if not (np.all(share < 1.0) and np.all(deflection > 0.0)):
        raise StiffTeethError(
            "coupling 'body': a tooth's own compliance is below its neighbour's effect on it; allowed: stiffness "
            "models whose teeth and body are softer, such as beam 'calibrated'"
        )
    forces: FloatArray = stiffness_n_per_m * deflection
    return forces


def coupled_sum(
    pair: GearPair,
    options: StiffnessOptions,
    contacts: tuple[NDArray[np.int64], NDArray[np.int64], FloatArray],
    stiffness_n_per_m: FloatArray,
    size: int,
) -> FloatArray:
    """Return the mesh stiffness (size,) [N/m] of pairs in contact.

    Parameters
    ----------
    pair : GearPair
    options : StiffnessOptions
    contacts : ((m,), (m,), (m,))
        Index into the result, global pair count and position [m] of each pair in contact.
    stiffness_n_per_m : (m,)
        Of each of these pairs alone.
    size : int
    """
    index, count, position = contacts
    newest = np.full(size, np.iinfo(np.int64).min)
    np.maximum.at(newest, index, count)
    age = newest[index] - count
    slots = np.zeros((int(np.max(age, initial=0)) + 1, size))
    slots[age, index] = stiffness_n_per_m
    first = np.zeros(size)
    first[index[age == 0]] = position[age == 0]
    # Not the stiff ones alone: a pair that damage through the face leaves without contact keeps its place.
    pairs = np.bincount(index, minlength=size)
    total = np.zeros(size)
    for number in np.unique(pairs[pairs > 0]):
        chosen = pairs == number
        total[chosen] = approach_forces(pair, options, first[chosen], slots[:number, chosen]).sum(axis=0)
    return total
