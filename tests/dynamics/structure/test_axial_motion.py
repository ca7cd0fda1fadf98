"""Shafts that helical teeth push along their axes: equilibrium, mirror images, rigid motion, back flanks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from siggen.drivetrain.gear_stage import Shaft
from siggen.drivetrain.makers import train
from siggen.drivetrain.structure import Structure, assembled, on_back_flanks, static_solution, vector
from tests.dynamics.casing_stage import BASE_RADIUS_1, MEAN_STIFFNESS, PRESSURE_ANGLE, make_casing, make_stage
from tests.dynamics.trains import casing_of, casing_structure, eight_dof

BASE_HELIX = np.radians(14.0)
SLOPE = float(np.tan(BASE_HELIX))
TORQUE_NM = 30.0
FORCE_N = TORQUE_NM / BASE_RADIUS_1
SHAFT = Shaft(0.1, 0.4, 0.03, 206e9, 0.3, 3e-4)
SHAFTS = (SHAFT, replace(SHAFT, gear_share=0.55))


def helical_stage(base_helix_rad: float = BASE_HELIX):
    return replace(make_stage(), base_helix_rad=base_helix_rad)


def tilting(base_helix_rad: float = BASE_HELIX, shafts: tuple[Shaft, Shaft] = SHAFTS) -> Structure:
    return casing_structure(helical_stage(base_helix_rad), make_casing(), shafts)


def kinds(base_helix_rad: float = BASE_HELIX, shafts: tuple[Shaft, Shaft] = SHAFTS) -> list[Structure]:
    stage = helical_stage(base_helix_rad)
    return [eight_dof(stage), casing_structure(stage, make_casing()), tilting(base_helix_rad, shafts)]


def static(structure: Structure, torque_nm: float = TORQUE_NM) -> dict[str, float]:
    """Return the displacement under a torque at the mean mesh stiffness, by coordinate."""
    loaded = structure.stiffness + MEAN_STIFFNESS * np.outer(structure.mesh.vector, structure.mesh.vector)
    found = static_solution(structure, loaded, torque_nm * structure.torque_vector)
    return dict(zip(structure.coordinates, found.tolist(), strict=True))


def test_spur_teeth_have_no_axial_motion_and_a_small_helix_nearly_none() -> None:
    for spur, near in zip(kinds(0.0), kinds(1e-12), strict=True):
        assert not any(name.startswith("z_") for name in spur.coordinates)
        one, other = static(spur), static(near)
        assert max(abs(other[name] - one[name]) for name in one) < 1e-15
        assert abs(other["z_pinion"]) < 1e-15


@pytest.mark.parametrize("number", range(3))
def test_mean_axial_displacement_is_the_axial_force_over_the_stiffness(number: int) -> None:
    structure, stage = kinds()[number], helical_stage()
    q = static(structure)
    axial_n = FORCE_N * SLOPE
    for name, z, rotor, sign in (("pinion", "z_pinion", stage.pinion, 1.0), ("gear", "z_gear", stage.gear, -1.0)):
        stiffness, _ = rotor.bearing.along_axis
        assert stiffness == pytest.approx(1e8)
        assert q[z] == pytest.approx(sign * axial_n / stiffness, rel=1e-9)
        pressed = structure.bearing_forces[f"{name}_bearing/axial"][0] @ np.array(list(q.values()))
        assert pressed == pytest.approx(sign * axial_n, rel=1e-9)


def test_double_helical_teeth_push_no_shaft() -> None:
    stage = helical_stage()
    right, left = eight_dof(stage), eight_dof(helical_stage(-BASE_HELIX))
    held = np.zeros_like(right.stiffness)
    load = right.coordinates.index("theta_load")
    held[load, load] = 1e3
    halves = sum(0.5 * MEAN_STIFFNESS * np.outer(one.mesh.vector, one.mesh.vector) for one in (right, left))
    q = np.linalg.solve(right.stiffness + held + halves, TORQUE_NM * right.torque_vector)
    named = dict(zip(right.coordinates, q, strict=True))
    assert abs(named["z_pinion"]) < 1e-9 * abs(named["y_pinion"])
    # Along the line of action both halves are one spur mesh.
    assert named["y_pinion"] == pytest.approx(static(eight_dof(make_stage()))["y_pinion"], rel=1e-6)


def test_turning_or_shifting_both_gears_as_one_body_brings_no_flanks_nearer() -> None:
    """A rotation about any axis in the plane of rotation through the pinion, written by hand."""
    structure = tilting()
    angle = PRESSURE_ANGLE
    apart_m = (make_stage().pinion.base_radius_m + make_stage().gear.base_radius_m) / np.cos(angle)
    to_gear = np.array([-apart_m, 0.0])
    for turn in (np.array([1e-4, 0.0]), np.array([0.0, 1e-4]), np.array([0.7e-4, -0.4e-4])):
        tilts = {f"phi_{axis}_{i}": float(turn[k]) for i in ("pinion", "gear") for k, axis in enumerate("xy")}
        q = vector(structure.coordinates, {**tilts, "z_pinion": 0.0, "z_gear": float(-turn @ to_gear)})
        assert abs(structure.mesh.vector @ q) < 1e-16
        assert abs(structure.mesh.tilt @ q) < 1e-16
    moved = vector(structure.coordinates, {"z_pinion": 1.0, "z_gear": 1.0})
    assert abs(structure.mesh.vector @ moved) < 1e-15


def test_moments_of_bearings_and_axial_force_balance_on_each_shaft() -> None:
    """Both ends of a shaft, found from the gear's motion by hand, bear force and moment of the mesh."""
    structure, stage = tilting(), helical_stage()
    q = static(structure)
    machine, moving = structure.drivetrain, np.array(list(q.values()))
    seats = casing_of(stage, make_casing()).seats
    gears = (("pinion", stage.pinion, SHAFTS[0]), ("gear", stage.gear, SHAFTS[1]))
    for which, rotor, shaft in gears:
        moment = 0.0
        for lever in shaft.levers_m.values():
            seat = machine.row(seats[f"{which}_bearing"], "horizontal") @ moving
            across = q[f"x_{which}"] + lever * q[f"phi_x_{which}"]
            moment += lever * end_stiffness(shaft, lever) * (across - seat)
        pitch_radius_m = rotor.base_radius_m / np.cos(PRESSURE_ANGLE)
        assert moment == pytest.approx(SLOPE * FORCE_N * pitch_radius_m, rel=1e-9)


def end_stiffness(shaft: Shaft, lever_m: float) -> float:
    """A bearing of 1e8 N/m in series with a cantilever, whose formula is written out again."""
    area, inertia = np.pi * shaft.diameter_m**2 / 4.0, np.pi * shaft.diameter_m**4 / 64.0
    shear = 206e9 / 2.6 * area * 6.0 * 1.3 / (7.0 + 1.8)
    length = abs(lever_m)
    return 1.0 / (1e-8 + length**3 / (3.0 * 206e9 * inertia) + length / shear)


def test_seats_of_a_body_take_the_axial_force_and_give_way_along_it() -> None:
    """A casing that moves along the shafts too: 2 masses on their bearings on a third."""
    own = casing_of(helical_stage(), make_casing())
    carried = replace(own, body=replace(own.body, moves=(*own.body.moves, "z")))
    structure = assembled(train(helical_stage(), housing=carried))
    place = {name: structure.coordinates.index(name) for name in ("z_pinion", "z_gear", "z_casing")}
    chosen = list(place.values())
    expected = 1e8 * np.array([[1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, 2.0]])
    np.testing.assert_allclose(structure.stiffness[np.ix_(chosen, chosen)], expected, rtol=1e-12)


def test_back_flanks_push_the_other_way_along_the_shafts() -> None:
    """By hand: half a turn about the centre line maps teeth of one hand on themselves, drive flanks on back flanks."""
    drive = tilting()
    back = on_back_flanks(drive, 0.0)
    row = dict(zip(back.coordinates, back.mesh.vector, strict=True))
    one = dict(zip(drive.coordinates, drive.mesh.vector, strict=True))
    h = np.array([1.0, 0.0])
    for i in ("pinion", "gear"):
        for kind, turned in (("", 1.0), ("phi_", -1.0)):
            own = np.array([one[f"{kind}{axis}_{i}"] for axis in "xy"])
            expected = turned * (2.0 * h * (h @ own) - own)
            np.testing.assert_allclose([row[f"{kind}{axis}_{i}"] for axis in "xy"], expected, atol=1e-15)
        assert row[f"z_{i}"] == -one[f"z_{i}"]
