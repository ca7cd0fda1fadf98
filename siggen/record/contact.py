"""Tables of the teeth of a drawn specimen in a state: stiffness, and how damage acts on the contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.part import Damage, has_extent
from siggen.gears.face_shares import FaceShares
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import TipRelief
from siggen.mesh.body_coupling import body_coupling
from siggen.mesh.contact_table import ContactTable, contact_table, load_shares
from siggen.mesh.mesh_tables import MeshTables, mesh_tables, pair_kinds, table_of_pair
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.table_options import TableOptions, face_slices
from siggen.mesh.tooth_law import ToothLaw

LEAST_STIFFNESS = 1e-6
"""Of the largest stiffness of a pair; spur teeth are far above."""


@dataclass(frozen=True, slots=True)
class ToothTables:
    """Stiffness by kinds of pairs; with a `contact` that of healthy teeth, and damage acts through the contact.

    `coupling_m_per_n` (apart, points): see `siggen.mesh.body_coupling`; None without.
    """

    tables: MeshTables
    coupling_m_per_n: FloatArray | None
    contact: ContactTable | None = None

    @property
    def sink_depth_m(self) -> float:
        """How far a flank sinks at most where damage leaves no land [m]; not what helical tips miss beside the path."""
        return 0.0 if self.contact is None else float((self.contact.touch_m - self.contact.touch_m[:1]).max())


def tooth_tables(
    law: ToothLaw,
    pair: GearPair,
    damage: Damage,
    options: StiffnessOptions,
    points: int,
    largest_force_n: float,
    lead_m: Callable[[int], FloatArray] | None = None,
) -> ToothTables:
    """Return the tables of the teeth; contacts are tabulated up to the largest force.

    Raises
    ------
    ValueError
        If the stiffness model does not know such damage.
    """
    along = np.linspace(pair.engagement_start_m, pair.engagement_end_m, points)
    coupling = None if options.coupling == "none" else body_coupling(pair, options, along)
    if not law.across_the_face:
        return ToothTables(mesh_tables(pair, damage, options, points=points), coupling)
    face = face_options(law, largest_force_n, pair)
    lead = None if lead_m is None else lead_m(face_slices(pair, face))
    table = contact_table(pair, damage, options, face, points, lead)
    return ToothTables(whole_face(pair, damage, options, points), coupling, table)


def slice_shares(
    law: ToothLaw, pair: GearPair, options: StiffnessOptions, lead_m: Callable[[int], FloatArray] | None
) -> FaceShares | None:
    """Return how slices of helical teeth share a typical load; None for spur teeth, and where no contact is solved."""
    if pair.helix_rad == 0.0 or not law.across_the_face:
        return None
    face = face_options(law, 0.0, pair)
    return load_shares(pair, options, face, None if lead_m is None else lead_m(face_slices(pair, face)))


def face_options(law: ToothLaw, largest_force_n: float, pair: GearPair) -> TableOptions:
    """Return how the contact is tabulated across the face, up to a force [N]."""
    return TableOptions(
        largest_force_n, edge_radius_m=law.edge_radius_m,
        section_loss=law.section_loss, tilts=law.tilts,
        relief=tip_relief(law, pair) if pair.helix_rad != 0.0 else None,
    )  # fmt: skip


def tip_relief(law: ToothLaw, pair: GearPair) -> TipRelief:
    """Return the relief of the teeth of a pair."""
    return TipRelief(law.relief_m, law.relief_pitches * pair.base_pitch_m)


def whole_face(pair: GearPair, damage: Damage, options: StiffnessOptions, points: int) -> MeshTables:
    """Return the healthy stiffness for every kind of pair: what the equations of motion count deviations from."""
    healthy = _healthy_tables(pair, options, points)
    kinds = pair_kinds(tuple(pit for pit in damage if has_extent(pit)))
    # Helical teeth end with no stiffness, but their corners touch beyond: a pair of none would not be in reach there.
    least = LEAST_STIFFNESS * healthy.pair_stiffness_n_per_m.max()
    stiffness = np.repeat(np.maximum(healthy.pair_stiffness_n_per_m, least), len(kinds), axis=0)
    return replace(healthy, pair_stiffness_n_per_m=stiffness, table_of_pair=table_of_pair(pair, kinds))


@lru_cache(maxsize=8)  # states of a specimen share them, of every mesh
def _healthy_tables(pair: GearPair, options: StiffnessOptions, points: int) -> MeshTables:
    return mesh_tables(pair, (), options, points=points)
