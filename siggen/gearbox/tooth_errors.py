"""Manufacturing errors of a mesh as they are drawn: both gears, their helices, and how their shafts stand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.config import Manufacture
from siggen.gears.errors.error_shapes import Draws, error_shapes
from siggen.gears.errors.gear_errors import FlankDeviations, GearErrors, deviations, gear_errors, off_axis
from siggen.gears.errors.helix import Helix, drawn_helix, straight_helix
from siggen.gears.errors.iso_1328 import FlankTolerances, flank_tolerances
from siggen.gears.errors.tooth_errors import with_errors
from siggen.gears.geometry.face_shares import FaceShares
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.missing_material import MissingMaterial
from siggen.keys.distributions import Uniform
from siggen.keys.number import at
from siggen.names import Side
from siggen.seeding import Stream, named_generator

RUNOUT_SHARE = Uniform(low=0.3, high=0.8)
"""Runout over what class and tolerance share allow; the first harmonic of the pitch deviations (assumed)."""
PROFILE_WAVES = Uniform(low=2.5, high=3.5)
"""Cycles of the profile's form over the flank, for each tooth (assumed)."""
HELIX_WAVES = Uniform(low=0.7, high=2.0)
"""Cycles of the helix form over the face (assumed)."""


@dataclass(frozen=True, slots=True)
class MadeGear:
    """One gear as it was made: its class and tolerances, how much of them it uses, its errors, what a machine finds.

    `helix`: crowning, slope and form across the face, alike on all teeth.
    """

    accuracy_class: int
    tolerance_share: float
    tolerances: FlankTolerances
    errors: GearErrors
    found: FlankDeviations
    helix: Helix


@dataclass(frozen=True, slots=True)
class MadeWith:
    """Whether gears of a set have crownings, slopes and forms of helices, and waves beside their other errors."""

    crowned: bool
    helices: bool
    waves: bool


@dataclass(frozen=True, slots=True)
class SpecimenErrors:
    """Both gears, and how far their flanks are apart at the far end of the face when they touch at the near one [m].

    `shafts_m` is the part of that distance that no helix slope of `MadeGear.helix` has.
    """

    pinion: MadeGear
    gear: MadeGear
    shafts_m: float

    @property
    def lead_misalignment_m(self) -> float:
        """Distance at the far end that shafts and helix slopes make together [m]; its sign is the end."""
        return self.shafts_m + self.pinion.helix.slope_m + self.gear.helix.slope_m

    @property
    def even(self) -> bool:
        """Whether nothing is missing anywhere across the face."""
        return self.shafts_m == 0.0 and self.pinion.helix.straight and self.gear.helix.straight

    def lead_m(self, slices: int) -> FloatArray:
        """Return what is missing in the middle of every slice of the face (slices,) [m]: F_β (w/L - 1/2) and helices.

        Crowning counts from the middle of the face, everything else from its mean.
        """
        place = (np.arange(slices) + 0.5) / slices
        lead = self.shafts_m * (place - 0.5)
        for helix in (made.helix for made in (self.pinion, self.gear) if not made.helix.straight):
            lead = lead + helix.missing_m(place)
        return lead


def drawn_errors(
    section: Manufacture, seats_m: Sequence[float], seed: int, owner: tuple[int, int], pair: GearPair
) -> SpecimenErrors:
    """Return the errors of pinion and gear of a mesh whose draws have this seed and owner, gearbox and state.

    Every draw has a name, so neither other keys nor the other gear shift it.

    Parameters
    ----------
    section : Manufacture
    seats_m : (2,) how far the seats of pinion and gear lie off their bearings [m]
    seed : int
    owner : gearbox, and the state for which the errors are drawn
    pair : GearPair

    Raises
    ------
    ValueError
        If a gear lies outside the range of ISO 1328-1.
    """

    def draws(name: str) -> np.random.Generator:
        return named_generator(seed, Stream.MANUFACTURE, *owner, name=f"manufacture.{name}")

    pinion, gear = (_made(section, pair, side, seat, draws) for side, seat in zip(Side, seats_m, strict=True))
    shafts_m = _shafts_m(section, (pinion, gear), draws)
    return SpecimenErrors(pinion, gear, shafts_m)


def erroneous_teeth(
    missing: MissingMaterial, pair: GearPair, errors: SpecimenErrors | None, shares: FaceShares | None
) -> MissingMaterial:
    """Return the missing material of the same teeth with their errors; `shares` of helical teeth alone."""
    return missing if errors is None else with_errors(missing, pair, errors.pinion.errors, errors.gear.errors, shares)


def lead_of(errors: SpecimenErrors | None) -> Callable[[int], FloatArray] | None:
    """Return what gives the missing material of the slices of the face; None where nothing is missing across it."""
    return None if errors is None or errors.even else errors.lead_m


def _made(section: Manufacture, pair: GearPair, side: Side, seat_m: float, draws: Draws) -> MadeGear:
    def uniform(name: str) -> float:
        return float(draws(f"{side}.{name}").random())

    number = section.accuracy_class if side == Side.DRIVER else section.gear_class
    accuracy_class, share = round(at(number, uniform("accuracy_class"))), at(section.tolerance_share, uniform("share"))
    tolerances = flank_tolerances(pair.member(side), pair.face_width_m, accuracy_class, pair.helix_rad)
    of_teeth = draws(f"{side}.waves").random(pair.member(side).teeth)
    waves = np.array([PROFILE_WAVES.at(float(u)) for u in of_teeth])
    shapes = error_shapes(waves, lambda name: draws(f"{side}.{name}"))
    errors = gear_errors(pair, side, shapes, tolerances.times(share), RUNOUT_SHARE.at(uniform("runout_share")))
    errors = off_axis(errors, seat_m, 2.0 * pi * uniform("eccentricity_angle"))
    helix = _helix(section, side, tolerances.times(share), uniform)
    return MadeGear(accuracy_class, share, tolerances, errors, deviations(pair, side, errors), helix)


def _helix(section: Manufacture, side: Side, limits: FlankTolerances, uniform: Callable[[str], float]) -> Helix:
    """Return a helix; its slope has the draw that `lead_misalignment_um: iso_1328` takes it from."""
    number = section.crowning_um if side == Side.DRIVER else section.crowning_of_gear
    crowning = 1e-6 * at(number, uniform("crowning_um"))
    if not section.has_helix:
        return straight_helix(crowning)
    waves, phase = HELIX_WAVES.at(uniform("helix_waves")), 2.0 * pi * uniform("helix_form")
    return drawn_helix(crowning, 2.0 * uniform("helix") - 1.0, waves, phase, limits)


def _shafts_m(section: Manufacture, gears: tuple[MadeGear, MadeGear], draws: Draws) -> float:
    """Return the drawn misalignment with its sign, as likely the one as the other."""
    if section.lead_misalignment_um == "iso_1328":
        ends = (2.0 * float(draws(f"{side}.helix").random()) - 1.0 for side in Side)
        slopes = (made.tolerance_share * made.tolerances.helix_slope_m for made in gears)
        return sum(end * slope for end, slope in zip(ends, slopes, strict=True))
    size = 1e-6 * at(section.lead_misalignment_um, float(draws("lead_misalignment_um").random()))  # type: ignore[arg-type]
    # The zero makes 0.0 of -0.0.
    return (size if draws("lead_end").random() < 0.5 else -size) + 0.0
