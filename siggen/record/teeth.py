"""MeshTeeth: missing material and damage of the teeth of one mesh, computed once for all states that share them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, lru_cache, partial

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.flank_wear import AtRest, LoadAtRest
from siggen.damage.on_flank import Losses, from_flanks, reach_pitches, with_losses
from siggen.damage.part import NO_TOOTH, Parts
from siggen.gearbox.flank_waves import SpecimenWaves
from siggen.gearbox.specimen import Specimen
from siggen.gearbox.teeth import SpecimenErrors, Teeth, erroneous_teeth, lead_of
from siggen.gears.face_shares import FaceShares
from siggen.gears.flank_waves import with_waves
from siggen.gears.gear_pair import GearPair
from siggen.gears.missing_material import MissingMaterial, MissingTables
from siggen.mesh.body_coupling import body_coupling
from siggen.mesh.mesh_tables import TABLE_POINTS
from siggen.mesh.pair_law import MeshConstants, PairLaw, pair_law
from siggen.mesh.static_mesh import loads_at_rest
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_law import ToothLaw
from siggen.record.contact import slice_shares, whole_face
from siggen.record.motion import teeth_missing

# WavyTeeth: teeth whose flank waves a record's own torque smooths.

LEAST_LINE_LOAD_N_PER_M = 1e3
"""Where there is next to no torque: a Hertz band of some 10 µm."""
KEPT_POINTS = 8
"""Operating points whose waves are kept, each of some megabytes; states and repeats share them."""


class WavyTeeth:
    """Missing material of teeth with waves, which the Hertz band of a record's own torque smooths."""

    def __init__(
        self,
        missing: MissingMaterial,
        pair: GearPair,
        waves: SpecimenWaves | None = None,
        shares: FaceShares | None = None,
    ) -> None:
        self._plain, self._pair, self._waves, self._shares = missing, pair, waves, shares
        # not over instances: what belongs to a gearbox ends with it
        self._with_waves = lru_cache(maxsize=KEPT_POINTS)(self._smoothed)

    def under(self, torque_nm: float) -> MissingMaterial:
        """Return the missing material in contact under a torque at the pinion."""
        return self._with_waves(abs(torque_nm))

    def _smoothed(self, torque_nm: float) -> MissingMaterial:
        if self._waves is None:
            return self._plain
        pair = self._pair
        load = max(torque_nm / pair.pinion.base_radius_m / pair.face_width_m, LEAST_LINE_LOAD_N_PER_M)
        return with_waves(self._plain, pair, self._waves.pinion, self._waves.gear, load, self._shares)


# The load under which the flanks of a drawn specimen wear: of teeth without errors, at rest.
#
# Pairs are springs of the whole face; what a contact solved across the face changes of their sharing is below what a
# wear coefficient is known to.


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


class MeshTeeth:
    """Teeth of one mesh under a law, by state."""

    def __init__(self, law: ToothLaw, teeth: Teeth) -> None:
        self.teeth, self._law = teeth, law
        self.pair, self.options = teeth.pair, teeth.options
        # not over instances: what belongs to a gearbox ends with it
        self._shares = cache(self._computed_shares)
        self._missing = cache(self._computed_missing)

    def errors(self, state_id: int) -> SpecimenErrors | None:
        """Return the errors; None for perfect gears.

        Raises
        ------
        ValueError
            If a gear lies outside the range of ISO 1328-1.
        """
        return self.teeth.errors(self.teeth.drawn_for(state_id))

    def waves(self, state_id: int) -> SpecimenWaves | None:
        """Return the waves; None without them."""
        return self.teeth.waves(self.teeth.drawn_for(state_id))

    def shares(self, state_id: int) -> FaceShares | None:
        """Return how slices of helical teeth share the load; None for spur teeth."""
        return self._shares(self.teeth.drawn_for(state_id))

    def missing(self, state_id: int) -> WavyTeeth:
        """Return the missing material of relief, damage, errors and waves, under any torque."""
        losses = from_flanks(self.damage(state_id))
        return self._missing(self.teeth.drawn_for(state_id), losses, reach_pitches(self.pair, losses))

    def missing_before_chips(self, state_id: int) -> WavyTeeth:
        """Return the same without what single teeth have lost."""
        losses = from_flanks(self.damage(state_id))
        everywhere = tuple(one for one in losses if one.tooth == NO_TOOTH)
        return self._missing(self.teeth.drawn_for(state_id), everywhere, reach_pitches(self.pair, losses))

    def damage(self, state_id: int) -> Parts:
        """Return the damage of a state.

        Raises
        ------
        ValueError
            As `siggen.gearbox.mesh_damage.MeshDamage`.
        """
        return self.teeth.damage(state_id, partial(load_at_rest, self._law, self.pair, self.options))

    def _computed_missing(self, drawn_for: int, losses: Losses, reach: float) -> WavyTeeth:
        pair, errors = self.pair, self.teeth.errors(drawn_for)
        whole = teeth_missing(self._law, pair, TABLE_POINTS, reach)
        plain, shares = with_losses(whole, pair, losses), self._shares(drawn_for)
        return WavyTeeth(erroneous_teeth(plain, pair, errors, shares), pair, self.teeth.waves(drawn_for), shares)

    def _computed_shares(self, drawn_for: int) -> FaceShares | None:
        return slice_shares(self._law, self.pair, self.options, lead_of(self.teeth.errors(drawn_for)))


def all_teeth(specimen: Specimen) -> tuple[MeshTeeth, ...]:
    """Return the teeth of all meshes of a gearbox, in the order of `Specimen.all_teeth`."""
    return tuple(MeshTeeth(specimen.law, one) for one in specimen.all_teeth)
