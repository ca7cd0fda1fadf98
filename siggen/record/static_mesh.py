"""The quasi-static mesh of a drawn specimen: what its pairs carry at rest, with and without its damage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.on_flank import from_flanks, reach_pitches, with_losses
from siggen.damage.part import NO_TOOTH, Parts
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial, missing_material
from siggen.mesh.contact_table import ContactTable
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.static_mesh import largest_secant_loss, secant_stiffness_n_per_m
from siggen.mesh.tooth_law import ToothLaw
from siggen.record.contact import ToothTables
from siggen.record.friction import light_force_n
from siggen.record.motion import teeth_missing

ROUNDING = 1e-9
"""A loss below this is none: where nothing is missing, sums of pieces differ from those of the whole by some 1e-12."""


@dataclass(frozen=True, slots=True)
class StaticMesh:
    """The pairs of a specimen and state, as they are simulated, at rest and without friction.

    Errors of single teeth are left out: they move the flanks apart by their own amount, so a force over an approach
    would no longer say how stiff the mesh is. Tip relief, corner contact and misalignment are in, and are the same in
    `healthy`.

    Attributes
    ----------
    pair : GearPair
    law, healthy : PairLaw
        With the state's damage, and the same without.
    contact : ContactTable or None
        Where it is solved across the face.
    worn : bool
        Whether flanks of all teeth alike miss material by the state's damage.
    behind : callable or None
        Gives the same of the back flanks, mirrored onto drive flanks; None where damage has taken nothing of them.
    """

    pair: GearPair
    law: PairLaw
    healthy: PairLaw
    contact: ContactTable | None = None
    worn: bool = False
    behind: Callable[[], StaticMesh] | None = None

    def force_n(self, torque_nm: float) -> float:
        """Return the normal force of a torque on the pinion [N]."""
        return torque_nm / self.pair.pinion.base_radius_m

    def stiffness_n_per_m(self, torque_nm: float, pitches: FloatArray) -> FloatArray:
        """Return force over approach (k,) [N/m] at pinion angles (k,) in base pitches since pair 0 entered contact."""
        return secant_stiffness_n_per_m(self.law, self.force_n(torque_nm), pitches)

    def largest_loss(self, torque_nm: float) -> float:
        """Return the largest relative loss of the stiffness at a torque on the pinion, against healthy.

        Below 0 N m back flanks carry. At 0 N m it is the loss under a light contact.
        """
        if torque_nm < 0.0:
            return 0.0 if self.behind is None else self.behind().largest_loss(-torque_nm)
        force_n = self.force_n(torque_nm) if torque_nm > 0.0 else light_force_n(self.pair)
        loss = largest_secant_loss(self.law, self.healthy, force_n, worn=self.worn)
        return loss if loss > ROUNDING else 0.0


def static_mesh(law: ToothLaw, pair: GearPair, teeth: ToothTables, points: int, parts: Parts = ()) -> StaticMesh:
    """Return the static mesh of a pair; `points` as for the tables of missing material.

    What `parts` of the damage take from whole flanks is missing beside the relief, which `healthy` has alone.

    The law linear knows neither relief nor corner contact: its pairs are springs along the path of contact, and their
    stiffness is the mesh stiffness.
    """
    if not law.across_the_face:
        missing = missing_material(pair, None, corner_contact=False, points=2)
    else:
        missing = teeth_missing(law, pair, points)
    losses, without = from_flanks(parts), missing
    if losses:
        without = with_losses(teeth_missing(law, pair, points, reach_pitches(pair, losses)), pair, losses)
    alike = replace(teeth.tables, table_of_pair=np.zeros_like(teeth.tables.table_of_pair), coupled=None)
    # Sinks count from where the flanks of a misaligned pair touch first, or its offset would count as approach.
    contact = None if teeth.contact is None else teeth.contact._replace(lead_m=0.0)
    flush = (
        None
        if contact is None
        else contact._replace(touch_m=contact.touch_m[:1], column=contact.column[:1], gain=contact.gain[:1])
    )
    return StaticMesh(
        pair,
        _law(pair, teeth, without, contact),
        _law(
            pair,
            replace(teeth, tables=replace(alike, pair_stiffness_n_per_m=alike.pair_stiffness_n_per_m[:1])),
            missing,
            flush,
        ),
        contact,
        any(one.tooth == NO_TOOTH for one in losses),
    )


def _law(pair: GearPair, teeth: ToothTables, missing: MissingMaterial, contact: ContactTable | None) -> PairLaw:
    """Return a law for rest: no damping, no friction, and a backlash that only the back flank would meet."""
    return pair_law(
        teeth.tables,
        missing,
        MeshConstants(pair.line_of_action_m, 1.0, pair.base_pitch_m),
        damping_ratio=0.0,
        contact=contact,
        coupling_m_per_n=teeth.coupling_m_per_n,
    )
