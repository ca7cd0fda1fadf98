from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.dynamics.structure.bearing_caps import Caps
from siggen.dynamics.structure.free_rotation import static_solution
from siggen.dynamics.structure.structure import vector
from siggen.dynamics.time.modes import natural_modes
from siggen.record.simulation import simulate
from tests.dynamics.casing_stage import BASE_RADIUS_1, MEAN_STIFFNESS, make_structure
from tests.dynamics.natural_frequencies import natural_frequencies_hz

CAPS = Caps(mass_kg=0.3, horizontal_stiffness_n_per_m=1e9, vertical_stiffness_n_per_m=1.2e9, damping_ratio=0.03)
# Lighter or stiffer ones would leave nothing of the soft shafts but rounding, 1e-16 of k/m.
STIFF = Caps(mass_kg=1e-3, horizontal_stiffness_n_per_m=1e12, vertical_stiffness_n_per_m=1e12, damping_ratio=0.03)


def test_caps_that_sit_rigidly_leave_the_casing_as_it_was() -> None:
    bare = natural_frequencies_hz(make_structure(), MEAN_STIFFNESS)
    found = natural_frequencies_hz(make_structure(caps=STIFF), MEAN_STIFFNESS)
    assert found.size == 19
    # Four caps add 2e-4 to the casing's mass, and seats in series 1e-4 to the bearings' flexibility; half of it each.
    np.testing.assert_allclose(found[:11], bare, rtol=1.5e-4)
    # The rest is the caps themselves on their seats and the bearings.
    assert found[11] > 1e6


def test_caps_soften_the_gearbox_and_add_eight_modes() -> None:
    structure = make_structure(caps=CAPS)
    bare, found = natural_frequencies_hz(make_structure(), MEAN_STIFFNESS), natural_modes(structure, MEAN_STIFFNESS)
    assert structure.coordinates[11:] == ("x_1a", "y_1a", "x_1b", "y_1b", "x_2a", "y_2a", "x_2b", "y_2b")
    assert (found.frequency_hz == 0.0).sum() == 1
    assert (found.frequency_hz[1:11] < bare[1:]).all()
    # Both caps of a shaft against each other, gear and casing at rest: √((k_seat + k_b)/m_cap).
    for seat in (1e9, 1.2e9):
        alone = np.sqrt((seat + 1e8) / 0.3) / (2.0 * np.pi)
        assert (np.abs(found.frequency_hz / alone - 1.0) < 1e-9).sum() == 2


def test_seats_carry_the_mesh_force_and_caps_give_way_to_it() -> None:
    structure = make_structure(caps=CAPS)
    loaded = structure.stiffness + MEAN_STIFFNESS * np.outer(structure.mesh_vector, structure.mesh_vector)
    q = static_solution(structure, loaded, 30.0 * structure.torque_vector)
    force = 30.0 / BASE_RADIUS_1 * np.cos(np.radians(20.0))
    seat = structure.bearing_forces["pinion_bearing/vertical"][0] @ q
    assert seat == pytest.approx(-force, rel=1e-9)
    given = structure.motions["pinion_cap/vertical"] @ q - structure.motions["pinion_bearing/vertical"] @ q
    assert given == pytest.approx(-0.5 * force / 1.2e9, rel=1e-6)


def test_a_whole_translation_deforms_bolts_alone() -> None:
    structure = make_structure(caps=CAPS)
    moved = vector(structure.coordinates, {name: 1.0 for name in structure.coordinates if name.startswith("x_")})
    bare = make_structure()
    alone = vector(bare.coordinates, {name: 1.0 for name in bare.coordinates if name.startswith("x_")})
    assert moved @ structure.stiffness @ moved == pytest.approx(alone @ bare.stiffness @ alone, rel=1e-9)


def test_a_sensor_on_a_cap_shakes_more_than_the_casing() -> None:
    changes = ["duration_s=0.05", "specimens=1", "dynamics.casing.caps.mass_kg=0.3", "sensors.0.place=pinion_cap"]
    config = load_config("tests/configs/casing.yaml", [*changes, "sensors.0.position_mm=null"])
    (on_cap,) = simulate(config, [0])
    seat = load_config(
        "tests/configs/casing.yaml", [*changes[:3], "sensors.0.place=pinion_bearing", "sensors.0.position_mm=null"]
    )
    (on_casing,) = simulate(seat, [0])
    assert on_cap.channels["lid_vertical"].std() > 1.5 * on_casing.channels["lid_vertical"].std()
