"""Quasi-static mesh stiffness of a pair law: the force that the pairs carry over the approach that it takes.

Derived. At rest the pairs carry F at the approach x(F), measured from where ideal flanks would touch, so tip relief and
the sink into damage count as approach. F/x is a secant, not a tangent: where the mating flank first sinks into damage
it falls with a falling load. On the drive flank the force grows with the approach, so false position within a bracket
always ends.
"""

from __future__ import annotations

from math import lcm

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.compiled import entry, njit
from siggen.mesh import pair_law as at
from siggen.mesh.node_forces import pair_forces, static_force
from siggen.mesh.pair_columns import NORMAL, PENETRATION
from siggen.mesh.pair_law import PairLaw
from siggen.mesh.pair_springs import pair_table

FIRST_APPROACH_M = 1e-5
MOST_STEPS = 200
"""Against about ten that are needed; halvings alone would need 40."""
CLOSE = 1e-12
"""Share of the force that counts as solved: a hundred times the rounding of a sum of pair forces."""
SCANNED, ZOOMS, ZOOMED = 257, 3, 17
"""Angles per base pitch in the search for the largest loss, and finer ones around the worst: 35 µm of the path first,
so that the shortest spalls count a dozen; the peaks are kinks, so the zooms leave 1e-4 of a cell."""


@njit(cache=True, _nrt=False, error_model="numpy")
def _approach(law: PairLaw, force_n: float, pitches: float, guess_m: float, reach_m: float, pairs: FloatArray) -> float:
    """Return the approach [m] at one angle, near a guess or not; NaN where not even `reach_m` carries the force."""
    low, high = 0.95 * guess_m, min(1.05 * guess_m, reach_m)
    below = static_force(law, low, pitches, pairs) - force_n
    if below > 0.0:
        high, above, low = low, below, 0.0
        below = static_force(law, low, pitches, pairs) - force_n
    else:
        above = static_force(law, high, pitches, pairs) - force_n
        while above < 0.0 and high < reach_m:
            low, below, high = high, above, min(2.0 * high, reach_m)
            above = static_force(law, high, pitches, pairs) - force_n
    if below > 0.0 or above < 0.0:
        return np.nan
    for _ in range(MOST_STEPS):
        middle = 0.5 * (low + high) if above == below else low - below * (high - low) / (above - below)
        found = static_force(law, middle, pitches, pairs) - force_n
        if abs(found) <= CLOSE * force_n or high - low <= CLOSE * high:
            return middle
        # Illinois: an end that stays for a second time counts half, or its side would never move.
        if found > 0.0:
            high, above, below = middle, found, 0.5 * below
        else:
            low, below, above = middle, found, 0.5 * above
    return np.nan


@entry(cache=True)
def _approaches(law: PairLaw, force_n: float, pitches: FloatArray, reach_m: float, pairs: FloatArray) -> FloatArray:
    result, guess = np.empty(pitches.size), FIRST_APPROACH_M
    for i in range(pitches.size):
        # Angles mostly follow each other closely: the last approach is the best guess of the next.
        guess = result[i] = _approach(law, force_n, pitches[i], guess, reach_m, pairs)
    return result


def static_approaches_m(law: PairLaw, force_n: float, pitches: FloatArray) -> FloatArray:
    """Return the approach (k,) [m] at which the drive flanks carry a force at rest, at angles (k,) in base pitches.

    Raises
    ------
    ValueError
        If the force is not positive, or a penetration of a tenth of a base pitch does not carry it.
    """
    reach = 0.1 * law.base_pitch_m
    if not (np.isfinite(force_n) and force_n > 0.0):
        raise ValueError(f"force_n: received {force_n}; allowed are finite values above 0")
    found = _approaches(law, force_n, np.asarray(pitches, dtype=np.float64), reach, pair_table(law))
    if np.isnan(found).any():
        raise ValueError(f"force_n: received {force_n}; allowed are forces that teeth carry within {reach:.3g} m")
    return np.asarray(found)


def secant_stiffness_n_per_m(law: PairLaw, force_n: float, pitches: FloatArray) -> FloatArray:
    """Return F/x (k,) [N/m] at angles (k,) in base pitches; errors as `static_approaches_m`.

    Source: derived, see this module.
    """
    return force_n / static_approaches_m(law, force_n, pitches)


def largest_secant_loss(law: PairLaw, healthy: PairLaw, force_n: float, *, worn: bool = False) -> float:
    """Return max (K_healthy - K)/K_healthy of the secant stiffness at a force, over a whole hunting period.

    Parameters
    ----------
    law, healthy : PairLaw
        With and without damage, otherwise the same.
    force_n : float
        Normal force of the mesh [N].
    worn : bool
        Whether flanks of all teeth alike miss what those of `healthy` have.

    Raises
    ------
    ValueError
        As `static_approaches_m`.

    Source: derived. Every sequence of kinds of pairs that occurs is scanned over the base pitch of its newest pair.
    """
    first, along = pairs_before_damage(law), np.linspace(0.0, 1.0, SCANNED)
    if not first.size:
        if not worn:
            return 0.0
        first = np.zeros(1, dtype=np.int64)
    # All teeth of `healthy` are alike: one pitch stands for every other.
    whole = static_approaches_m(healthy, force_n, along)
    scanned = (first[:, np.newaxis] + along).ravel()
    losses = 1.0 - np.tile(whole, first.size) / static_approaches_m(law, force_n, scanned)
    best, worst, step = float(losses.max()), float(scanned[np.argmax(losses)]), 1.0 / (SCANNED - 1)
    for _ in range(ZOOMS):
        near = np.linspace(worst - step, worst + step, ZOOMED)
        losses = 1.0 - static_approaches_m(healthy, force_n, near) / static_approaches_m(law, force_n, near)
        best, worst = max(best, float(losses.max())), float(near[np.argmax(losses)])
        step *= 2.0 / (ZOOMED - 1)
    # Below what an approach is solved to nothing is lost: kinds of pairs that are sound ones would differ by rounding.
    return best if best > CLOSE else 0.0


def pairs_before_damage(law: PairLaw) -> IntArray:
    """Return the newest pairs (k,) of the angles [n, n + 1] that stand for all sequences of pairs with damage."""
    head = law.places
    teeth = (int(head[at.TEETH_1]), int(head[at.TEETH_2]))
    first = int(head[at.TABLE_AT])
    rows = head[first : first + teeth[0] * teeth[1]].reshape(teeth)
    # Pairs of one row differ where single teeth have lost their tips.
    kinds = [head[head[k] : head[k] + z] for k, z in zip((at.KIND_1_AT, at.KIND_2_AT), teeth, strict=True)]
    several = int(kinds[1].max()) + 1
    rows = rows + (int(rows.max()) + 1) * (kinds[0][:, np.newaxis] * several + kinds[1])
    # With corner contact the next pair is in reach too, and older ones longer.
    number = np.arange(lcm(*teeth))[:, np.newaxis] - np.arange(-1, law.slots + 1)
    runs, shown = np.unique(rows[number % teeth[0], number % teeth[1]], axis=0, return_index=True)
    return np.asarray(np.sort(shown[np.any(runs > 0, axis=1)]), dtype=np.int64)


# How the pairs of a law share a force at rest: the load of one pair over its whole way through the mesh.


def loads_at_rest(law: PairLaw, force_n: float, pitches: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return load [N] and penetration [m] of pair 0 at angles (k,) in base pitches since it entered contact.

    Parameters
    ----------
    law : PairLaw
    force_n : float
        That all pairs carry together [N].
    pitches : (k,)
        From 0 to the contact ratio.

    Raises
    ------
    ValueError
        As `static_approaches_m`.
    """
    angles = np.asarray(pitches, dtype=np.float64)
    found = _loads(law, static_approaches_m(law, force_n, angles), angles, pair_table(law))
    return found[0], found[1]


@entry(cache=True)
def _loads(law: PairLaw, approaches_m: FloatArray, pitches: FloatArray, pairs: FloatArray) -> FloatArray:
    found = np.zeros((2, pitches.size))
    for i in range(pitches.size):
        pair_forces(law, approaches_m[i], 0.0, pitches[i], 0.0, 0.0, pairs)
        # Slot 0 is that of pair 0 (`PairLaw.slots`).
        found[0, i], found[1, i] = pairs[0, NORMAL], pairs[0, PENETRATION]
    return found
