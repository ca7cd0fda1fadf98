"""Tables of pair stiffness over the contact position, one row for every distinct kind of tooth pair.

Derived from `siggen.mesh.mesh_stiffness`: compliances of the two teeth add, so each damaged tooth is
integrated once, however many mates it meets; only the contact is evaluated pair by pair.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import lcm

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.damage.flank_damage import pit_rows
from siggen.damage.heights import flank_heights
from siggen.damage.part import Damage, damaged_teeth, pits_of
from siggen.damage.row_columns import HEIGHT, HIGHEST, LOWEST
from siggen.gears.gear_pair import GearPair
from siggen.mesh.body_coupling import CoupledRows, approach_forces, body_coupling, coupled_contributions, neighbour_runs
from siggen.mesh.mesh_stiffness import kinds_stiffness
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.names import Side

HEALTHY = -1
"""Stands for every tooth without damage."""

TABLE_POINTS = 2049
"""Of a table over one path of contact, as simulations use them; `siggen plan` says how exactly they interpolate."""


@dataclass(frozen=True, slots=True)
class MeshTables:
    """Pair stiffness on a uniform grid of contact positions.

    Parameters
    ----------
    start_m, end_m, step_m : float
        First and last position (s_A and s_E, of helical teeth of the middle of the face) and the grid's step [m].
    base_pitch_m : float
        Distance between neighbouring pairs [m].
    pair_stiffness_n_per_m : (tables, points)
        One row per distinct kind of pair; row 0 is the healthy one [N/m].
    table_of_pair : (z1, z2) int32
        Row for pinion tooth i with gear tooth j.
    coupled : CoupledRows or None
        What pairs add to the mesh stiffness when they deflect each other; None: their own stiffness.
    """

    start_m: float
    end_m: float
    step_m: float
    base_pitch_m: float
    pair_stiffness_n_per_m: FloatArray
    table_of_pair: NDArray[np.int32]
    coupled: CoupledRows | None = None

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        self.pair_stiffness_n_per_m.setflags(write=False)
        self.table_of_pair.setflags(write=False)

    @property
    def contributions_n_per_m(self) -> FloatArray:
        """What a pair adds to the mesh stiffness, (rows, points); row 0 is the healthy one [N/m]."""
        return self.pair_stiffness_n_per_m if self.coupled is None else self.coupled.stiffness_n_per_m

    @property
    def row_of_pair(self) -> NDArray[np.int32]:
        """Row of the contributions for pinion tooth i with gear tooth j, (z1, z2)."""
        return self.table_of_pair if self.coupled is None else self.coupled.row_of_pair


def mesh_tables(pair: GearPair, damage: Damage, options: StiffnessOptions, points: int = TABLE_POINTS) -> MeshTables:
    """Return the tables of a pair with damage on any teeth of either gear.

    Parameters
    ----------
    pair : GearPair
    damage : tuple of ToothDamage
    options : StiffnessOptions
    points : int
        Grid points from first to last contact, at least 2.

    Raises
    ------
    ValueError
        If pits leave no contact or no section.
    """
    kinds = pair_kinds(damage)
    position = np.linspace(pair.engagement_start_m, pair.engagement_end_m, points)
    rows = table_of_pair(pair, kinds)
    alone = kind_stiffness(pair, damage, options, kinds, position)
    coupled = None if options.coupling == "none" else _coupled(pair, damage, options, rows, position, alone)
    return MeshTables(
        start_m=pair.engagement_start_m,
        end_m=pair.engagement_end_m,
        step_m=(pair.engagement_end_m - pair.engagement_start_m) / (points - 1),
        base_pitch_m=pair.base_pitch_m,
        pair_stiffness_n_per_m=alone,
        table_of_pair=rows,
        coupled=coupled,
    )


def _coupled(
    pair: GearPair,
    damage: Damage,
    options: StiffnessOptions,
    table_of_pair: NDArray[np.int32],
    position_m: FloatArray,
    alone: FloatArray,
) -> CoupledRows:
    runs, row_of_pair = neighbour_runs(pair, table_of_pair)
    of_kinds = partial(kind_stiffness, pair, damage, options, pair_kinds(damage))
    rows = coupled_contributions(pair, options, runs, of_kinds, position_m, alone)
    return CoupledRows(rows, row_of_pair, body_coupling(pair, options, position_m))


def pair_kinds(damage: Damage) -> tuple[tuple[int, int], ...]:
    """Return the distinct pairs as (pinion tooth, gear tooth), HEALTHY for any undamaged tooth; healthy ones first."""
    pinion, gear = damaged_teeth(damage, Side.DRIVER), damaged_teeth(damage, Side.DRIVEN)
    single = [(i, HEALTHY) for i in pinion] + [(HEALTHY, j) for j in gear]
    return ((HEALTHY, HEALTHY), *single, *((i, j) for i in pinion for j in gear))


def kind_stiffness(
    pair: GearPair,
    damage: Damage,
    options: StiffnessOptions,
    kinds: tuple[tuple[int, int], ...],
    position_m: FloatArray,
    *,
    through_face: bool = False,
) -> FloatArray:
    """Return the pair stiffness of each kind at positions (k,), (kinds, k) [N/m].

    Parameters
    ----------
    pair : GearPair
    damage : tuple of ToothDamage
    options : StiffnessOptions
    kinds : tuple of (int, int)
        Pinion tooth and gear tooth of each kind, HEALTHY for any undamaged one.
    position_m : (k,)
        Positions as for `kinds_stiffness`, in any order [m].
    through_face : bool
        Whether pits may leave no contact; the pair's stiffness is 0 there.

    Raises
    ------
    ValueError
        If a position is off the path of contact, or pits leave no section, or no contact where that is not allowed.
    """
    damages = [(pits_of(damage, Side.DRIVER, first), pits_of(damage, Side.DRIVEN, second)) for first, second in kinds]
    return kinds_stiffness(pair, position_m, options, damages, through_face=through_face)


def table_of_pair(pair: GearPair, kinds: tuple[tuple[int, int], ...]) -> NDArray[np.int32]:
    """Return the row (z1, z2) of `kinds` (see `pair_kinds`) for every pair of teeth."""
    table = np.zeros((pair.pinion.teeth, pair.gear.teeth), dtype=np.int32)
    # Kinds with two damaged teeth come last and overwrite the rows of the single ones.
    for row, (first, second) in enumerate(kinds):
        if row:
            rows = slice(None) if first == HEALTHY else first
            columns = slice(None) if second == HEALTHY else second
            table[rows, columns] = row
    return table


def largest_stiffness_loss(pair: GearPair, damage: Damage, options: StiffnessOptions) -> float:
    """Return max (K_healthy - K_damaged)/K_healthy of the mesh over the angle of a whole hunting period.

    Derived: the newest pair's position covers one base pitch while older pairs follow one pitch ahead each; every
    sequence of kinds of pairs that occurs is searched on a grid with pit centres, pits' ends and zone edges, and the
    highest peaks are refined. A pair whose contact loses its whole length carries nothing, so damage through the face
    loses 1 where it is the only pair, and the pair's share of the mesh where another one is in contact.

    Raises
    ------
    ValueError
        If a damaged tooth does not exist, or pits leave no section.
    """
    if not damage:
        return 0.0
    kinds = pair_kinds(damage)
    sequences = _sequences(pair, table_of_pair(pair, kinds))
    grid = _newest_positions(pair, damage)
    for _ in range(5):
        losses = np.max(_losses(pair, damage, options, kinds, sequences, grid), axis=0)
        best = float(np.max(losses))
        grid = _around_peaks(grid, losses)
    return best


def _around_peaks(grid: FloatArray, losses: FloatArray) -> FloatArray:
    """Return a finer grid around the peaks that may still be the highest once resolved (k,) [m]."""
    padded = np.concatenate([[-np.inf], losses, [-np.inf]])
    peaks = np.flatnonzero((losses >= padded[:-2]) & (losses >= padded[2:]) & (losses >= 0.999 * np.max(losses)))
    highest = peaks[np.argsort(-losses[peaks], kind="stable")[:6]]
    low, high = grid[np.maximum(highest - 1, 0)], grid[np.minimum(highest + 1, grid.size - 1)]
    return np.unique(np.concatenate([np.linspace(low, high, 17).ravel(), grid[highest]]))


def _sequences(pair: GearPair, table: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the distinct runs of table rows (newest pair first) that touch damage, (runs, pairs)."""
    count = np.arange(lcm(pair.pinion.teeth, pair.gear.teeth))
    older = np.arange(int(pair.total_contact_ratio) + 1)
    number = count[:, np.newaxis] - older
    runs = np.unique(table[number % pair.pinion.teeth, number % pair.gear.teeth], axis=0)
    return runs[np.any(runs > 0, axis=1)]


def _newest_positions(pair: GearPair, damage: Damage) -> FloatArray:
    """Return positions of the newest pair over one base pitch, with zone edges, centres and ends of damage (k,) [m]."""
    start, end, pitch = pair.engagement_start_m, pair.engagement_end_m, pair.base_pitch_m
    marks = [np.array([start, end, np.nextafter(end, np.inf)])]
    for side in Side:
        gear = pair.member(side)
        rows = pit_rows(pit for pit in damage if pit.gear == side)
        ends = np.concatenate([rows[:, HEIGHT], rows[:, LOWEST], rows[:, HIGHEST]])
        low, high = flank_heights(gear)
        travel = np.asarray(gear.roll_at_height(np.clip(ends, low, high))) * gear.base_radius_m
        marks.append(travel if side == Side.DRIVER else pair.line_of_action_m - travel)
    # Within 1e-6 of a pitch two marks are one: hundreds of pits would otherwise crowd the grid.
    folded = (np.concatenate(marks) - start) % pitch
    folded = folded[np.unique(np.round(folded / (1e-6 * pitch)), return_index=True)[1]]
    return np.unique(np.concatenate([np.linspace(start, start + pitch, 769), start + folded]))


def _losses(
    pair: GearPair,
    damage: Damage,
    options: StiffnessOptions,
    kinds: tuple[tuple[int, int], ...],
    sequences: NDArray[np.int32],
    newest_m: FloatArray,
) -> FloatArray:
    """Return the relative loss of mesh stiffness of each run of pairs at positions of its newest pair, (runs, k)."""
    healthy = np.zeros(newest_m.size)
    damaged = np.zeros((sequences.shape[0], newest_m.size))
    position = newest_m + np.arange(sequences.shape[1])[:, np.newaxis] * pair.base_pitch_m
    inside = position <= pair.engagement_end_m
    alone = np.zeros((len(kinds), *position.shape))
    alone[:, inside] = kind_stiffness(pair, damage, options, kinds, position[inside], through_face=True)
    if options.coupling == "none":
        for older in range(sequences.shape[1]):
            healthy += alone[0, older]
            damaged += alone[sequences[:, older], older]
        return 1.0 - damaged / healthy
    pairs = np.count_nonzero(inside, axis=0)
    for number in np.unique(pairs):
        chosen = np.flatnonzero(pairs == number)
        runs = np.vstack([np.zeros_like(sequences[:1]), sequences])[:, :number]
        every = alone[runs[:, :, np.newaxis], np.arange(number)[:, np.newaxis], chosen]
        total = approach_forces(pair, options, newest_m[chosen], every).sum(axis=1)
        healthy[chosen], damaged[:, chosen] = total[0], total[1:]
    return 1.0 - damaged / healthy
