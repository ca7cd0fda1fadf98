"""What the simulation makes of damage that acts as geometry: how far the flank sinks, how much of the face is land."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray, IntArray
from siggen.damage.flank_chords import flank_chords
from siggen.damage.part import Damage, has_extent, pits_of
from siggen.gears.gear_pair import GearPair
from siggen.mesh.contact_table import FORCE, SLOPE, ContactTable, node_places_m
from siggen.mesh.face_slices import face_gaps
from siggen.mesh.mesh_tables import pair_kinds, table_of_pair
from siggen.names import Side
from siggen.record.static_mesh import StaticMesh

HALVINGS = 50
"""Of an interval between two approaches of a table: beyond rounding."""
LAND_SLICES = 200


@dataclass(frozen=True, slots=True)
class SimulatedContact:
    """The contact of one pair of teeth over the angles of a curve, NaN where it is not in contact.

    Attributes
    ----------
    sink_um : (k,) how far the mating flank sinks before anything carries; 0 where a land carries
    land_share : (k,) share of the face that is land
    potential_energy_n_per_m : (k,) what the mesh stiffness would be if damage only took contact length and sections
    pair_m_per_n : (k,) approach over force of the pair, alone under the force of a torque: teeth, contact and sink
    """

    sink_um: FloatArray
    land_share: FloatArray
    potential_energy_n_per_m: FloatArray
    pair_m_per_n: FloatArray


def simulated_contact(
    static: StaticMesh,
    contact: ContactTable,
    damage: Damage,
    engagement: int,
    position_m: FloatArray,
    potential_energy_n_per_m: FloatArray,
    torque_nm: float,
) -> SimulatedContact:
    """Return the contact of one engagement at positions (k,), which may lie off the path of contact.

    Parameters
    ----------
    static : StaticMesh
        Of a state with this damage.
    contact : ContactTable
        Of that state.
    damage : tuple of Pit or Spall
    engagement : int
        Number of the pair: pinion tooth n mod z1 with gear tooth n mod z2.
    position_m : (k,)
        Position s of the pair on the line of action [m].
    potential_energy_n_per_m : (k,)
    torque_nm : float
        On the pinion.
    """
    pair = static.pair
    inside = (position_m >= pair.engagement_start_m) & (position_m <= pair.engagement_end_m)
    shown = tuple(pit for pit in damage if has_extent(pit))
    row = table_of_pair(pair, pair_kinds(shown))[engagement % pair.pinion.teeth, engagement % pair.gear.teeth]
    grid = np.linspace(pair.engagement_start_m, pair.engagement_end_m, contact.touch_m.shape[1])
    within, force = position_m[inside], static.force_n(torque_nm)
    sink, land, whole = np.full((3, position_m.size), np.nan)
    sink[inside] = np.interp(within, grid, contact.touch_m[row])
    land[inside] = _land_share(pair, damage, engagement, within)
    whole[inside] = (sink[inside] + _beyond_touch_m(contact, int(row), within, grid, force)) / force
    return SimulatedContact(1e6 * sink, land, potential_energy_n_per_m, whole)


def _land_share(pair: GearPair, damage: Damage, engagement: int, position_m: FloatArray) -> FloatArray:
    """Return the share of the face (k,) on which the contact line lies in no damage of either tooth."""
    pinion, gear = (
        flank_chords(
            pair.member(side),
            pits_of(damage, side, engagement % pair.member(side).teeth),
            pair.face_width_m,
            LAND_SLICES,
        )
        for side in Side
    )
    return np.asarray(1.0 - face_gaps(pair, pinion, gear, position_m).on_damage.mean(axis=1))


def _beyond_touch_m(
    table: ContactTable, row: int, position_m: FloatArray, grid_m: FloatArray, force_n: float
) -> FloatArray:
    """Return the approach beyond first touch (k,) [m] at which a table gives a force: its cubic, halved down to it."""
    place = (position_m - grid_m[0]) / (grid_m[1] - grid_m[0])
    cell = np.clip(place.astype(np.int64), 0, table.column.shape[1] - 1)
    column = table.column[row, cell] + (place - cell) * table.gain[row, cell]
    first: IntArray = np.minimum(column.astype(np.int64), len(table.curves) - 2)
    share = (column - first)[:, None]
    low, high = table.upright[first], table.upright[first + 1]
    force = (1.0 - share) * low[:, :, FORCE] + share * high[:, :, FORCE]
    slope = (1.0 - share) * low[:, :, SLOPE] + share * high[:, :, SLOPE]
    node = node_places_m(table.unit_m, force.shape[1])
    end = np.clip(np.sum(force < force_n, axis=1), 1, node.size - 1)
    rows, step = np.arange(end.size), node[end] - node[end - 1]
    values = (force[rows, end - 1], force[rows, end], slope[rows, end - 1] * step, slope[rows, end] * step)
    low_share, high_share = np.zeros(end.size), np.ones(end.size)
    for _ in range(HALVINGS):
        middle = 0.5 * (low_share + high_share)
        less = _cubic(middle, *values) < force_n
        low_share, high_share = np.where(less, middle, low_share), np.where(less, high_share, middle)
    over = np.maximum(force_n - force[:, -1], 0.0) / slope[:, -1]
    return np.asarray(node[end - 1] + low_share * step + over)


def _cubic(x: FloatArray, start: FloatArray, end: FloatArray, rise: FloatArray, last: FloatArray) -> FloatArray:
    """Return Hermite's cubic at shares x of an interval from its values and its slopes times the interval."""
    return np.asarray(
        (1.0 + 2.0 * x) * (1.0 - x) ** 2 * start
        + x * (1.0 - x) ** 2 * rise
        + x * x * (3.0 - 2.0 * x) * end
        + x * x * (x - 1.0) * last
    )
