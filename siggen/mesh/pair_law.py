"""PairLaw: the mesh force as a sum over tooth pairs, each with its own stiffness, missing material and friction.

Equations (reference: standard literature; load sharing, friction and contact of pitted flanks as paper B names them:
Luo, Baddour, Liang, MSSP 119 (2019) 155-181): with the approach x along the line of action and d_n = x - e_n

    drive flank:                   N_n = max(0, f_n(p_n) + c_n ẋ) where f_n(p_n) > 0,   p_n = d_n - Σ_m c_nm N_m
    back flank, d_n < 0:          N_n = min(0, k_n p_n + c_n ẋ),  d_n = x - 2 e_p + e_n + j     e_p: place of the teeth
    c_n = 2 ζ √(Σk m_e) k_n/Σk     over the pairs that touch, k = f' (Kasuba and Evans 1981: constant ratio)
    F_n = μ_n |N_n| tanh(v_n/v_0), v_n = sliding of the pinion's flank on the gear's (`friction`)

Slices of a helical pair before and behind the pitch point slide against each other: F is the sum of both parts, each
with its share of the load, at the mean of its places, so that forces and moments of a constant μ are those of all
slices (derived).

Of the two flanks of a tooth both miss relief and corners, and where one is behind its place the other is ahead: x - e_p
+ (e_n - e_p). The law belongs to the flanks that carry a torque; those behind them are simple: they push along the same
line, where these touch, and are sound.

f_n(p) is the force of the contact solved across the face (`contact_spring`), or k_n p without a table of it. c_nm is
the deflection at one pair per unit force at another, through the gear bodies that they share; 0 without coupling.
Positions are in base pitches, as in `mesh_force`; outside the path
of contact the stiffness is that of its end. Load sharing is N_n/ΣN and needs no formula of its own.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.mesh.friction import FrictionLaw
from siggen.mesh.packed_tables import PackedTables

if TYPE_CHECKING:
    from siggen.gears.missing_material import MissingMaterial
    from siggen.mesh.contact_table import ContactTable
    from siggen.mesh.mesh_tables import MeshTables
    from siggen.mesh.tooth_law import DampingLaw

_scalar = count()
"""Places of single numbers in `PairLaw.scalars`."""
CONTACT_RATIO = next(_scalar)  # length of the path of contact [base pitches]
PER_PITCH = next(_scalar)  # intervals of the tables per base pitch
MISSING_PER_PITCH = next(_scalar)  # the same of missing material
REACH_BEFORE = next(_scalar)  # how far before the path of contact teeth may touch [base pitches]
REACH_AFTER = next(_scalar)
START_M = next(_scalar)  # beginning of the path of contact
PITCH_M = next(_scalar)  # base pitch
LINE_M = next(_scalar)  # line of action
DAMPING_ROOT = next(_scalar)  # 2 ζ √m_e; where its parts count, their mean
BACKLASH_M = next(_scalar)
LEAD_M = next(_scalar)  # missing material of all pairs by their lead
DAMPING_STRUCTURE = next(_scalar)  # parts of the damper by the share that asperities carry
DAMPING_FILM = next(_scalar)
DAMPING_ASPERITIES = next(_scalar)
SLIP_SPEED = next(_scalar)  # v_0
BOUNDARY = next(_scalar)  # friction coefficient of asperities
LUBRICATED_LINE = next(_scalar)  # the table of friction, see `LoadGrid`
LUBRICATED_START = next(_scalar)
LUBRICATED_PER_M = next(_scalar)
LUBRICATED_FLOOR = next(_scalar)
LUBRICATED_PER_LOG = next(_scalar)
CONTACT_HALF_FACE = next(_scalar)  # half the face width where gears tilt, else 0 [m]
CONTACT_UNIT = next(_scalar)  # approach of its second node [m]
SCALARS = next(_scalar)

_place = count()
"""Places in the head of `PairLaw.places`."""
TEETH_1 = next(_place)  # counts
TEETH_2 = next(_place)
POINTS = next(_place)  # of the tables of stiffness, first touch and coupling
MISSING_POINTS = next(_place)
APART = next(_place)  # 0: no coupling
ROUGHNESSES = next(_place)  # 0: no friction
LUBRICATED_POSITIONS = next(_place)
LUBRICATED_LOADS = next(_place)
SHARE_DAMPS = next(_place)  # 1: the damper has parts
STIFFNESS_AT = next(_place)  # where tables begin in `numbers`
MISSING_1_AT = next(_place)
MISSING_2_AT = next(_place)
OFFSET_1_AT = next(_place)
OFFSET_2_AT = next(_place)
COUPLING_AT = next(_place)
SHARE_AT = next(_place)
FLUID_AT = next(_place)
TABLE_AT = next(_place)  # where tables begin in `places` itself
KIND_1_AT = next(_place)
KIND_2_AT = next(_place)
CONTACT_NODES = next(_place)  # 0: no table of the contact across the face
CONTACT_COLUMNS = next(_place)
TOUCH_AT = next(_place)  # in `numbers` again
COLUMN_AT = next(_place)
GAIN_AT = next(_place)
CURVES_AT = next(_place)
CONTACT_VALUES = next(_place)  # per node; 4 without tilt, 8 for every ray with
SPREAD_AT = next(_place)  # of helical pairs, `FaceShares.about`; 0: all slices are at one place
HEAD = next(_place)


class PairLaw(NamedTuple):
    """All that the compiled pair law needs, in three arrays (see `packed_tables` for the reason).

    `scalars` (SCALARS,), `numbers` (k,) all tables in a row, `places` (k,) where they begin and the teeth's rows.
    """

    scalars: FloatArray
    numbers: FloatArray
    places: NDArray[np.int64]

    @property
    def teeth(self) -> int:
        """Teeth of the pinion."""
        return int(self.places[TEETH_1])

    @property
    def slots(self) -> int:
        """How many pairs can be in reach at once; pair n has slot n mod slots during its whole engagement."""
        return int(np.floor(self.scalars[REACH_BEFORE] + self.scalars[CONTACT_RATIO] + self.scalars[REACH_AFTER])) + 1

    @property
    def base_pitch_m(self) -> float:
        """Distance of neighbouring pairs [m]."""
        return float(self.scalars[PITCH_M])

    @property
    def line_of_action_m(self) -> float:
        """Length T of the line of action [m]."""
        return float(self.scalars[LINE_M])

    @property
    def half_face_m(self) -> float:
        """Half the face width where gears tilt, else 0 [m]."""
        return float(self.scalars[CONTACT_HALF_FACE])

    @property
    def backlash_m(self) -> float:
        """Total normal backlash [m]."""
        return float(self.scalars[BACKLASH_M])

    @property
    def damping_root_kg(self) -> float:
        """2 ζ √m_e in √kg; where the ratio depends on the lubrication, of its part that is always there."""
        return float(self.scalars[DAMPING_ROOT])


class MeshConstants(NamedTuple):
    """Length T of the line of action, mass that the mesh feels, total normal backlash.

    `spread` (3, points), on the grid of the tables: `FaceShares.about` the pitch point of a helical pair.
    """

    line_of_action_m: float
    equivalent_mass_kg: float
    backlash_m: float
    spread: FloatArray | None = None


def pair_law(
    tables: MeshTables,
    missing: MissingMaterial,
    mesh: MeshConstants,
    *,
    damping_ratio: float | DampingLaw,
    friction: FrictionLaw | None = None,
    contact: ContactTable | None = None,
    coupling_m_per_n: FloatArray | None = None,
) -> PairLaw:
    """Return the law of these tables.

    Parameters
    ----------
    tables : MeshTables
        Stiffness of single pairs; with a contact, of pairs whose whole face is in contact.
    missing : MissingMaterial
    mesh : MeshConstants
    damping_ratio : float or DampingLaw
        ζ, or its parts by the share of the load that asperities carry, which needs a friction law with such a table.
    friction : FrictionLaw or None
    contact : ContactTable or None
        On the grid of `tables`: forces of all pairs with the contact solved across the face; None: springs.
    coupling_m_per_n : (apart, points) or None
        Deflection at one pair per unit force at the pair a + 1 base pitches away, over the position of the pair that
        entered later, on the grid of `tables` [m/N].

    Raises
    ------
    ValueError
        If tables do not fit together.
    """
    _check(tables, missing)
    packed = PackedTables(HEAD)
    scalars = np.zeros(SCALARS)
    pitch, ratio = tables.base_pitch_m, (tables.end_m - tables.start_m) / tables.base_pitch_m
    points, missing_points = tables.pair_stiffness_n_per_m.shape[1], missing.pinion.profile_m.shape[1]
    scalars[CONTACT_RATIO], scalars[PER_PITCH] = ratio, (points - 1) / ratio
    scalars[MISSING_PER_PITCH] = (missing_points - 1) * pitch / (missing.end_m - missing.start_m)
    scalars[REACH_BEFORE] = max(0.0, (tables.start_m - missing.start_m) / pitch)
    scalars[REACH_AFTER] = max(0.0, (missing.end_m - tables.end_m) / pitch)
    scalars[START_M], scalars[PITCH_M], scalars[LINE_M] = tables.start_m, pitch, mesh.line_of_action_m
    scalars[BACKLASH_M] = mesh.backlash_m
    _pack_teeth(packed, tables, missing)
    if contact is not None:
        _pack_contact(packed, scalars, contact, tables)
    if coupling_m_per_n is not None:
        _pack_coupling(packed, coupling_m_per_n, points)
    if mesh.spread is not None:
        if mesh.spread.shape != (3, points):
            raise ValueError(f"spread: received shape {mesh.spread.shape}; allowed: (3, {points})")
        packed.add(SPREAD_AT, mesh.spread)
    if friction is not None:
        _pack_friction(packed, scalars, friction)
    _pack_damping(packed, scalars, damping_ratio, float(np.sqrt(mesh.equivalent_mass_kg)))
    scalars.setflags(write=False)
    return PairLaw(scalars, packed.numbers, packed.index)


def _check(tables: MeshTables, missing: MissingMaterial) -> None:
    if min(tables.start_m - missing.start_m, missing.end_m - tables.end_m) < -1e-9 * tables.base_pitch_m:
        raise ValueError(
            f"missing material: received tables from {missing.start_m} m to {missing.end_m} m; allowed are tables "
            f"from {tables.start_m} m or before to {tables.end_m} m or after"
        )


def _pack_teeth(packed: PackedTables, tables: MeshTables, missing: MissingMaterial) -> None:
    packed.head(TEETH_1, tables.table_of_pair.shape[0])
    packed.head(TEETH_2, tables.table_of_pair.shape[1])
    packed.head(POINTS, tables.pair_stiffness_n_per_m.shape[1])
    packed.head(MISSING_POINTS, missing.pinion.profile_m.shape[1])
    packed.add(STIFFNESS_AT, tables.pair_stiffness_n_per_m)
    packed.add_index(TABLE_AT, tables.table_of_pair)
    places = ((MISSING_1_AT, OFFSET_1_AT, KIND_1_AT), (MISSING_2_AT, OFFSET_2_AT, KIND_2_AT))
    for (profile, offset, kind), teeth in zip(places, (missing.pinion, missing.gear), strict=True):
        packed.add(profile, teeth.profile_m)
        packed.add(offset, teeth.offset_m)
        packed.add_index(kind, teeth.kind_of_tooth)


def _pack_contact(packed: PackedTables, scalars: FloatArray, contact: ContactTable, tables: MeshTables) -> None:
    if contact.touch_m.shape != tables.pair_stiffness_n_per_m.shape:
        raise ValueError(
            f"contact: received tables of shape {contact.touch_m.shape}; allowed are those of the stiffness, "
            f"{tables.pair_stiffness_n_per_m.shape}"
        )
    packed.head(CONTACT_COLUMNS, contact.curves.shape[0])
    packed.head(CONTACT_NODES, contact.curves.shape[1])
    packed.head(CONTACT_VALUES, contact.curves.shape[2] * contact.curves.shape[3])
    for place, values in (
        (TOUCH_AT, contact.touch_m), (COLUMN_AT, contact.column), (GAIN_AT, contact.gain), (CURVES_AT, contact.curves),
    ):  # fmt: skip
        packed.add(place, values)
    scalars[CONTACT_UNIT], scalars[LEAD_M] = contact.unit_m, contact.lead_m
    scalars[CONTACT_HALF_FACE] = contact.half_face_m


def _pack_coupling(packed: PackedTables, coupling_m_per_n: FloatArray, points: int) -> None:
    table = np.asarray(coupling_m_per_n, dtype=np.float64)
    if table.ndim != 2 or table.shape[1] != points or not np.isfinite(table).all():
        raise ValueError(
            f"coupling_m_per_n: received shape {table.shape}; allowed are finite tables of shape (apart, {points})"
        )
    packed.head(APART, table.shape[0])
    packed.add(COUPLING_AT, table)


def _pack_friction(packed: PackedTables, scalars: FloatArray, friction: FrictionLaw) -> None:
    table = friction.table
    packed.head(ROUGHNESSES, table.share.shape[0])
    packed.head(LUBRICATED_POSITIONS, table.fluid.shape[0])
    packed.head(LUBRICATED_LOADS, table.fluid.shape[1])
    packed.add(SHARE_AT, table.share)
    packed.add(FLUID_AT, table.fluid)
    scalars[SLIP_SPEED], scalars[BOUNDARY] = friction.slip_speed_m_s, friction.boundary
    scalars[LUBRICATED_LINE], scalars[LUBRICATED_START] = table.line_m, table.start_m
    scalars[LUBRICATED_PER_M], scalars[LUBRICATED_FLOOR] = table.per_m, table.floor_n_per_m
    scalars[LUBRICATED_PER_LOG] = table.per_log


def _pack_damping(packed: PackedTables, scalars: FloatArray, ratio: float | DampingLaw, root: float) -> None:
    """Write 2 ζ √m_e, or its three parts."""
    if isinstance(ratio, (int, float)):
        scalars[DAMPING_ROOT] = 2.0 * float(ratio) * root
        return
    if packed.index[ROUGHNESSES] == 0:
        raise ValueError("damping_ratio: received parts by asperity share without a friction law; allowed: with one")
    packed.head(SHARE_DAMPS, 1)
    scalars[DAMPING_STRUCTURE], scalars[DAMPING_FILM] = 2.0 * ratio.structure * root, 2.0 * ratio.film * root
    scalars[DAMPING_ASPERITIES] = 2.0 * ratio.asperities * root
    scalars[DAMPING_ROOT] = scalars[DAMPING_STRUCTURE] + 0.5 * (scalars[DAMPING_FILM] + scalars[DAMPING_ASPERITIES])
