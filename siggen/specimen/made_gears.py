"""MadeGears: deviations and damage of one specimen's gears, computed once for all states that share them."""

from __future__ import annotations

from functools import cache

from siggen.config import Config
from siggen.gears.damage.flank_loss import Losses, from_flanks, reach_pitches, with_losses
from siggen.gears.damage.part import NO_TOOTH, Parts
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.planning.specimen import Specimen
from siggen.planning.stages import first_mesh, stage_config, stage_specimen
from siggen.specimen.contact import slice_shares
from siggen.specimen.damage import grown_damage
from siggen.specimen.errors import SpecimenErrors, erroneous_teeth, lead_of, specimen_errors
from siggen.specimen.flank_waves import SpecimenWaves, WavyTeeth, specimen_waves
from siggen.specimen.gears import gear_pair, stiffness_options
from siggen.specimen.motion import teeth_missing


class MadeGears:
    """Errors, waves, missing material and damage by state; `stages` are the same of the further meshes.

    What is made by `manufacture.draw: specimen` is one for all states; damage is drawn on that of the milder state.
    """

    def __init__(self, config: Config, specimen: Specimen) -> None:
        self.pair: GearPair = gear_pair(specimen.gears)
        self._config, self._specimen = first_mesh(config), specimen
        self.stages = tuple(
            MadeGears(stage_config(config, specimen, i), stage_specimen(specimen, i))
            for i in range(len(specimen.stages))
        )
        # not over instances: what belongs to a gearbox ends with it
        self._errors = cache(self._computed_errors)
        self._waves = cache(self._computed_waves)
        self._shares = cache(self._computed_shares)
        self._missing = cache(self._computed_missing)
        self._damage = cache(self._drawn_damage)

    @property
    def config(self) -> Config:
        """The configuration of this pair alone."""
        return self._config

    @property
    def specimen(self) -> Specimen:
        """The gearbox with this pair as its first one."""
        return self._specimen

    def errors(self, state_id: int) -> SpecimenErrors | None:
        """Return the errors; None for perfect gears.

        Raises
        ------
        ValueError
            If a gear lies outside the range of ISO 1328-1.
        """
        return self._errors(self._drawn_for(state_id))

    def waves(self, state_id: int) -> SpecimenWaves | None:
        """Return the waves; None without them."""
        return self._waves(self._drawn_for(state_id))

    def shares(self, state_id: int) -> FaceShares | None:
        """Return how slices of helical teeth share the load; None for spur teeth."""
        return self._shares(self._drawn_for(state_id))

    def missing(self, state_id: int) -> WavyTeeth:
        """Return the missing material of relief, damage, errors and waves, under any torque."""
        losses = from_flanks(self.damage(state_id))
        return self._missing(self._drawn_for(state_id), losses, reach_pitches(self.pair, losses))

    def missing_before_chips(self, state_id: int) -> WavyTeeth:
        """Return the same without what single teeth have lost."""
        losses = from_flanks(self.damage(state_id))
        everywhere = tuple(one for one in losses if one.tooth == NO_TOOTH)
        return self._missing(self._drawn_for(state_id), everywhere, reach_pitches(self.pair, losses))

    def damage(self, state_id: int) -> Parts:
        """Return the damage of a state.

        Raises
        ------
        ValueError
            As `state_damage`.
        """
        return self._damage(state_id)

    def _drawn_damage(self, state_id: int) -> Parts:
        return grown_damage(self._config, self._specimen.specimen_id, self.pair, state_id, self.damage)

    def _drawn_for(self, state_id: int) -> int:
        section = self._config.manufacture
        return state_id if section is not None and section.draw == "state" else 0

    def _computed_errors(self, drawn_for: int) -> SpecimenErrors | None:
        return specimen_errors(self._config, self.pair, self._specimen.specimen_id, drawn_for)

    def _computed_waves(self, drawn_for: int) -> SpecimenWaves | None:
        return specimen_waves(self._config, self.pair, self._specimen.specimen_id, drawn_for)

    def _computed_missing(self, drawn_for: int, losses: Losses, reach: float) -> WavyTeeth:
        pair = self.pair
        whole = teeth_missing(self._specimen.dynamics, pair, TABLE_POINTS, reach)
        plain, shares = with_losses(whole, pair, losses), self._shares(drawn_for)
        teeth = erroneous_teeth(plain, pair, self._errors(drawn_for), shares)
        return WavyTeeth(teeth, pair, self._waves(drawn_for), shares)

    def _computed_shares(self, drawn_for: int) -> FaceShares | None:
        own = self._specimen
        return slice_shares(own.dynamics, self.pair, stiffness_options(own.stiffness), lead_of(self._errors(drawn_for)))
