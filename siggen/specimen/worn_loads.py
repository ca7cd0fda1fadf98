"""The load under which the flanks of a drawn specimen wear: of teeth without errors, at rest.

Pairs are springs of the whole face; what a contact solved across the face changes of their sharing is below what a wear
coefficient is known to.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.dynamics.mesh.static_loads import loads_at_rest
from siggen.dynamics.mesh.tooth_law import ToothLaw
from siggen.gears.damage.wear import AtRest, LoadAtRest
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial, MissingTables
from siggen.gears.stiffness.body_coupling import body_coupling
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.specimen.contact import whole_face
from siggen.specimen.motion import teeth_missing


def load_at_rest(law: ToothLaw, pair: GearPair, options: StiffnessOptions, force_n: float) -> LoadAtRest:
    """Return the load of a pair over its path, under a force of all pairs [N]."""
    missing = teeth_missing(law, pair, TABLE_POINTS)

    def load(position_m: FloatArray, pinion_m: FloatArray, gear_m: FloatArray) -> AtRest:
        law = _law(pair, options, _worn(missing, position_m, pinion_m, gear_m))
        loads, penetrations = loads_at_rest(law, force_n, (position_m - pair.contact_start_m) / pair.base_pitch_m)
        return AtRest(loads, float(penetrations.max()))

    return load


def _law(pair: GearPair, options: StiffnessOptions, missing: MissingMaterial) -> PairLaw:
    along = np.linspace(pair.contact_start_m, pair.contact_end_m, TABLE_POINTS)
    return pair_law(
        whole_face(pair, (), options, TABLE_POINTS),
        missing,
        MeshConstants(pair.line_of_action_m, 1.0, pair.base_pitch_m),
        damping_ratio=0.0,
        coupling_m_per_n=None if options.coupling == "none" else body_coupling(pair, options, along),
    )


def _worn(
    missing: MissingMaterial, position_m: FloatArray, pinion_m: FloatArray, gear_m: FloatArray
) -> MissingMaterial:
    places = np.linspace(missing.start_m, missing.end_m, missing.pinion.profile_m.shape[1])

    def with_depths(teeth: MissingTables, depths_m: FloatArray) -> MissingTables:
        return replace(teeth, profile_m=teeth.profile_m + np.interp(places, position_m, depths_m))

    return replace(missing, pinion=with_depths(missing.pinion, pinion_m), gear=with_depths(missing.gear, gear_m))
