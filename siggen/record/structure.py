"""The gearbox of a drawn specimen as the dynamics sees it: shafts on their bearings in what carries them."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin

import numpy as np

from siggen.arrays import FloatArray
from siggen.drivetrain.bearings import LoadedBearing, loaded_bearing
from siggen.drivetrain.drivetrain import TURNING, Drivetrain, Place, Way
from siggen.drivetrain.excitation import shaft_direction
from siggen.drivetrain.gear_stage import PLACES, GearStage, Point, Rotor
from siggen.drivetrain.makers import Housing, planetary_train, rigid_housing, train
from siggen.drivetrain.structure import Structure, assembled, locked_load
from siggen.gearbox.housing import Block
from siggen.gearbox.specimen import PairTrain, Specimen
from siggen.gears.gear_pair import GearPair
from siggen.names import Side
from siggen.record.housing import moving_with_gears, rigid_housing_of_set, set_in_housing, specimen_housing

# The rigid casing round all shafts of a drawn specimen.

LEAST_SPAN = 0.5 / min(PLACES[0], PLACES[1] - PLACES[0])
"""Distance of the bearings of a common shaft over both faces, from which on neither gears nor bearings overlap."""


def casing_round_shafts(specimen: Specimen) -> Housing:
    """Return the rigid casing round all shafts. Its x is horizontal, its y vertical.

    Raises
    ------
    ValueError
        If the bolts leave it free to move.
    """
    assert isinstance(specimen.housing, Block)
    places = axis_places_m(specimen)
    across = [place[0] for place in places.values()]
    return rigid_housing(specimen.housing.casing(max(across) - min(across)), places)


def axis_places_m(specimen: Specimen) -> dict[str, Point]:
    """Return where the bearings of every shaft stand, horizontally from the middle between the outermost ones [m].

    Horizontal runs from the first gear to its pinion; the height is that of the first pinion.
    """
    first, *behind = (shaft.bearing for shaft in specimen.names.shafts)
    place, found = (0.0, 0.0), {first: (0.0, 0.0)}
    for bearing, mesh in zip(behind, specimen.meshes, strict=True):
        centre_m = mesh.pair.working_centre_distance_m
        place = place[0] - centre_m * cos(mesh.direction_rad), place[1] + centre_m * sin(mesh.direction_rad)
        found[bearing] = place
    across = [x for x, _ in found.values()]
    middle = 0.5 * (max(across) + min(across))
    return {name: (x - middle, y) for name, (x, y) in found.items()}


# Bearings of a drawn specimen under the mean load of its operating point: where a shaft gives their `geometry`.
#
# Teeth press along the line of action, under a torque below 0 along that of the back flanks; gears and shafts weigh.
# Each of the two bearings of a shaft bears half. Vibration about that load is small: bearings are linear about it.

BEARINGS = 2
"""Of a shaft: each bears half of the force and has half of their stiffness."""
GRAVITY_M_S2 = 9.81


def loaded_bearings(train: PairTrain, pair: GearPair, torque_nm: float, *, housed: bool) -> dict[Side, LoadedBearing]:
    """Return one of both bearings of each shaft whose stiffness follows the load, under a torque on the pinion."""
    found = {}
    for side, ball_bearing in train.balls:
        mass_kg = getattr(train.first, side).mass_kg
        force_n = shaft_load_n(pair, side, torque_nm, mass_kg, housed=housed)
        found[side] = loaded_bearing(ball_bearing, force_n / BEARINGS)
    return found


def shaft_load_n(pair: GearPair, side: Side, torque_nm: float, mass_kg: float, *, housed: bool) -> FloatArray:
    """Return the mean force (2,) on a shaft, horizontal and upward [N]: of the teeth and of its weight."""
    angle, force_n = pair.working_pressure_angle_rad, torque_nm / pair.pinion.base_radius_m
    # Horizontal runs from the gear to the pinion in a casing, else back. Either flank pushes the gears apart.
    apart = 1.0 if housed else -1.0
    on_pinion = np.array([apart * sin(angle) * abs(force_n), -cos(angle) * force_n])
    return np.asarray((on_pinion if side == Side.DRIVER else -on_pinion) - np.array([0.0, mass_kg * GRAVITY_M_S2]))


def cage_sense(side: Side, *, housed: bool) -> float:
    """Return 1 where a shaft turns from horizontal to upward, -1 where back: the pinion's mesh goes up, beside it."""
    pinion = -1.0 if housed else 1.0
    return pinion if side == Side.DRIVER else -pinion


def on_loaded_bearings(stage: GearStage, found: dict[Side, LoadedBearing]) -> GearStage:
    """Return a stage on bearings under load."""
    rotors = {Side.DRIVER: stage.pinion, Side.DRIVEN: stage.gear}
    rotors |= {side: on_loaded_bearing(rotors[side], one) for side, one in found.items()}
    return replace(stage, pinion=rotors[Side.DRIVER], gear=rotors[Side.DRIVEN])


def on_loaded_bearing(rotor: Rotor, one: LoadedBearing) -> Rotor:
    """Return a gear on two bearings under load."""
    stiffness = BEARINGS * one.stiffness_n_per_m
    x, xy, y = float(stiffness[0, 0]), float(stiffness[0, 1]), float(stiffness[1, 1])
    numbers = replace(rotor.bearing, stiffness_x_n_per_m=x, stiffness_y_n_per_m=y, stiffness_xy_n_per_m=xy)
    if (time_s := numbers.damping_time_s) is not None:
        numbers = replace(numbers, damping_x_n_s_per_m=time_s * x, damping_y_n_s_per_m=time_s * y)
    return replace(rotor, bearing=numbers)


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
