from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from siggen.drivetrain.structure import Structure
from siggen.mesh.mesh_tables import MeshTables
from siggen.motion.response import Response
from tests.dynamics.conftest import BASE_PITCH, BASE_RADIUS_1, PRESSURE_ANGLE, make_tables
from tests.dynamics.linear_runs import simulate_response

PINION = "pinion_bearing/vertical"
CASE = {
    "torque_nm": 60.0,
    "speed_hz": 30.0,
    "start_angle_rad": 0.3,
    "mesh_damping_ratio": 0.07,
    "backlash_m": 80e-6,
    "fs_hz": 51200.0,
    "samples": 5120,
    "steps_per_sample": 4,
}


def respond(structure: Structure, tables: MeshTables, **changes) -> Response:
    return simulate_response(structure, tables, **{**CASE, **changes})


def difference(first: Mapping[str, np.ndarray], second: Mapping[str, np.ndarray]) -> float:
    """Return the rms difference over the rms of the second, the worst of all places."""
    return max(np.sqrt(((first[k] - second[k]) ** 2).mean() / (second[k] ** 2).mean()) for k in second)


def test_bearings_carry_the_mesh_force_of_the_torque(structure: Structure, sharp_tables: MeshTables) -> None:
    # 0.5 s are 15 whole revolutions: the mean of the dynamic force vanishes, up to the filter's aliases of 1e-6.
    response = respond(structure, sharp_tables, samples=25600, internals=True)
    force = CASE["torque_nm"] / BASE_RADIUS_1
    means = {place: values.mean() for place, values in response.bearing_force_n.items()}
    sine, cosine = np.sin(PRESSURE_ANGLE), np.cos(PRESSURE_ANGLE)
    assert means["pinion_bearing/vertical"] == pytest.approx(-force * cosine, rel=1e-6)
    assert means["pinion_bearing/horizontal"] == pytest.approx(-force * sine, rel=1e-6)
    assert means["gear_bearing/vertical"] == pytest.approx(force * cosine, rel=1e-6)
    assert means["gear_bearing/horizontal"] == pytest.approx(force * sine, rel=1e-6)
    # The mesh force is given at instants, where its jumps of up to 1 kN alias into the mean.
    assert response.internals["mesh_force_n"].mean() == pytest.approx(force, rel=1e-3)


def test_newtons_law_joins_acceleration_and_bearing_force(structure: Structure, ramp_tables: MeshTables) -> None:
    response = respond(structure, ramp_tables, steps_per_sample=16, internals=True)
    force = response.internals["mesh_force_n"] * np.cos(PRESSURE_ANGLE)
    balance = 0.412 * response.acceleration_m_s2[PINION] + response.bearing_force_n[PINION] + force
    # 0.1 s hold 54 meshes. The mesh force is given at instants, not low-passed, so lines from above the band fold
    # into it: measured 6e-5 of a line below 10 kHz.
    ratio = np.abs(np.fft.rfft(balance) / np.fft.rfft(force))[54:1000:54]
    assert ratio.max() < 2e-4


def test_internals_obey_the_law_of_the_mesh(structure: Structure, sharp_tables: MeshTables) -> None:
    inner = respond(structure, sharp_tables, internals=True).internals
    spring = inner["mesh_stiffness_n_per_m"] * (inner["approach_m"] - 40e-6)
    damper = inner["mesh_force_n"] - spring
    ratio = damper / inner["approach_rate_m_s"]
    # One constant damping: digits are lost where the rate is small.
    well = np.abs(inner["approach_rate_m_s"]) > 1e-3
    np.testing.assert_allclose(ratio[well], np.median(ratio), rtol=1e-6)
    assert np.median(ratio) > 0.0


def test_integrators_converge_to_the_same_response(structure: Structure, ramp_tables: MeshTables) -> None:
    product = respond(structure, ramp_tables)
    classical = respond(structure, ramp_tables, integrator="runge_kutta", steps_per_sample=32)
    # Measured 5e-5: product integration at 4 steps per sample, Runge-Kutta's kinks at 32.
    assert difference(product.acceleration_m_s2, classical.acceleration_m_s2) < 1e-4
    assert difference(product.bearing_force_n, classical.bearing_force_n) < 1e-5


def test_a_light_torque_near_the_mesh_resonance_loses_contact(structure: Structure) -> None:
    place = np.linspace(0.0, 1.0, 65)
    tables = make_tables((1.6e8 * (0.6 + 1.6 * place * (1.0 - place)))[None, :])
    case = {"torque_nm": 20.0, "speed_hz": 300.0, "mesh_damping_ratio": 0.01, "internals": True}
    loose = respond(structure, tables, **case)
    fine = respond(structure, tables, **case, integrator="runge_kutta", steps_per_sample=64)
    inside = np.abs(loose.internals["approach_m"]) <= 40e-6
    assert loose.contact_loss_share > 0.3
    assert (loose.internals["mesh_force_n"][inside] == 0.0).all()
    # Counted at every integration step and, here, at the samples: a quarter of them.
    assert loose.contact_loss_share == pytest.approx(inside.mean(), abs=0.01)
    # Measured 0.4922 and 0.4916, rms 2328.46 and 2328.50 m/s²; parting and touching are met within a substep.
    assert loose.contact_loss_share == pytest.approx(fine.contact_loss_share, abs=0.003)
    assert loose.acceleration_m_s2[PINION].std() == pytest.approx(fine.acceleration_m_s2[PINION].std(), rel=1e-3)
    assert respond(structure, tables, **{**case, "backlash_m": 0.0}).contact_loss_share == 0.0


def test_an_unstable_step_is_reported_with_numbers_and_without_samples(
    structure: Structure, sharp_tables: MeshTables
) -> None:
    # 49000 rad/s at 78 µs per step is 3.8; classical Runge-Kutta is stable to 2.8.
    response = respond(structure, sharp_tables, integrator="runge_kutta", fs_hz=12800.0, steps_per_sample=1)
    assert response.status == "diverged"
    assert "allowed are finite values within" in response.reason
    assert f"{40e-6 + 0.1 * BASE_PITCH:.3e}" in response.reason
    assert response.acceleration_m_s2[PINION].size == response.angle_rad.size == 0
    assert response.contact_loss_share == 0.0


def test_sample_zero_is_at_the_start_angle(structure: Structure, sharp_tables: MeshTables) -> None:
    response = respond(structure, sharp_tables)
    assert response.angle_rad[0] == 0.3
    turns = np.interp(response.tacho_s, np.arange(5120) / 51200.0, response.angle_rad) / (2.0 * np.pi)
    assert np.abs(turns - np.round(turns)).max() < 1e-9
    # The same motion begun 100 samples later in angle is the same signal 100 samples earlier.
    later = respond(structure, sharp_tables, start_angle_rad=0.3 + 2.0 * np.pi * 30.0 * 100 / 51200.0)
    first, second = response.acceleration_m_s2[PINION][100:], later.acceleration_m_s2[PINION][:-100]
    # What differs is the rest of the transient: measured 3e-6.
    assert np.abs(first - second).max() < 1e-5 * first.std()


def test_a_shorter_record_is_the_beginning_of_a_longer_one(structure: Structure, sharp_tables: MeshTables) -> None:
    short, long = (respond(structure, sharp_tables, samples=n) for n in (1000, 5000))
    for place, values in short.acceleration_m_s2.items():
        assert values.tobytes() == long.acceleration_m_s2[place][:1000].tobytes()
