"""AsperityTable: asperity share and fluid friction over position and load, for the compiled time loop.

Derived: bilinear interpolation over the position s (uniform) and the logarithm of the load group Ŵ (uniform from
`LOAD_FLOOR`, below which the film holds its value), one layer per roughness. The film is a power law and the share is
flat where it ends, so both are nearly linear within a cell.
The error is measured at the middle of every cell, where that of a smooth function is largest
(`tests/dynamics/friction/test_asperity_table.py`): below 1.2e-3 in the share (1e-4 in the friction coefficient) for the
default grid, 18/47 teeth of module 3 mm at 30 Hz in ISO VG 220, the path of contact with 0.5 mm on either side and
roughness from 0.1 to 5 µm. The film's friction falls to 0 at the pitch point; a line of the grid stands there. In the
cell beside it the film is up to 1.2e-3 too slippery at the static load, and more above it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.compiled import entry, njit
from siggen.gears.gear_pair import GearPair
from siggen.lanes import Lanes, Whole, as_doubles, gather_pairs, larger, logarithm, smaller, truncated
from siggen.mesh.lubrication import (
    LOAD_FLOOR,
    LubricatedMesh,
    Values,
    asperity_load_share,
    central_film_m,
    film_ratio,
    film_traction,
    relative_radius,
)

LEAST_ROUGHNESS_M = 1e-12
"""A smooth flank has a film ratio too."""


class AsperityTable(NamedTuple):
    """Tables over (roughness, position, load); a named tuple, since compiled code takes no dataclass.

    `share` (roughnesses, positions, loads): asperity share of the load; `fluid` (positions, loads): coefficient of the
    film; `line_m`: T; `start_m`, `per_m`: first position and grid points per metre; `floor_n_per_m`:
    force at the lower end of the load axis over R_e; `per_log`: grid points per unit of the natural logarithm of the
    load.
    """

    share: FloatArray
    fluid: FloatArray
    line_m: float
    start_m: float
    per_m: float
    floor_n_per_m: float
    per_log: float


def asperity_table(
    mesh: LubricatedMesh,
    roughness_m: Sequence[float],
    range_m: tuple[float, float],
    largest_force_n: float,
    points: tuple[int, int] = (257, 25),
) -> AsperityTable:
    """Return the table of a mesh at its speed.

    Parameters
    ----------
    mesh : LubricatedMesh
    roughness_m : sequence of float
        Composite rms roughness σ of each layer [m], for example the healthy flank, then pitted ones. The oil is warmed
        by the friction of the first.
    range_m : (first, last)
        Positions s that the grid reaches [m], a cell inside the line of action; beyond them the end values hold.
    largest_force_n : float
        The load axis reaches this force at every position; beyond its end the end values hold [N].
    points : (positions, loads)

    Raises
    ------
    ValueError
        If the range or the force is impossible.
    """
    _check(mesh, range_m, points[0])
    position = _positions(mesh, range_m, points[0])
    floor = LOAD_FLOOR * mesh.contact_length_m * mesh.effective_modulus_pa
    lowest = np.asarray(floor * relative_radius(position, mesh.line_m))
    span = float(np.log(largest_force_n / lowest.min())) if largest_force_n > 0.0 else np.nan
    if not (np.isfinite(span) and span > 0.0):
        allowed = f"allowed are finite forces above {lowest.min():.3g} N"
        raise ValueError(f"largest_force_n: received {largest_force_n}; {allowed}")
    force = lowest[:, None] * np.exp(span * np.arange(points[1]) / (points[1] - 1))
    share = np.stack([share_at(mesh, sigma, position[:, None], force) for sigma in roughness_m])
    fluid = film_traction(mesh, position[:, None], force, share[0])
    for array in (share, fluid):
        array.setflags(write=False)
    return AsperityTable(
        share=share,
        fluid=fluid,
        line_m=mesh.line_m,
        start_m=float(position[0]),
        per_m=(points[0] - 1) / (position[-1] - position[0]),
        floor_n_per_m=floor,
        per_log=(points[1] - 1) / span,
    )


def _positions(mesh: LubricatedMesh, range_m: tuple[float, float], points: int) -> FloatArray:
    """Return places that reach over the range, one of them the pitch point."""
    cell = _cell_m(range_m, points)
    pitch = mesh.line_m * mesh.speed_2_rad_s / (mesh.speed_1_rad_s + mesh.speed_2_rad_s)
    before = np.ceil((pitch - range_m[0]) / cell)
    return np.asarray(pitch + cell * (np.arange(points) - before))


def _cell_m(range_m: tuple[float, float], points: int) -> float:
    return (range_m[1] - range_m[0]) / (points - 2)


def share_at(mesh: LubricatedMesh, roughness_m: float, position_m: Values, force_n: Values) -> FloatArray:
    """Return the asperity share directly by the law at positions [m] and forces [N] that broadcast."""
    film_m = central_film_m(mesh.groups(position_m, force_n))
    return np.asarray(asperity_load_share(film_ratio(film_m, max(roughness_m, LEAST_ROUGHNESS_M))), dtype=np.float64)


class LoadGrid(NamedTuple):
    """The grid of an `AsperityTable`: its numbers of positions and loads, and the fields of these names."""

    positions: int
    loads: int
    line_m: float
    start_m: float
    per_m: float
    floor_n_per_m: float
    per_log: float


@entry(cache=True, error_model="numpy")
def mixed_contact(table: AsperityTable, layer: int, position_m: float, force_n: float) -> tuple[float, float]:
    """Return the asperity share La, 0 to 1, and the friction coefficient of the lubricated part; clamped to the table.

    Both in one call, since finding the cell costs more than the values.
    """
    positions, loads = table.fluid.shape
    grid = LoadGrid(
        positions, loads, table.line_m, table.start_m, table.per_m, table.floor_n_per_m, table.per_log
    )  # fmt: skip
    corner, a, b = contact_cell(grid, position_m, force_n)
    share = cell_value(table.share[layer].reshape(-1), corner, loads, a, b)
    return share, cell_value(table.fluid.reshape(-1), corner, loads, a, b)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def contact_cell(grid: LoadGrid, position_m: Lanes, force_n: Lanes) -> tuple[Whole, Lanes, Lanes]:
    """Return the cell of a position and a force in a table in row order, and the weights of its upper ends.

    Clamped to the table; numbers or lanes.
    """
    along = smaller(larger((position_m - grid.start_m) * grid.per_m, 0.0), grid.positions - 1.0)
    held = grid.start_m + along / grid.per_m
    load = force_n * grid.line_m / (grid.floor_n_per_m * held * (grid.line_m - held))
    up = smaller(logarithm(larger(load, 1.0)) * grid.per_log, grid.loads - 1.0)
    i, j = smaller(truncated(along), grid.positions - 2), smaller(truncated(up), grid.loads - 2)
    return i * grid.loads + j, along - as_doubles(i), up - as_doubles(j)


@njit(cache=True, _nrt=False, error_model="numpy", forceinline=True)
def cell_value(values: FloatArray, first: Whole, loads: int, a: Lanes, b: Lanes) -> Lanes:
    """Return the value in a cell of a table in row order whose lower corner is `first`, bilinear in the weights."""
    low_0, high_0 = gather_pairs(values, first)
    low_1, high_1 = gather_pairs(values, first + loads)
    low = low_0 * (1.0 - a) + low_1 * a
    return low * (1.0 - b) + (high_0 * (1.0 - a) + high_1 * a) * b


def _check(mesh: LubricatedMesh, range_m: tuple[float, float], points: int) -> None:
    cell = _cell_m(range_m, points)
    last = mesh.line_m if mesh.line_m > 0.0 else np.inf  # a hollow flank has no base point behind the contact
    if not cell < range_m[0] < range_m[1] < last - cell:
        allowed = f"allowed is a rising pair inside 0 to {last:.6g} m by more than a cell"
        raise ValueError(f"range_m: received {range_m}; {allowed}")


# RubbingCourse: how strongly rough flanks excite the mesh over one tooth pitch.
#
# Model: every pair adds its load times its sliding speed to the power p; loads are shared along the path of contact as
# usual for straight teeth, rising from 1/3 to 2/3 where two pairs touch (reference: standard literature). At the pitch
# point a single pair does not slide: there nothing is left.

LEAST_SHARE = 1.0 / 3.0
"""Share of the load where a pair enters and leaves."""


def rubbing_course(pair: GearPair, exponent: float, points: int = 256) -> FloatArray:
    """Return the power (points,) over one base pitch from where a pair enters, of mean 1."""
    ratio = (pair.contact_end_m - pair.contact_start_m) / pair.base_pitch_m
    phase = np.arange(points) / points
    place = phase[None, :] + np.arange(int(np.ceil(ratio)))[:, None]
    share = _shape(place, ratio)
    share /= share.sum(axis=0)
    # sliding is proportional to the distance from the pitch point
    pitch_m = pair.line_of_action_m / (1.0 + pair.gear.teeth / pair.pinion.teeth)
    sliding = np.abs(pair.contact_start_m + place * pair.base_pitch_m - pitch_m)
    power = (share * sliding**exponent).sum(axis=0)
    return np.asarray(power / power.mean())


def _shape(place: FloatArray, ratio: float) -> FloatArray:
    """Return the load of a pair at a place (in base pitches from its entry) before pairs share it; 0 off the path."""
    together = max(ratio - 1.0, 1e-9)
    from_end = np.minimum(place, ratio - place)
    rising = LEAST_SHARE * (1.0 + np.clip(from_end / together, 0.0, 1.0))
    alone = np.where(from_end >= together, 1.0, rising)
    return np.where((place >= 0.0) & (place <= ratio), alone, 0.0)
