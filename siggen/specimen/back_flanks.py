"""Back flanks of a drawn specimen: they carry torques below 0, as drive flanks of the mirrored pair.

Damage is on drive flanks, so back flanks are healthy, but for what is gone through a tooth: it is the same metal. Their
contact is solved across the face as that of drive flanks. Helix slopes and misaligned shafts move the far end of a
tooth as a whole: its back flank comes nearer there by what its drive flank misses. Crowning is the same on both.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Dynamics
from siggen.dynamics.structure.back_flanks import on_back_flanks as seen_from_behind
from siggen.gears.damage.flank_loss import Losses, from_flanks, on_back_flanks, turned
from siggen.gears.damage.part import Parts
from siggen.gears.damage.tooth_damage import goes_through, on_teeth
from siggen.gears.geometry.back_flanks import back_flanks, driven_pair, pitches_ahead
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.specimen.contact import tooth_tables
from siggen.specimen.flank_waves import WavyTeeth
from siggen.specimen.motion import SpecimenMesh


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
    dynamics: Dynamics,
    options: StiffnessOptions,
    largest_force_n: float,
    lead_m: Callable[[int], FloatArray] | None,
    teeth: WavyTeeth,
    parts: Parts = (),
) -> SpecimenMesh:
    """Return the mesh with its back flanks, which are made when a torque asks for them; arguments of `tooth_tables`.

    `teeth` are those before single ones lost any, `parts` the damage of the state.
    """
    pair = mesh.pair

    @cache
    def back() -> SpecimenMesh:
        lead = None if lead_m is None else lambda slices: np.ascontiguousarray(lead_m(slices)[::-1])
        driven = driven_pair(pair)
        gone = tuple(turned(one, driven) for one in on_teeth(parts) if goes_through(one))
        found = tooth_tables(dynamics, driven, gone, options, TABLE_POINTS, largest_force_n, lead)
        return SpecimenMesh(
            driven,
            seen_from_behind(mesh.structure, pair.line_of_action_m, pitches_ahead(pair)),
            # rows by the teeth of the pinion first, as everywhere
            replace(found.tables, table_of_pair=np.ascontiguousarray(found.tables.table_of_pair.T)),
            BackTeeth(teeth, pair, from_flanks(parts)),
            found.coupling_m_per_n,
            found.contact,
        )

    return replace(mesh, back=back)
