"""A casing whose mass is drawn: limits, energy and responses found without our solver."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config
from siggen.dynamics.structure.forced_motion import MeanMesh, forced_motion
from siggen.dynamics.structure.load_lock import locked_load
from siggen.dynamics.structure.structure import Structure
from siggen.planning.specimen import draw_specimen
from siggen.record.simulation import simulate
from siggen.specimen.gears import gear_pair
from siggen.specimen.housing import specimen_housing
from siggen.specimen.structure import structure
from tests.config.minimal import minimal

LID = {"name": "lid", "place": "casing", "axes": ["vertical"], "position_mm": [60.0, 50.0], "path": {"kind": "modal"}}
DRAWN = {"kind": "loguniform", "low": 8, "high": 55}
MESH = MeanMesh(3e8, 800.0)


def loaded(mass_kg: object, inertia_kg_m2: object = None, **changes: object) -> Config:
    casing = {"mass_kg": mass_kg, "inertia_kg_m2": inertia_kg_m2}
    changes = {"dynamics__model": "casing", "dynamics__casing": casing, "housing": {"modal_mass_kg": None}, **changes}
    return load_config(minimal(sensors=[LID], duration_s=0.1, specimens=3, **changes))


def assembled(mass_kg: float) -> Structure:
    config = loaded(mass_kg)
    specimen = draw_specimen(config, 0)
    return locked_load(structure(specimen.dynamics, gear_pair(specimen.gears), specimen.sensors))


def test_a_casing_without_end_to_its_mass_stands_still_and_passes_the_force_to_rigid_seats() -> None:
    hz = np.array([400.0, 1500.0, 4000.0])
    moved, pressed = [], []
    for mass_kg in (1e5, 1e6, 1e7):
        stage = assembled(mass_kg)
        found = forced_motion(stage, MESH, stage.mesh_vector[None, :], ("casing_lid/vertical",), hz)
        moved.append(np.abs(found.acceleration["casing_lid/vertical"][0]))
        pressed.append(found.bearing_force["pinion_bearing/vertical"][0])
    # what is left of the motion is force over mass: the next order is mass of the gears (4 kg) over that of the casing
    np.testing.assert_allclose(moved[1] / moved[2], 10.0, rtol=1e-4)
    np.testing.assert_allclose(moved[0] / moved[1], 10.0, rtol=1e-3)
    # seats at rest: the gears on their bearings alone, solved for with the casing's rows struck out
    stage = assembled(1e7)
    kept = [i for i, name in enumerate(stage.coordinates) if name not in {"x_c", "y_c", "phi_c"}]
    p = stage.mesh_vector
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
    p, omegas = stage.mesh_vector, 2.0 * np.pi * np.array([300.0, 640.0, 2500.0])
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
    specimen, height_m = draw_specimen(config, 0), 0.05
    pair = gear_pair(specimen.gears)
    stage = locked_load(structure(specimen.dynamics, pair, specimen.sensors))
    direction = stage.motions["casing_lid/horizontal"]
    found = forced_motion(stage, MESH, direction[None, :], ("casing_lid/horizontal",), np.array([2e5]))
    inertia = 12.0 * (1.15 * pair.working_centre_distance_m) ** 2
    expected = 1.0 / 12.0 + height_m**2 / inertia
    assert found.acceleration["casing_lid/horizontal"][0, 0].real == pytest.approx(expected, rel=1e-3)


def test_flexible_modes_have_the_mass_of_the_casing_that_was_drawn() -> None:
    drawn = loaded(DRAWN)
    masses = []
    for specimen_id in range(3):
        housing = specimen_housing(drawn, specimen_id)
        assert housing is not None
        mass_kg = draw_specimen(drawn, specimen_id).dynamics.casing.mass_kg
        assert housing.modes.modal_mass_kg[0] == mass_kg
        masses.append(mass_kg)
        fixed = specimen_housing(loaded(20.0), specimen_id)
        assert fixed is not None
        # nothing but the mass differs
        assert housing.modes.frequency_hz.tobytes() == fixed.modes.frequency_hz.tobytes()
        ratio = housing.modes.modal_mass_kg / fixed.modes.modal_mass_kg
        np.testing.assert_allclose(ratio, float(mass_kg) / 20.0, rtol=1e-12)  # type: ignore[arg-type]
    assert len(set(masses)) == 3


def test_records_say_what_was_drawn_and_other_files_have_no_such_label() -> None:
    config = loaded(DRAWN)
    found = simulate(config, [0])[0]
    assert isinstance(found, Record)
    casing = draw_specimen(config, 0).dynamics.casing
    assert found.labels["casing_mass_kg"] == casing.mass_kg
    assert found.labels["casing_bolt_damping_ratio"] == casing.bolts.damping_ratio
    for other in (loaded(DRAWN, 0.25), loaded(20.0)):
        record = simulate(other, [0])[0]
        assert isinstance(record, Record)
        assert "casing_mass_kg" not in record.labels


def test_a_file_that_writes_the_old_values_out_has_the_identity_of_one_without_them() -> None:
    plain = {
        "dynamics__model": "casing",
        "housing": {},
        "background": {"floor": {}},
        "sensors": [LID],
        "duration_s": 0.1,
    }
    written = {**plain, "housing": {"modal_mass_kg": 20.0}, "background": {"floor": {"level_std": 0.0}}}
    written["dynamics__casing"] = {"inertia_kg_m2": 0.25}
    assert load_config(minimal(**plain)).identity == load_config(minimal(**written)).identity
    written["background"] = {"floor": {"level_std": 0.3}}
    assert load_config(minimal(**plain)).identity != load_config(minimal(**written)).identity
