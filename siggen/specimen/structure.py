"""The gearbox of a drawn specimen as the dynamics sees it: shafts on their bearings in what carries them."""

from __future__ import annotations

from dataclasses import replace

from siggen.dynamics.bearings.loaded_bearing import LoadedBearing
from siggen.dynamics.drive.external_forces import shaft_direction
from siggen.dynamics.structure.drivetrain import TURNING, Drivetrain, Place, Way
from siggen.dynamics.structure.gear_stage import GearStage
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.makers import Housing, planetary_train, train
from siggen.dynamics.structure.structure import Structure, assembled
from siggen.gearbox.housing import Block
from siggen.gearbox.specimen import Specimen
from siggen.names import Side
from siggen.specimen.housing import specimen_housing
from siggen.specimen.loaded_bearings import loaded_bearings, on_loaded_bearings
from siggen.specimen.planetary_housing import rigid_housing_of_set, set_in_housing
from siggen.specimen.specimen_housing import moving_with_gears
from siggen.specimen.staged_structure import casing_round_shafts


def structure(specimen: Specimen) -> Structure:
    """Return the structure of a drawn specimen.

    A planetary set stands on the ground: its frame turns in its housing (`planetary_housing`).
    """
    if specimen.planets is not None:
        return assembled(planetary_train(specimen.planets.stage))
    found = assembled(specimen_train(specimen, specimen_body(specimen)))
    if specimen.housing is None or isinstance(specimen.housing, Block):
        return found
    # Modes below some frequency are not what is seen of a housing: sensors take all of them (`instrument`).
    shafts = {shaft.bearing: f"{shaft.word}_shaft" for shaft in specimen.names.shafts}
    seats = ((seat, *seat.split("/")) for seat in found.bearing_directions)
    return replace(found, motions={f"{shafts[at]}/{axis}": shaft_direction(found, seat) for seat, at, axis in seats})


def specimen_train(specimen: Specimen, housing: Housing | None) -> Drivetrain:
    """Return a drawn train of pairs in a housing, or on the ground."""
    shafts = specimen.train
    assert shafts is not None
    bending = shafts.bending if housing and not shafts.behind else None
    return train(supported_stage(specimen), shafts.behind, housing, bending, specimen.names)


def moved_along(specimen: Specimen) -> tuple[str, ...]:
    """Return the motions along the shafts that sensors on them see: of helical teeth on bearings on the ground."""
    grounded = not specimen.housed and len(specimen.meshes) == 1
    helical = specimen.pair.base_helix_rad != 0.0
    return tuple(f"{shaft.bearing}/axial" for shaft in specimen.names.shafts) if grounded and helical else ()


def linear_train(specimen: Specimen) -> Drivetrain:
    """Return the machine on which small forces act, with what carries its bearings; it is seen where that moves."""
    housing = specimen_body(specimen)
    return specimen_train(specimen, housing) if specimen.planets is None else set_in_housing(specimen, housing)


def linear_structure(drivetrain: Drivetrain) -> Structure:
    """Return a machine whose load is held softly: otherwise nothing would keep the shafts from turning away."""
    return locked_load(assembled(drivetrain))


def supported_stage(specimen: Specimen) -> GearStage:
    """Return the first stage on its bearings, those that follow the load under that of its point."""
    assert specimen.train is not None
    return on_loaded_bearings(specimen.train.first, specimen_bearings(specimen))


def specimen_bearings(specimen: Specimen) -> dict[Side, LoadedBearing]:
    """Return one of both bearings of each shaft whose stiffness follows the load."""
    if specimen.bearing_point is None or specimen.train is None:
        return {}
    return loaded_bearings(specimen.train, specimen.pair, specimen.bearing_point.torque_nm, housed=specimen.housed)


def specimen_body(specimen: Specimen) -> Housing | None:
    """Return what carries the bearings of a specimen, sensors and entries on it included; None for the ground."""
    pair, modes = specimen.pair, specimen_housing(specimen)
    if modes is not None:
        return moving_with_gears(modes)
    if specimen.housing is None:
        return None
    if specimen.planets is not None:
        assert isinstance(specimen.housing, Block)
        return rigid_housing_of_set(specimen.housing, specimen.planets.ring)
    housing = casing_round_shafts(specimen)
    if specimen.behind:
        return housing
    # Of a second mesh a rigid casing feels the moment alone: the force times the distance of both lines of action.
    arm_m = pair.pinion.base_radius_m + pair.gear.base_radius_m
    moment = Way(Place(housing.body.name), TURNING, arm_m)
    return replace(housing, entries={**housing.entries, "second_stage": moment})
