"""How the pairs of a law share a force at rest: the load of one pair over its whole way through the mesh."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry
from siggen.dynamics.mesh.pair_columns import NORMAL, PENETRATION
from siggen.dynamics.mesh.pair_forces import pair_forces
from siggen.dynamics.mesh.pair_law import PairLaw
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.dynamics.mesh.static_stiffness import static_approaches_m


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
