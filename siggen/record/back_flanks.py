"""Back flanks of a drawn specimen: they carry torques below 0, as drive flanks of the mirrored pair.

Damage is on drive flanks, so back flanks are healthy, but for what is gone through a tooth: it is the same metal. Their
contact is solved across the face as that of drive flanks. Helix slopes and misaligned shafts move the far end of a
tooth as a whole: its back flank comes nearer there by what its drive flank misses. Crowning is the same on both.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import TypeAlias

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.on_flank import Losses, from_flanks, on_back_flanks, takes_from_flanks, turned
from siggen.damage.part import NO_TOOTH, Parts, acts_on_tooth, goes_through, on_teeth
from siggen.drivetrain.structure import on_back_flanks as seen_from_behind
from siggen.gears.back_flanks import back_flanks, driven_pair, pitches_ahead
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial
from siggen.mesh.mesh_tables import TABLE_POINTS
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_law import ToothLaw
from siggen.names import Side
from siggen.record.contact import slice_shares, tooth_tables
from siggen.record.motion import SpecimenMesh
from siggen.record.static_mesh import StaticMesh, static_mesh
from siggen.record.teeth import WavyTeeth

Lead: TypeAlias = Callable[[int], FloatArray] | None


def on_both_flanks(parts: Parts) -> Parts:
    """Return the parts that have taken the back flank with the drive flank."""
    return tuple(
        one
        for one in parts
        if (acts_on_tooth(one) and goes_through(one)) or (takes_from_flanks(one) and one.tooth != NO_TOOTH)
    )


def with_static_back(
    mesh: StaticMesh,
    law: ToothLaw,
    options: StiffnessOptions,
    largest_force_n: float,
    lead_m: Lead,
    parts: Parts,
) -> StaticMesh:
    """Return a mesh at rest with that of its back flanks, if `parts` have taken any; arguments of `tooth_tables`.

    Seen in a mirror back flanks are drive flanks, whose teeth count the other way round.
    """
    pair = mesh.pair
    mirrored = tuple(
        replace(one, tooth=-one.tooth % pair.member(Side(one.gear)).teeth)  # type: ignore[type-var]
        for one in on_both_flanks(parts)
    )
    if not mirrored:
        return mesh

    @cache
    def behind() -> StaticMesh:
        lead = _seen_from_behind(lead_m)
        teeth = tooth_tables(law, pair, on_teeth(mirrored), options, TABLE_POINTS, largest_force_n, lead)
        return static_mesh(law, pair, teeth, TABLE_POINTS, mirrored)

    return replace(mesh, behind=behind)


def _seen_from_behind(lead_m: Lead) -> Lead:
    return None if lead_m is None else lambda slices: np.ascontiguousarray(lead_m(slices)[::-1])


class BackTeeth:
    """Missing material of back flanks, under a torque of the gear; `teeth` are those before single ones lost any."""

    def __init__(self, teeth: WavyTeeth, pair: GearPair, losses: Losses) -> None:
        self._teeth, self._pair, self._losses = teeth, pair, losses

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the gear."""
        ratio = self._pair.pinion.teeth / self._pair.gear.teeth
        back = back_flanks(self._teeth.under(torque_nm * ratio), self._pair)
        return on_back_flanks(back, driven_pair(self._pair), self._losses)


def with_back_flanks(
    mesh: SpecimenMesh,
    law: ToothLaw,
    options: StiffnessOptions,
    largest_force_n: float,
    lead_m: Lead,
    teeth: WavyTeeth,
    parts: Parts = (),
) -> SpecimenMesh:
    """Return the mesh with its back flanks, which are made when a torque asks for them; arguments of `tooth_tables`.

    `teeth` are those before single ones lost any, `parts` the damage of the state.
    """
    pair = mesh.pair

    @cache
    def back() -> SpecimenMesh:
        driven = driven_pair(pair)
        gone = tuple(turned(one, driven) for one in on_teeth(on_both_flanks(parts)))
        found = tooth_tables(law, driven, gone, options, TABLE_POINTS, largest_force_n, _seen_from_behind(lead_m))
        return SpecimenMesh(
            driven,
            seen_from_behind(mesh.structure, pitches_ahead(pair)),
            # rows by the teeth of the pinion first, as everywhere
            replace(found.tables, table_of_pair=np.ascontiguousarray(found.tables.table_of_pair.T)),
            BackTeeth(teeth, pair, from_flanks(parts)),
            found.coupling_m_per_n,
            found.contact,
            slice_shares(law, driven, options, _seen_from_behind(lead_m)),
        )

    return replace(mesh, back=back)
