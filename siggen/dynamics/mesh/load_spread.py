"""Where the load of a helical pair lies about the pitch point, compiled (derived: `gears.geometry.face_shares`)."""

from __future__ import annotations

from typing import NamedTuple

from siggen.compiled import njit
from siggen.dynamics.mesh import pair_law as layout
from siggen.dynamics.mesh.pair_law import PairLaw


class LoadPart(NamedTuple):
    """Share of the load of a pair, and the mean of its places [m]."""

    share: float
    place: float


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def spread(law: PairLaw, position_m: float) -> tuple[LoadPart, LoadPart]:
    """Return the load before and behind the pitch point of a pair whose middle of the face is at a position [m]."""
    scalars, numbers, points = law.scalars, law.numbers, law.places[layout.POINTS]
    along = (position_m - scalars[layout.START_M]) / scalars[layout.PITCH_M] * scalars[layout.PER_PITCH]
    along = min(max(along, 0.0), points - 1.0)
    cell = min(int(along), points - 2)
    weight = along - cell
    first = law.places[layout.SPREAD_AT] + cell
    share = numbers[first] + weight * (numbers[first + 1] - numbers[first])
    first += points
    before = numbers[first] + weight * (numbers[first + 1] - numbers[first])
    first += points
    behind = numbers[first] + weight * (numbers[first + 1] - numbers[first])
    return LoadPart(share, position_m + before), LoadPart(1.0 - share, position_m + behind)
