"""Which internal quantities a set stores follows from its configuration; every record then has them."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.config import parse, parse_yaml
from siggen.errors import ConfigError
from siggen.gearbox.design import SetDesign
from siggen.gearbox.plan import planned_record
from siggen.mesh.contact_names import OF_CONTACT_ALONE
from siggen.record.quantities import internal_quantities
from siggen.record.simulation import record_response
from siggen.record.specimen_state import specimen_state
from siggen.record.structure import structure
from siggen.sets.drawn import stored_quantities
from tests.simulated import internals_table, simulate

SHORT = ["duration_s=0.05", "specimens=2"]


@pytest.mark.parametrize("name", ["tests/configs/linear_pits.yaml", "configs/paper_b.yaml"])
def test_every_record_has_the_quantities_of_the_configuration(name: str) -> None:
    config = load_config(name, [*SHORT, "internals.quantities=[all]"])
    names = {column.name for column in stored_quantities(config)}
    last = config.records_per_specimen * 2 - 1
    for record in simulate(config, [0, last]):
        assert isinstance(record, SimulatedRecord)
        assert set(record.internals) == names
        assert all(values.dtype == np.float32 and len(values) == config.samples for values in record.internals.values())


def test_stored_series_are_those_of_the_command(tmp_path) -> None:
    config = load_config("tests/configs/linear_pits.yaml", [*SHORT, "internals.quantities=[all]"])
    (stored,) = simulate(config, [2])
    table = internals_table(config, 2)
    for name, values in stored.internals.items():
        if name != "pinion_angle_rad":
            np.testing.assert_array_equal(values, table[name].to_numpy().astype(np.float32))
    turns = (table["angle_rad"].to_numpy() - stored.internals["pinion_angle_rad"]) / (2.0 * np.pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-6)  # float32 of an angle below 2 pi


def test_signals_do_not_depend_on_whether_internals_are_stored() -> None:
    with_them, without = (
        simulate(load_config("tests/configs/linear_pits.yaml", [*SHORT, *extra]), [1])[0]
        for extra in (["internals.quantities=[all]"], [])
    )
    for channel, signal in without.channels.items():
        assert signal.tobytes() == with_them.channels[channel].tobytes()


def test_units_follow_from_the_names() -> None:
    config = load_config("tests/configs/casing.yaml", [*SHORT, "internals.quantities=[all]"])
    units = {column.name: column.unit for column in stored_quantities(config)}
    expected = {
        "mesh_force_n": "N", "mesh_stiffness_n_per_m": "N/m", "mesh_damping_n_s_per_m": "N s/m", "approach_m": "m",
        "approach_rate_m_s": "m/s", "pair_0_load_share": "", "phi_casing_rad": "rad", "friction_moment_gear_nm": "N m",
        "clean_accel_casing_lid_vertical_m_s2": "m/s^2",
    }  # fmt: skip
    assert {name: units[name] for name in expected} == expected


def test_quantities_that_the_model_lacks_are_refused_at_load_beside_the_nearest_names() -> None:
    asked = "internals.quantities=[mesh_force_n, mesh_stifness, all, x_casing_m]"
    with pytest.raises(ConfigError) as caught:
        load_config("tests/configs/linear_pits.yaml", [*SHORT, asked])
    first, second = caught.value.problems
    assert (first.path, first.received) == ("internals.quantities.1", "'mesh_stifness'")
    assert "nearest: mesh_stiffness_n_per_m, " in first.allowed
    assert second.path == "internals.quantities.3"
    assert len(str(second)) < 300  # not the list of all names


def test_a_configuration_not_loaded_from_a_file_is_refused_before_anything_is_stored() -> None:
    parsed = parse(
        parse_yaml(Path("tests/configs/linear_pits.yaml").read_text() + "\ninternals: {quantities: [x_casing_m]}\n")
    )
    with pytest.raises(ConfigError, match=r"internals\.quantities\.0: received 'x_casing_m'"):
        stored_quantities(SetDesign(parsed.config))


def test_what_only_a_contact_has_is_undefined_exactly_where_a_pair_carries_nothing() -> None:
    config = load_config("tests/configs/casing.yaml", [*SHORT, "internals.quantities=[all]"])
    (record,) = simulate(config, [config.records_per_specimen - 1])
    force = record.internals["pair_0_force_n"]
    assert 0.1 < np.mean(force == 0.0) < 0.9  # a pair is in contact for 1.6 of 2 pitches
    for name in OF_CONTACT_ALONE:
        np.testing.assert_array_equal(np.isnan(record.internals[f"pair_0_{name}"]), force == 0.0)
    meanings = {column.name: column.meaning for column in stored_quantities(config)}
    assert {name for name in meanings if "NaN" in meanings[name]} == {
        f"pair_{pair}_{name}" for pair in (0, 1) for name in OF_CONTACT_ALONE
    }


def test_the_transmission_error_of_tooth_pairs_holds_rotation_and_shifts_of_the_gears() -> None:
    config = load_config("tests/configs/casing.yaml", SHORT)
    specimen = config.gearbox(0)
    table = internals_table(config, 0)
    pair = specimen.pair
    assembled = structure(specimen)
    lengths = dict(zip(assembled.coordinates, assembled.mesh.vector, strict=True))
    assert lengths["theta_pinion"] == pytest.approx(pair.pinion.base_radius_m)
    assert lengths["theta_gear"] == pytest.approx(-pair.gear.base_radius_m)
    columns = {name: next(c for c in table.column_names if c.startswith(f"{name}_")) for name in lengths}
    moved = sum(length * table[columns[name]].to_numpy() for name, length in lengths.items())
    # Micrometres as the difference of rotations whose rounding is that of their size.
    np.testing.assert_allclose(table["transmission_error_m"].to_numpy(), moved, atol=1e-12)
    np.testing.assert_array_equal(table["transmission_error_m"].to_numpy(), table["approach_m"].to_numpy())
    turned = sum(lengths[name] * table[columns[name]].to_numpy() for name in ("theta_pinion", "theta_gear"))
    assert np.abs(turned - moved).max() > 1e-7  # bearings give way


STREAMED = ["specimens=1", "internals.quantities=[all]"]


@pytest.mark.parametrize(
    "name", ["tests/configs/linear_pits.yaml", "configs/quickstart.yaml", "tests/configs/casing.yaml"]
)
def test_streamed_internals_are_those_of_the_whole_response_to_the_last_bit(name: str) -> None:
    config = load_config(name, [*STREAMED, "duration_s=0.2"])  # more than two blocks
    planned, specimen = planned_record(config, 1), config.gearbox(0)
    (record,) = simulate(config, [1])
    state = specimen_state(specimen, planned.state_id)
    response, _ = record_response(specimen, state, planned, internals=True)
    whole = internal_quantities(specimen, response)
    assert list(record.internals) == list(whole)
    for quantity, values in whole.items():
        assert record.internals[quantity].tobytes() == values.astype(np.float32).tobytes(), quantity


def test_a_quantity_asked_for_by_name_is_the_same_as_among_all_and_kept_alone() -> None:
    few = ["approach_m", "clean_accel_pinion_bearing_vertical_m_s2"]
    (every,), (some,) = (
        simulate(load_config("tests/configs/casing.yaml", [*STREAMED, "duration_s=0.1", *extra]), [0])
        for extra in ([], [f"internals.quantities={few}"])
    )
    assert sorted(some.internals) == few
    assert all(some.internals[name].tobytes() == every.internals[name].tobytes() for name in few)
    assert all(some.channels[name].tobytes() == signal.tobytes() for name, signal in every.channels.items())


def test_memory_of_internals_grows_by_what_is_delivered() -> None:
    few = "internals.quantities=[approach_m, mesh_force_n]"
    peaks, delivered = [], []
    for duration_s in (
        0.1,
        4.0,
        8.0,
    ):  # the first one fills caches; from a filter's block of 2.6 s on nothing else grows
        config = load_config("tests/configs/linear_pits.yaml", [*STREAMED, few, f"duration_s={duration_s}"])
        tracemalloc.start()
        (record,) = simulate(config, [0])
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        delivered.append(sum(v.nbytes for v in (*record.channels.values(), *record.internals.values())))
    grown = (peaks[2] - peaks[1]) / (delivered[2] - delivered[1])
    assert 0.9 < grown < 1.1  # kept whole, as before, it was 19
