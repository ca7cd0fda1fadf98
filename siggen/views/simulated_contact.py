"""What the simulation makes of damage that acts as geometry: how far the flank sinks, how much of the face is land."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.mesh.slice_law import SliceLaw, slice_tables
from siggen.gears.contact.contact_table import ContactTable
from siggen.gears.damage.tooth_damage import Damage, has_extent
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.mesh_tables import pair_kinds, table_of_pair


@dataclass(frozen=True, slots=True)
class SimulatedContact:
    """The contact of one pair of teeth over the angles of a curve, NaN where it is not in contact.

    Attributes
    ----------
    sink_um : (k,) how far the mating flank sinks before anything carries; 0 where a land carries
    land_share : (k,) share of the face that is land
    potential_energy_n_per_m : (k,) what the mesh stiffness would be if damage only took contact length and sections
    """

    sink_um: FloatArray
    land_share: FloatArray
    potential_energy_n_per_m: FloatArray


def simulated_contact(
    pair: GearPair,
    damage: Damage,
    slices: SliceLaw | None,
    contact: ContactTable | None,
    engagement: int,
    position_m: FloatArray,
    potential_energy_n_per_m: FloatArray,
) -> SimulatedContact:
    """Return the contact of one engagement at positions (k,), which may lie off the path of contact.

    Parameters
    ----------
    pair : GearPair
    damage : tuple of Pit or Spall
    slices : SliceLaw or None
        Of this damage; None for flanks without any.
    contact : ContactTable or None
        In place of slices; it knows the sink, but no share of land (NaN).
    engagement : int
        Number of the pair: pinion tooth n mod z1 with gear tooth n mod z2.
    position_m : (k,)
        Position s of the pair on the line of action [m].
    potential_energy_n_per_m : (k,)
    """
    inside = (position_m >= pair.contact_start_m) & (position_m <= pair.contact_end_m)
    sink, land = np.zeros(position_m.size), np.ones(position_m.size)
    if slices is not None:
        rows = slice_tables(pair, damage, slices).table_of_pair
        row = rows[engagement % pair.pinion.teeth, engagement % pair.gear.teeth]
        grid = slices.start_m + np.arange(slices.land.shape[1]) / slices.per_m
        flush = np.interp(position_m, grid, slices.flush[row])
        land = np.interp(position_m, grid, slices.land[row])
        sink = np.where(flush > 0.0, 0.0, np.interp(position_m, grid, slices.sink_m[row, :, 0]))
    if contact is not None:
        kinds = pair_kinds(pair, tuple(pit for pit in damage if has_extent(pit)))
        row = table_of_pair(pair, kinds)[engagement % pair.pinion.teeth, engagement % pair.gear.teeth]
        grid = np.linspace(pair.contact_start_m, pair.contact_end_m, contact.touch_m.shape[1])
        sink, land = np.interp(position_m, grid, contact.touch_m[row]), np.full(position_m.size, np.nan)
    return SimulatedContact(
        np.where(inside, 1e6 * sink, np.nan), np.where(inside, land, np.nan), potential_energy_n_per_m
    )
