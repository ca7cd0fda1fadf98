"""Deflection at one tooth by the load on a neighbour of the same gear, along the line of action.

Derived. The ring between hub and root circle twists under the moment F R_b and carries all its teeth along, which is
exact (R_b^2 (1/r_int^2 - 1/R_f^2)/(4 pi G L)). The rest is local. A tooth without load moves as a rigid body, and a
loaded one acts on the body by its resultants at the root (Saint-Venant). Let p = (cos a, sin a, u) of each tooth: a the
slant of the force against the tooth's normal, u = R_b - R_f cos a its lever about the root circle in modules. Then the
rest times E L is bilinear, p_lower' B p_upper. Mirroring the two teeth and reciprocity leave six entries of B free; one
of their products is sin(a_upper - a_lower), the same all along the line of action, and is left to the others. The other
five are Chebyshev polynomials of 1/z and ln h_f (root over held radius), fitted to finite elements
(`siggen.mesh.coupling_table`); two teeth apart have a table of their own, farther ones keep the ring's twist
only.

Bodies of helical gears also bend along the axis (`axial_body`), which moves neighbours too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import floor, pi, tan

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from siggen.arrays import FloatArray, Int32Array
from siggen.gears.gear_pair import GearPair
from siggen.gears.helical import carrying_middle_m
from siggen.gears.missing_material import CORNER_REACH_PITCHES
from siggen.gears.planetary import RingGear
from siggen.gears.spur_gear import SpurGear
from siggen.mesh.axial_body import axial_compliance
from siggen.mesh.calibration import RADIUS_RATIO_RANGE, TEETH_RANGE, unit_coordinates
from siggen.mesh.coupling_table import COUPLING_COEFFICIENTS
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import root_half_angle

TERMS = 5


def body_coupling(pair: GearPair, options: StiffnessOptions, position_m: FloatArray) -> FloatArray:
    """Return the deflection of a pair per unit force on the pair 1, 2, ... base pitches ahead, (apart, k) [m/N].

    Parameters
    ----------
    pair : GearPair
    options : StiffnessOptions
        Zeros with coupling 'none'.
    position_m : (k,)
        Positions of the pair that entered later [m]; the other one is 1, 2, ... base pitches farther. Beyond its path
        of contact a tooth counts as touched at its tip.

    Returns
    -------
    (apart, k) array
        Both gears together, symmetric in the two pairs; as many rows as pairs can be in reach with corner contact, less
        one.

    Source: derived, see this module.
    """
    apart = max(1, floor(pair.contact_ratio + pair.overlap_ratio + 2.0 * CORNER_REACH_PITCHES))
    position = np.asarray(position_m, dtype=np.float64)
    out = np.zeros((apart, position.size))
    if options.coupling == "none":
        return out
    scale = pair.youngs_modulus_pa * pair.face_width_m
    behind = carrying_middle_m(pair, position)
    for row in range(apart):
        ahead = carrying_middle_m(pair, position + (row + 1) * pair.base_pitch_m)
        # The pair that entered later is nearer the pinion's root and nearer the gear's tip.
        on_gear = (pair.line_of_action_m - ahead) / pair.gear.base_radius_m
        both = neighbour_compliance(pair.pinion, behind / pair.pinion.base_radius_m, row + 1, pair.poisson_ratio)
        both = both + neighbour_compliance(pair.gear, on_gear, row + 1, pair.poisson_ratio)
        if pair.helix_rad != 0.0:
            both = both + _axial(pair, options, behind, ahead, row + 1)
        out[row] = both / scale
    return out


def _axial(
    pair: GearPair, options: StiffnessOptions, behind_m: FloatArray, ahead_m: FloatArray, apart: int
) -> FloatArray:
    """Return what both bodies do along the axis, as `neighbour_compliance`; contacts at two positions (k,) [m]."""
    found, line = np.zeros(behind_m.size), pair.line_of_action_m
    for gear, one, two in ((pair.pinion, behind_m, ahead_m), (pair.gear, line - ahead_m, line - behind_m)):
        angle, tip = root_half_angle(gear, options.root_reading), gear.tip_roll_rad
        lower, upper = (np.clip(along / gear.base_radius_m, 0.0, tip) for along in (one, two))
        found += axial_compliance(gear, pair.face_width_m, pair.poisson_ratio, angle, lower, upper, apart)
    return np.asarray(tan(pair.base_helix_rad) ** 2 * found)


def neighbour_compliance(gear: SpurGear, lower_roll: FloatArray, apart: int, poisson_ratio: float) -> FloatArray:
    """Return the deflection of one tooth of a gear per unit force on another, times E L (k,), dimensionless.

    Parameters
    ----------
    gear : SpurGear
        Outside the calibrated ranges of teeth and h_f the local rest is that of the nearest gear inside.
    lower_roll : (k,)
        Roll angle of the contact nearer the root [rad]; the other lies `apart` pitches higher, at most at the tip.
    apart : int
        Teeth between the two, plus one.
    poisson_ratio : float
        Enters the twist of the ring; the local rest is that of 0.3.

    Source: derived (finite elements, plane stress, bore clamped).
    """
    twist = ring_torsion(gear, poisson_ratio)
    if apart > COUPLING_COEFFICIENTS.shape[0]:
        return np.full(np.shape(lower_roll), twist)
    tip = gear.tip_roll_rad
    upper = np.clip(lower_roll + 2.0 * pi * apart / gear.teeth, 0.0, tip)
    terms = load_terms(gear, np.clip(lower_roll, 0.0, tip), upper)
    u, v, _ = unit_coordinates(
        float(np.clip(gear.teeth, *TEETH_RANGE)),
        float(np.clip(gear.root_radius_m / gear.held_radius_m, *RADIUS_RATIO_RANGE)),
        np.zeros(1),
    )
    entries = chebyshev.chebval(v, chebyshev.chebval(u, np.moveaxis(COUPLING_COEFFICIENTS[apart - 1], 0, -1)))
    return np.asarray(twist + entries @ terms)


def ring_torsion(gear: SpurGear, poisson_ratio: float) -> float:
    """Return R_b^2 (1/r_int^2 - 1/R_f^2)/(4 pi G) times E: the twist of the ring between held radius and root circle.

    Derived: the shear stress of a moment M is M/(2 pi r^2 L), and the rotation of the rim against the hub its strain
    over r, integrated over the radius. Times E L, dimensionless, for a unit force on the line of action.
    """
    if isinstance(gear, RingGear):
        return 0.0  # held all round
    squares = gear.held_radius_m**-2 - gear.root_radius_m**-2
    return float(gear.base_radius_m**2 * squares * (1.0 + poisson_ratio) / (2.0 * pi))


def outside_coupling(gear: SpurGear) -> tuple[str, ...]:
    """Return what lies outside the range of the fitted local rest, as sentences; empty inside it."""
    ratio = gear.root_radius_m / gear.held_radius_m
    checks = (("teeth", gear.teeth, TEETH_RANGE), ("h_f = root radius / held radius", ratio, RADIUS_RATIO_RANGE))
    return tuple(
        f"coupling: {name} is {value:.4g}; fitted range {low:g} to {high:g}"
        for name, value, (low, high) in checks
        if not low - 1e-9 <= value <= high + 1e-9
    )


def load_terms(gear: SpurGear, lower_roll: FloatArray, upper_roll: FloatArray) -> FloatArray:
    """Return the five products of root loads that the local rest is linear in, (5, k); contacts at two rolls (k,)."""
    c0, s0, u0 = _root_loads(gear, lower_roll)
    c1, s1, u1 = _root_loads(gear, upper_roll)
    return np.stack([c0 * c1, s0 * s1, u0 * u1, c0 * u1 + u0 * c1, s0 * u1 - u0 * s1])


def _root_loads(gear: SpurGear, roll: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    slant = roll - gear.base_half_angle_rad
    lever = (gear.base_radius_m - gear.root_radius_m * np.cos(slant)) / gear.module_m
    return np.cos(slant), np.sin(slant), lever


# Forces of tooth pairs that share two gear bodies, at equal approach: K = 1' C^-1 1 with C = diag(1/k) + c.
#
# Derived: the approach of pair i is f_i/k_i + sum_j c_ij f_j and the same for all pairs in contact; the mesh stiffness
# is the sum of the forces at a unit approach. It is also the largest of 2 1'f - f'C f, so it is at least that of any
# single pair, at most the plain sum as long as c and f are not negative, and falls when any pair gets softer.


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


# What each tooth pair adds to the coupled mesh stiffness, split so that a sum over the pairs in contact is exact.
#
# Derived. K = 1' C^-1 1 jumps where a pair enters or leaves, and a table must not jump inside a row. So K is split as
# K = sum y_n with every y_n continuous over its own engagement: while the number of pairs is the larger one, with t
# from 0 where the newest enters to 1 where the oldest leaves, pair j gets
#
#     (1 - t) x_j(without the newest) + t x_j(without the oldest)      x: forces at a unit approach
#
# where the pair that is left out counts with its own stiffness instead, and what is missing to K goes to the newest
# with 1 - t and to the oldest with t. Hence the entering pair brings all of the jump, K - K(without it) >= 0. Without
# coupling y_n is the pair's stiffness. The kinks at the two zone edges are what linear interpolation adds to the
# error.

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
        `siggen.mesh.body_coupling.body_coupling` on the grid [m/N].
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
