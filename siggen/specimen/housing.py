"""The housing of one specimen that gives way: from its geometry, or from modes that its user gave."""

from __future__ import annotations

from functools import lru_cache

from siggen.config import Config, ModalHousing, RigidHousing
from siggen.gearbox.housing_numbers import PlateNumbers
from siggen.planning.specimen import Specimen
from siggen.specimen.modal_housing import given_modes, modal_housing
from siggen.specimen.planetary_housing import rigid_housing_of_set, slowest_decay_per_s
from siggen.specimen.plate_housing import damped_modes, plate_housing
from siggen.specimen.specimen_housing import SpecimenHousing, modes_settle_s, settle_s


@lru_cache(maxsize=4)  # instrument, structure, background and labels of a gearbox ask for it
def specimen_housing(config: Config, specimen: Specimen) -> SpecimenHousing | None:
    """Return the housing of a specimen; the same for all of its states and records; None for one without modes."""
    numbers = _giving_way(specimen)
    match numbers:
        case PlateNumbers():
            return plate_housing(config, specimen, numbers)
        case ModalHousing():
            return modal_housing(specimen, numbers)
    return None


@lru_cache(maxsize=4)
def housing_settle_s(config: Config, specimen: Specimen) -> float:
    """Return the time over which the modes settle [s], which every record asks for; 0 without any."""
    numbers = _giving_way(specimen)
    match numbers:
        case PlateNumbers():
            _, modes, ratio = damped_modes(config, specimen, numbers)
            return modes_settle_s(modes.frequency_hz, ratio)
        case ModalHousing():
            table = given_modes(numbers)
            return modes_settle_s(table.frequency_hz, table.damping_ratio)
        case RigidHousing() if specimen.planets is not None:  # others move with the gears
            return settle_s(slowest_decay_per_s(rigid_housing_of_set(specimen)))
    return 0.0


def _giving_way(specimen: Specimen) -> object:
    return specimen.housing if specimen.housed else None
