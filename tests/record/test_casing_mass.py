"""A rigid casing whose mass is drawn: limits, energy and responses found without our solver."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.drivetrain.forced_motion import MeanMesh, forced_motion
from siggen.drivetrain.structure import Structure, locked_load
from siggen.gearbox.design import SetDesign
from siggen.gearbox.housing import Block
from siggen.record.structure import structure
from tests.config.minimal import by_name, minimal

LID = {"name": "lid", "place": "casing", "axes": ["vertical"], "position_mm": [60.0, 50.0]}
MESH = MeanMesh(3e8, 800.0)


def loaded(mass_kg: float) -> SetDesign:
    housing = {"kind": "rigid", "mass_kg": mass_kg, "inertia_kg_m2": None}
    return load_config(minimal(sensors=by_name([LID]), housing=housing))


def assembled(mass_kg: float) -> Structure:
    config = loaded(mass_kg)
    specimen = config.gearbox(0)
    return locked_load(structure(specimen))


def test_a_casing_without_end_to_its_mass_stands_still_and_passes_the_force_to_rigid_seats() -> None:
    hz = np.array([400.0, 1500.0, 4000.0])
    moved, pressed = [], []
    for mass_kg in (1e5, 1e6, 1e7):
        stage = assembled(mass_kg)
        found = forced_motion(stage, MESH, stage.mesh.vector[None, :], ("casing_lid/vertical",), hz)
        moved.append(np.abs(found.acceleration["casing_lid/vertical"][0]))
        pressed.append(found.bearing_force["pinion_bearing/vertical"][0])
    # what is left of the motion is force over mass: the next order is mass of the gears (4 kg) over that of the casing
    np.testing.assert_allclose(moved[1] / moved[2], 10.0, rtol=1e-4)
    np.testing.assert_allclose(moved[0] / moved[1], 10.0, rtol=1e-3)
    # seats at rest: the gears on their bearings alone, solved for with the casing's rows struck out
    stage = assembled(1e7)
    kept = [i for i, name in enumerate(stage.coordinates) if name not in {"x_casing", "y_casing", "phi_casing"}]
    p = stage.mesh.vector
    for k, omega in enumerate(2.0 * np.pi * hz):
        dynamic = stage.stiffness + MESH.stiffness_n_per_m * np.outer(p, p) - omega**2 * stage.mass
        dynamic = dynamic + 1j * omega * (stage.damping + MESH.damping_n_s_per_m * np.outer(p, p))
        q = np.zeros(p.size, dtype=complex)
        q[kept] = np.linalg.solve(dynamic[np.ix_(kept, kept)], p[kept])
        stiff, damped = stage.bearing_forces["pinion_bearing/vertical"]
        assert pressed[2][k] == pytest.approx((stiff + 1j * omega * damped) @ q, rel=1e-4)


@pytest.mark.parametrize("mass_kg", [8.0, 55.0])
def test_what_a_force_puts_in_is_what_the_dampers_take(mass_kg: float) -> None:
    stage = assembled(mass_kg)
    p, omegas = stage.mesh.vector, 2.0 * np.pi * np.array([300.0, 640.0, 2500.0])
    names = tuple(stage.motions)
    found = forced_motion(stage, MESH, p[None, :], names, omegas / (2.0 * np.pi))
    damping = stage.damping + MESH.damping_n_s_per_m * np.outer(p, p)
    for k, omega in enumerate(omegas):
        dynamic = (
            stage.stiffness + MESH.stiffness_n_per_m * np.outer(p, p) - omega**2 * stage.mass + 1j * omega * damping
        )
        v = 1j * omega * np.linalg.solve(dynamic, p)
        for name in names:  # the velocities balanced here are those that channels are made of
            assert found.acceleration[name][0, k] == pytest.approx(1j * omega * (stage.motions[name] @ v), rel=1e-7)
        assert (p @ v).real == pytest.approx((v.conj() @ damping @ v).real, rel=1e-9)


def test_far_above_its_bolts_a_casing_moves_and_turns_as_a_free_body_of_its_mass() -> None:
    """At its centre of gravity a = F/m; at the height h a further h²/J, J = m (1.15 a)², for a horizontal force."""
    config = loaded(12.0)
    specimen, height_m = config.gearbox(0), 0.05
    pair = specimen.pair
    stage = locked_load(structure(specimen))
    direction = stage.motions["casing_lid/horizontal"]
    found = forced_motion(stage, MESH, direction[None, :], ("casing_lid/horizontal",), np.array([2e5]))
    inertia = 12.0 * (1.15 * pair.working_centre_distance_m) ** 2
    expected = 1.0 / 12.0 + height_m**2 / inertia
    assert found.acceleration["casing_lid/horizontal"][0, 0].real == pytest.approx(expected, rel=1e-3)


def test_a_file_that_writes_the_default_values_out_has_the_identity_of_one_without_them() -> None:
    plain, written = {"kind": "rigid"}, {"kind": "rigid", "mass_kg": 20.0, "inertia_kg_m2": 0.25, "bolts": {}}
    config = load_config(minimal(housing=plain))
    assert config.identity == load_config(minimal(housing=written)).identity
    assert config.identity != load_config(minimal(housing={**plain, "inertia_kg_m2": None})).identity
    assert config.identity != load_config(minimal()).identity
    plates = {"kind": "plates", "damping_ratio": {"log": [0.003, 0.05]}}
    assert load_config(minimal(housing=plates)).identity == load_config(minimal()).identity


def test_a_casing_of_twice_the_extent_turns_four_times_as_hard() -> None:
    """The radius of gyration follows the distance of the axes; 1.15 of it is a box of even wall round both gears."""
    block = loaded(20.0).gearbox(0).housing
    assert isinstance(block, Block)
    small, large = (block.casing(extent_m) for extent_m in (0.1, 0.2))
    assert large.inertia_kg_m2 == pytest.approx(4.0 * small.inertia_kg_m2)
    assert np.sqrt(small.inertia_kg_m2 / small.mass_kg) == pytest.approx(1.15 * 0.1)
