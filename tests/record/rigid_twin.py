"""The rigid casing that a box of plates becomes when its walls give way no more."""

from __future__ import annotations

from siggen.drivetrain.gear_stage import Bolts, Casing
from siggen.drivetrain.structure import Structure, locked_load
from siggen.gearbox.housing import Plates
from siggen.gearbox.specimen import Specimen
from siggen.record.housing import SpecimenHousing, sensor_place
from tests.dynamics.housing.rigid_body import mass_points
from tests.dynamics.trains import casing_structure


def rigid_twin(specimen: Specimen, housing: SpecimenHousing) -> Structure:
    """Return the gears in a rigid casing with the box's mass, inertia, bolts and places of sensors."""
    casing = _casing(specimen, housing)
    return locked_load(casing_structure(specimen.train.first, casing))


def _casing(specimen: Specimen, housing: SpecimenHousing) -> Casing:
    box = housing.box
    places, masses = mass_points(box)
    x, y, _ = masses @ places / masses.sum()
    arms = places[:, :2] - (x, y)
    shear, axial, _ = box.bolts[0].stiffness_n_per_m
    assert isinstance(specimen.housing, Plates)
    sensors = {}
    for name, mount in specimen.housing.mounts.items():
        plate, first, _ = sensor_place(box, mount)
        at = {"lid": (first, box.size_m[1]), "gear_end": (0.0, first)}[plate]
        sensors[name] = (at[0] - x, at[1] - y)
    seat = box.seats["pinion"]
    return Casing(
        mass_kg=float(masses.sum()),
        inertia_kg_m2=float(masses @ (arms**2).sum(axis=1)),
        bolts=Bolts(shear, axial, 0.05, tuple((bolt.x_m - x, -y) for bolt in box.bolts for _ in range(2))),
        pinion_place_m=(seat.x_m - x, seat.y_m - y),
        sensor_places_m={name: (float(h), float(v)) for name, (h, v) in sensors.items()},
    )
