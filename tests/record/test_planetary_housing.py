"""A planetary set in a housing: forces on held seats set free, the same at every angle of the carrier.

The reference is the whole machine with a push in its meshes, solved at once; what is tested goes two ways apart.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from siggen.arrays import ComplexArray, FloatArray
from siggen.checks.loading import load_config
from siggen.drivetrain.forced_motion import forced_motion
from siggen.drivetrain.makers import SEATS_OF_SET, planetary_train
from siggen.drivetrain.structure import Structure
from siggen.gearbox.specimen import Specimen
from siggen.record.forced_ways import AXES, EVEN, ChannelWay, mean_meshes, mesh_directions
from siggen.record.housing import set_in_housing, specimen_housing
from siggen.record.instrument import forces_through_housing
from siggen.record.structure import linear_structure, linear_train, specimen_body
from siggen.sensing.inputs import MOTION, Input
from tests.config.minimal import by_name
from tests.config.planets import planets

GRID = np.array([20.0, 150.0, 462.0, 924.0, 1700.0, 3200.0])
LID = {"name": "lid", "place": "casing", "axes": ["vertical"]}
RIGID = {"kind": "rigid", "mass_kg": 40.0}


def modes(*high_hz: float) -> str:
    """Return the modes of a housing that shift, rock and bend, and of others of small shapes."""
    names = [*(f"{seat.replace('/', '_')}_per_sqrt_kg" for seat in SEATS_OF_SET), "lid_vertical_per_sqrt_kg"]
    names[6] += "_m"
    shapes = np.random.default_rng(5).normal(scale=0.12, size=(4 + len(high_hz), len(names)))
    lines = [",".join(["frequency_hz", "damping_ratio", *names])]
    for hz, row in zip((310.0, 480.0, 690.0, 1380.0, *high_hz), shapes, strict=True):
        lines.append(",".join([repr(hz), "0.03", *map(repr, row.tolist())]))
    return "\n".join([*lines, ""])


def machine(housing: dict[str, Any], **changes: Any) -> Specimen:
    dynamics = {**planets()["dynamics"], "model": "casing"}
    lid = {**LID, "position_mm": [60.0, 110.0]} if housing["kind"] == "rigid" else LID
    config = load_config(planets(dynamics=dynamics, housing=housing, sensors=by_name([lid]), **changes))
    return config.gearbox(0)


def way(specimen: Specimen) -> dict[str, ChannelWay]:
    """Return how the lid sees the housing, modes beyond those of the machine included."""
    shown, housing = {Input(MOTION, "casing_lid/vertical"): 1.0}, specimen_housing(specimen)
    if housing is None:
        return {"lid": ChannelWay(shown, None, None, SEATS_OF_SET)}
    beyond = slice(housing.coupled, None)
    rows = housing.shown_accelerance({"casing_lid/vertical": 1.0}, SEATS_OF_SET, GRID, beyond)
    return {"lid": ChannelWay(shown, rows, None, SEATS_OF_SET)}


def pushed(structure: Structure, specimen: Specimen, directions: FloatArray, motions: tuple[str, ...] = ()) -> Any:
    return forced_motion(structure, mean_meshes(specimen, structure), directions, motions, GRID)


def set_free(specimen: Specimen) -> ComplexArray:
    """Return what a push in each mesh does to the lid (meshes, k): forces of the set on the ground, then set free."""
    ground = linear_structure(set_in_housing(specimen, None))
    pushes = np.array([mesh.vector for mesh in ground.meshes])
    held = pushed(ground, specimen, pushes).bearing_force
    through = forces_through_housing(specimen, way(specimen), GRID)["lid"]
    return np.sum([held[seat] * row for seat, row in zip(SEATS_OF_SET, through, strict=True)], axis=0)


@pytest.mark.parametrize("housing", [RIGID, {"kind": "modal", "modes": modes()}], ids=["rigid", "modal"])
def test_forces_on_held_seats_set_free_move_the_housing_as_the_whole_machine_does(housing: dict[str, Any]) -> None:
    specimen = machine(housing)
    whole = linear_structure(linear_train(specimen))
    pushes = np.array([mesh.vector for mesh in whole.meshes])
    expected = pushed(whole, specimen, pushes, ("casing_lid/vertical",)).acceleration["casing_lid/vertical"]
    found = set_free(specimen)
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()
    assert (np.abs(found - expected) < 1e-7 * np.abs(expected)).all()


def test_modes_beyond_those_of_the_machine_give_way_as_if_they_were_in_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    specimen = machine({"kind": "modal", "modes": modes(9.0e3, 11.0e3, 14.0e3)})
    few = set_free(specimen)  # none of the three is below 1.5 kHz, but six move with the gears
    monkeypatch.setattr("siggen.record.housing.MODES_ON_BOLTS", 4)
    monkeypatch.setattr("siggen.record.housing.COUPLED_HZ", 1500.0)
    fewer = set_free(specimen)
    low = GRID < 1000.0
    # quasi-static: (f/9 kHz)^2 of a part that is itself small
    assert (np.abs(few - fewer) < 5e-3 * np.abs(few))[:, low].all()


def at_angles(specimen: Specimen, turn: float) -> tuple[Structure, Structure]:
    """Return the machine as siggen takes it, and with its carrier a part of a turn farther."""
    places, housing = (turn, turn + 1 / 3, turn + 2 / 3), specimen_body(specimen)
    farther = planetary_train(replace(specimen.planets.stage, places_turns=places), housing)
    return linear_structure(linear_train(specimen)), linear_structure(farther)


@pytest.mark.parametrize("turn", [0.04, 0.23])
def test_the_machine_is_the_same_at_every_angle_of_the_carrier(turn: float) -> None:
    specimen = machine(RIGID)
    whole, turned = at_angles(specimen, turn)
    on_ring = np.array([whole.bearing_directions[seat] for seat in SEATS_OF_SET])
    first, second = (pushed(one, specimen, on_ring, ("casing_lid/vertical",)) for one in (whole, turned))
    for place, row in first.acceleration.items():
        assert np.abs(second.acceleration[place] - row).max() < 1e-9 * np.abs(row).max()


@pytest.mark.parametrize("mesh", [0, 1])
def test_a_planet_anywhere_moves_the_housing_by_three_waves_of_its_angle(mesh: int) -> None:
    specimen = machine(RIGID)
    turn = 0.17
    whole, turned = at_angles(specimen, turn)
    push = turned.meshes[3 * mesh].vector[None]
    expected = pushed(turned, specimen, push, ("casing_lid/vertical",)).acceleration["casing_lid/vertical"][0]
    kind = ("sun_meshes", "ring_meshes")[mesh]
    rows = mesh_directions(whole)
    waves = {EVEN: 1.0, AXES[0]: np.cos(2.0 * np.pi * turn), AXES[1]: np.sin(2.0 * np.pi * turn)}
    total = np.sum([weight * rows[f"{kind}/{wave}"] for wave, weight in waves.items()], axis=0)[None]
    found = pushed(whole, specimen, total, ("casing_lid/vertical",)).acceleration["casing_lid/vertical"][0]
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def test_a_stiff_and_heavy_housing_is_the_ground_to_the_set() -> None:
    bolts = {"shear_stiffness_n_per_m": 1e13, "axial_stiffness_n_per_m": 1e13}
    specimen = machine({"kind": "rigid", "mass_kg": 1e8, "bolts": bolts})
    whole = linear_structure(linear_train(specimen))
    ground = linear_structure(set_in_housing(specimen, None))
    push = (whole.meshes[0].vector, ground.meshes[0].vector)
    moved, held = (pushed(one, specimen, row[None]) for one, row in zip((whole, ground), push, strict=True))
    for seat in SEATS_OF_SET:
        assert moved.bearing_force[seat] == pytest.approx(held.bearing_force[seat], rel=1e-3)
