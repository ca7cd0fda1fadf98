"""MadeGears: deviations and damage of one specimen's gears, computed once for all states that share them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, cached_property
from typing import NamedTuple, TypeVar

from siggen.config import Config
from siggen.dynamics.structure.structure import Structure
from siggen.gearbox.pair import mesh_options
from siggen.gears.damage.flank_loss import Losses, from_flanks, reach_pitches, with_losses
from siggen.gears.damage.part import NO_TOOTH, Parts
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.idler import idler_later_rad
from siggen.gears.stiffness.mesh_tables import TABLE_POINTS
from siggen.gears.stiffness.stiffness_options import StiffnessOptions
from siggen.planning.specimen import Specimen
from siggen.planning.stages import first_mesh, stage_config, stage_specimen
from siggen.specimen.contact import slice_shares
from siggen.specimen.damage import grown_damage
from siggen.specimen.errors import SpecimenErrors, erroneous_teeth, lead_of, specimen_errors
from siggen.specimen.flank_waves import SpecimenWaves, WavyTeeth, specimen_waves
from siggen.specimen.motion import teeth_missing
from siggen.specimen.structure import structure

Made = TypeVar("Made", SpecimenErrors, SpecimenWaves)


class Shared(NamedTuple):
    """A gear in two meshes: what made it with its other mate, and what it is in both pairs."""

    made: MadeGears
    which: str

    def put_into(self, own: Made, of: Callable[[MadeGears, int], Made | None], drawn_for: int) -> Made:
        """Return what is `own` to a pair with that of the shared gear in its place."""
        return replace(own, **{self.which: getattr(of(self.made, drawn_for), self.which)})


class SameBody(NamedTuple):
    """The gear of another pair, whose other flanks drive; its axis is `later_rad` on in the phase of errors."""

    made: MadeGears
    later_rad: float

    def on_its_axis(self, own: SpecimenErrors, drawn_for: int) -> SpecimenErrors:
        """Return errors whose pinion turns about the axis of this gear."""
        other = self.made.errors(drawn_for)
        assert other is not None  # both have the section
        axis, phase = other.gear.errors.eccentricity_m, other.gear.errors.phase_rad + self.later_rad
        errors = replace(own.pinion.errors, eccentricity_m=axis, phase_rad=phase)
        return replace(own, pinion=replace(own.pinion, errors=errors))


class MadeGears:
    """Errors, waves, missing material and damage by state; `stages` are the same of the further meshes.

    `pair`: that of `gears` unless it is given; `shared`: the gear that it has in common with another one; `body`: the
    other flanks of its pinion.
    What is made by `manufacture.draw: specimen` is one for all states; damage is drawn on that of the milder state.
    """

    def __init__(
        self,
        config: Config,
        specimen: Specimen,
        pair: GearPair | None = None,
        shared: Shared | None = None,
        body: SameBody | None = None,
    ) -> None:
        self.pair: GearPair = specimen.pair if pair is None else pair
        self._whole, self._config, self._specimen = config, first_mesh(config), specimen
        self._shared, self._body = shared, body
        self.stages = tuple(_stages(self, config, specimen))
        # not over instances: what belongs to a gearbox ends with it
        self._errors = cache(self._computed_errors)
        self._waves = cache(self._computed_waves)
        self._shares = cache(self._computed_shares)
        self._missing = cache(self._computed_missing)
        self._damage = cache(self._drawn_damage)

    @property
    def options(self) -> StiffnessOptions:
        """How the teeth of this pair bend."""
        return mesh_options(self.pair, self._specimen.meshes[0].options)

    @property
    def config(self) -> Config:
        """The configuration of this pair alone."""
        return self._config

    @property
    def specimen(self) -> Specimen:
        """The gearbox with this pair as its first one."""
        return self._specimen

    @cached_property
    def structure(self) -> Structure:
        """The structure of the whole gearbox, which damage leaves as it is.

        Raises
        ------
        ValueError
            As `structure`.
        """
        return structure(self._specimen)

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
        if self._shared is not None:
            return tuple(one for one in self._shared.made.damage(state_id) if one.gear == self._shared.which)
        return grown_damage(self._config, self._specimen.specimen_id, self.pair, state_id, self.damage)

    def _drawn_for(self, state_id: int) -> int:
        section = self._config.manufacture
        return state_id if section is not None and section.draw == "state" else 0

    def _computed_errors(self, drawn_for: int) -> SpecimenErrors | None:
        own = specimen_errors(self._config, self.pair, self._specimen.specimen_id, drawn_for)
        if own is not None and self._shared is not None:
            own = self._shared.put_into(own, MadeGears.errors, drawn_for)
        return own if own is None or self._body is None else self._body.on_its_axis(own, drawn_for)

    def _computed_waves(self, drawn_for: int) -> SpecimenWaves | None:
        own = specimen_waves(self._config, self.pair, self._specimen.specimen_id, drawn_for)
        return own if own is None or self._shared is None else self._shared.put_into(own, MadeGears.waves, drawn_for)

    def _computed_missing(self, drawn_for: int, losses: Losses, reach: float) -> WavyTeeth:
        pair = self.pair
        whole = teeth_missing(self._specimen.law, pair, TABLE_POINTS, reach)
        plain, shares = with_losses(whole, pair, losses), self._shares(drawn_for)
        teeth = erroneous_teeth(plain, pair, self._errors(drawn_for), shares)
        return WavyTeeth(teeth, pair, self._waves(drawn_for), shares)

    def _computed_shares(self, drawn_for: int) -> FaceShares | None:
        own = self._specimen
        return slice_shares(own.law, self.pair, self.options, lead_of(self._errors(drawn_for)))


def _stages(first: MadeGears, config: Config, specimen: Specimen) -> Iterator[MadeGears]:
    """Yield what makes the teeth of each further mesh; an idler has the axis that it has in the mesh in front."""
    front = first
    for index, stage in enumerate(specimen.stages):
        own = stage_specimen(specimen, index)
        body = SameBody(front, idler_later_rad(front.pair, own.pair)) if stage.idler else None
        front = MadeGears(stage_config(config, specimen, index), own, body=body)
        yield front
