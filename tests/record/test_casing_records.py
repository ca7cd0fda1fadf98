"""Records of gearboxes with casing, tooth pairs and friction, from the configuration on."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config
from siggen.record.internals import internals_table
from siggen.record.simulation import simulate, simulate_specimen

SHORT = ["specimens=1", "duration_s=0.1"]
STIFF = ["dynamics.friction.model=off", "dynamics.mesh.damping=constant"]


@pytest.fixture(scope="module")
def config() -> Config:
    return load_config("tests/configs/casing.yaml", SHORT)


@pytest.fixture(scope="module")
def records(config: Config) -> list[Record]:
    results = list(simulate_specimen(config, [0, 9]))
    assert all(isinstance(r, Record) for r in results), results
    return results  # type: ignore[return-value]


def test_the_casing_shakes_and_the_teeth_stay_in_contact(records: list[Record]) -> None:
    for record in records:
        assert set(record.channels) == {"lid_vertical", "lid_horizontal"}
        for signal in record.channels.values():
            assert 0.1 < signal.std() < 100.0
        assert record.labels["contact_loss_share"] == 0.0
        assert record.labels["clipped_share_lid_vertical"] == 0.0


def test_a_record_is_the_same_alone(config: Config, records: list[Record]) -> None:
    alone = simulate(config, [9])[0]
    assert isinstance(alone, Record)
    for name, signal in alone.channels.items():
        assert signal.tobytes() == records[1].channels[name].tobytes()


def test_internals_name_what_no_sensor_sees(config: Config) -> None:
    table = internals_table(config, 9)
    force = table["mesh_force_n"].to_numpy()
    shares = sum(table[f"pair_{slot}_load_share"].to_numpy() for slot in range(2))
    np.testing.assert_allclose(shares, 1.0, rtol=1e-12)
    torque = float(table.schema.metadata[b"torque_nm"])
    base_radius = 0.5 * 3e-3 * 18 * np.cos(np.radians(20.0))
    # The mean of T_m = R_b1 ΣN + Σ s F, so friction of 3 to 6 % changes the mean force by half a per cent.
    assert force.mean() == pytest.approx(torque / base_radius, rel=0.01)
    moment = table["friction_moment_pinion_nm"].to_numpy()
    assert (base_radius * force + moment).mean() == pytest.approx(torque, rel=2e-3)
    of_pairs = (
        "force_n", "load_share", "friction_n", "friction_moment_pinion_nm", "friction_moment_gear_nm",
        "damping_n_s_per_m", "friction_coefficient", "central_film_m", "film_ratio", "asperity_share",
        "hertz_pressure_pa", "sliding_m_s",
    )  # fmt: skip
    expected = {f"pair_{slot}_{name}" for slot in range(2) for name in of_pairs}
    expected |= {"friction_force_n", "friction_moment_gear_nm", "mesh_damping_n_s_per_m", "transmission_error_m"}
    expected |= {"x_c_m", "y_c_m", "phi_c_rad", "clean_accel_casing_lid_vertical_m_s2"}
    expected |= {
        f"bearing_force_{g}_bearing_{axis}_n" for g in ("pinion", "gear") for axis in ("vertical", "horizontal")
    }
    assert expected <= set(table.column_names)


def test_flanks_inside_damage_run_on_thinner_films_and_rub_more(config: Config) -> None:
    def of_contacts(record_id: int, name: str) -> np.ndarray:
        table = internals_table(config, record_id)
        slots = [table[f"pair_{slot}_{name}"].to_numpy() for slot in range(2)]
        loads = [table[f"pair_{slot}_load_share"].to_numpy() for slot in range(2)]
        # Loaded contacts alone: where a pair enters or leaves, films of light loads are thick whatever the flank.
        return np.concatenate([values[load > 0.9] for values, load in zip(slots, loads, strict=True)])

    # At the third speed 0.1 s holds more than three revolutions: healthy, severe pits, spalls of half and whole face.
    ratios = {record_id: of_contacts(record_id, "film_ratio").min() for record_id in (2, 11, 14)}
    assert ratios[11] < 0.8 * ratios[2]
    assert ratios[14] < 0.8 * ratios[2]
    rubbing = {record_id: of_contacts(record_id, "friction_coefficient").max() for record_id in (2, 11, 14, 17)}
    # Pits carry next to nothing; the edges of spalls do, up to the boundary coefficient where no land is left.
    assert rubbing[11] == pytest.approx(rubbing[2], rel=0.02)
    assert 1.1 * rubbing[2] < rubbing[14] < rubbing[17] <= 0.11


def test_the_set_labels_healthy_pitted_and_spalled_gearboxes_at_three_speeds(config: Config) -> None:
    assert len(config.operating_points) == 3
    assert {(state.fault, state.severity) for state in config.states} == {
        ("healthy", "healthy"), ("pitting", "slight"), ("pitting", "moderate"), ("pitting", "severe"),
        ("spalling", "moderate"), ("spalling", "severe"),
    }  # fmt: skip


def test_internals_of_a_record_on_a_housing_of_plates_hold_what_the_set_does() -> None:
    overrides = [*SHORT, *STIFF, "dynamics.steps_per_sample=1"]
    config = load_config("industrial", overrides)
    table = internals_table(config, 0)
    result = simulate(config, [0])[0]
    assert isinstance(result, Record)
    assert table["accel_lid_axial_m_s2"].to_numpy().tobytes() == result.channels["lid_axial"].tobytes()
    assert table.num_rows == config.samples


def test_tooth_pairs_work_on_the_ground() -> None:
    sensor = ["sensors.0.place=pinion_bearing", "sensors.0.axes=[vertical]"]
    raw = [*SHORT, *STIFF, "dynamics.model=8dof", "sensors.0.position_mm=null", "housing={}"]
    raw += ["sensors.0.range_m_s2=10000.0"]
    result = simulate(load_config("tests/configs/casing.yaml", [*raw, *sensor]), [0])[0]
    assert isinstance(result, Record)
    assert all(signal.std() > 0.1 for signal in result.channels.values())


def test_friction_changes_the_vibration_and_keeps_the_speed(config: Config) -> None:
    smooth = simulate(load_config("tests/configs/casing.yaml", [*SHORT, *STIFF]), [0])[0]
    rough = simulate(config, [0])[0]
    assert isinstance(smooth, Record)
    assert isinstance(rough, Record)
    assert rough.channels["lid_horizontal"].std() > 1.5 * smooth.channels["lid_horizontal"].std()
    assert rough.labels["mesh_hz"] == pytest.approx(smooth.labels["mesh_hz"], rel=1e-12)  # type: ignore[arg-type]


def test_the_mean_friction_of_the_oil_is_that_of_lubricated_gears() -> None:
    overrides = [*SHORT, "dynamics.friction.roughness_um=0.4"]
    table = internals_table(load_config("tests/configs/casing.yaml", overrides), 1)
    friction = sum(np.abs(table[f"pair_{slot}_friction_n"].to_numpy()) for slot in range(2))
    # Load-weighted mean over the mesh; lubricated steel gears show 0.02 to 0.08.
    assert 0.02 < friction.sum() / table["mesh_force_n"].to_numpy().sum() < 0.08
