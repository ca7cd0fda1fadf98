"""MeshTeeth: missing material and damage of the teeth of one mesh, computed once for all states that share them."""

from __future__ import annotations

from functools import cache, partial

from siggen.dynamics.mesh.tooth_law import ToothLaw
from siggen.gearbox.flank_waves import SpecimenWaves
from siggen.gearbox.specimen import Specimen
from siggen.gearbox.teeth import Teeth
from siggen.gearbox.tooth_errors import SpecimenErrors, erroneous_teeth, lead_of
from siggen.gears.damage.flank_loss import Losses, from_flanks, reach_pitches, with_losses
from siggen.gears.damage.part import NO_TOOTH, Parts
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.specimen.contact import slice_shares
from siggen.specimen.motion import teeth_missing
from siggen.specimen.wavy_teeth import WavyTeeth
from siggen.specimen.worn_loads import load_at_rest


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
