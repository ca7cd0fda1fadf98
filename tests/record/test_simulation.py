"""From a configuration to records: purity, grouping, failures, labels."""

from __future__ import annotations

import numpy as np
import pytest

from siggen.checks.loading import load_config
from siggen.columns.record import RecordFailure, SimulatedRecord
from siggen.gearbox.configured import pair_config, pair_of
from siggen.gearbox.design import SetDesign
from siggen.sets.drawn import simulated
from tests.simulated import damage_rows, internals_table, simulate

SMALL = ["specimens=2", "duration_s=0.1", "dynamics.input_coupling.damping_nm_s_per_rad=2.0"]


@pytest.fixture(scope="module")
def config() -> SetDesign:
    return load_config("tests/configs/linear_pits.yaml", SMALL)


@pytest.fixture(scope="module")
def specimen(config: SetDesign) -> list[SimulatedRecord]:
    results = list(simulated(config, range(config.records_per_specimen)))
    assert all(isinstance(r, SimulatedRecord) for r in results)
    return results  # type: ignore[return-value]


def test_records_of_several_specimens_come_back_in_the_order_asked_for(config: SetDesign) -> None:
    per_specimen = config.records_per_specimen
    ids = [per_specimen, 0, per_specimen + 1]
    assert [r.planned.record_id for r in simulate(config, ids) if isinstance(r, SimulatedRecord)] == ids


def test_simulating_two_specimens_as_one_is_refused(config: SetDesign) -> None:
    with pytest.raises(ValueError, match="specimens \\[0, 1\\]"):
        simulated(config, [0, config.records_per_specimen])


def test_states_of_a_specimen_share_speed_and_torque_but_not_noise_or_phase(specimen: list[SimulatedRecord]) -> None:
    same_point = [r for r in specimen if r.planned.operating_point_id == 0]
    assert len({(r.labels["speed_hz"], r.labels["torque_nm"]) for r in same_point}) == 1
    assert len({r.labels["start_angle_rad"] for r in same_point}) == len(same_point)


def test_force_over_approach_of_the_linear_law_loses_what_the_tables_lose(specimen: list[SimulatedRecord]) -> None:
    """Two computations: the pairs of the tables at rest, and the stiffness model searched for its largest loss."""
    for labels in (r.labels for r in specimen):
        # Interpolation between 2049 points, and a scan of 257 angles that is refined around its highest one.
        assert labels["mesh_stiffness_loss_as_simulated"] == pytest.approx(labels["mesh_stiffness_loss"], abs=1e-5)


def test_frequencies_are_those_of_the_teeth(specimen: list[SimulatedRecord]) -> None:
    for labels in (r.labels for r in specimen):
        # The mean speed is that of the angle's ends; rounding of an angle of up to 300 rad over 0.1 s leaves 1e-13.
        assert labels["pinion_shaft_hz"] == pytest.approx(labels["speed_hz"], rel=1e-10)
        assert labels["mesh_hz"] == pytest.approx(18 * labels["pinion_shaft_hz"], rel=1e-15)  # type: ignore[operator]
        assert labels["gear_shaft_hz"] == pytest.approx(labels["mesh_hz"] / 47, rel=1e-15)  # type: ignore[operator]


def test_impossible_damage_is_a_failure_with_a_reason_and_leaves_the_other_records() -> None:
    # Wide pits cover the face together: no contact length is left, which only the draw can show.
    config = load_config(
        "tests/configs/linear_pits.yaml",
        [*SMALL, "states.severe.damage.semi_axis_face_mm=6.0"],
    )
    results = list(simulated(config, range(config.records_per_specimen)))
    assert [type(r) for r in results[:6]] == [SimulatedRecord] * 6
    for failure in results[6:]:
        assert isinstance(failure, RecordFailure)
        assert failure.status == "impossible_damage"
        assert "contact length" in failure.reason


def test_a_torque_that_no_teeth_carry_is_a_failure_of_the_records_with_the_reason() -> None:
    law = ["dynamics.mesh.law=pairs", *(f"operating_points.{i}.torque_nm=2.0e+4" for i in range(2))]
    results = list(simulated(load_config("tests/configs/linear_pits.yaml", [*SMALL, *law]), [0, 2]))
    assert [r.status for r in results if isinstance(r, RecordFailure)] == ["outside_model"] * 2
    assert all("forces that teeth carry" in r.reason for r in results if isinstance(r, RecordFailure))


def test_a_fault_of_the_program_is_no_failure_of_a_record(config: SetDesign, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise ValueError("operands could not be broadcast together")

    monkeypatch.setattr("siggen.record.simulation.measured_channels", broken)
    with pytest.raises(ValueError, match="broadcast"):
        list(simulated(config, [0]))


PAIRS = (
    "gears.pairs=[{teeth: [19, 48], module_mm: 3.2, face_width_mm: 16}, "
    "{teeth: [21, 52], module_mm: 2, face_width_mm: 9}]"
)


def test_gearboxes_of_a_set_of_pairs_are_those_of_sets_of_one_pair_with_labels_that_tell_the_pair() -> None:
    config = load_config("tests/configs/linear_pits.yaml", [*SMALL, PAIRS])
    last = config.records_per_specimen - 1
    for specimen_id in range(2):
        index = pair_of(config.config, specimen_id)
        assert index is not None
        record_id = specimen_id * config.records_per_specimen + last
        found, alone = (simulate(one, [record_id])[0] for one in (config, SetDesign(pair_config(config.config, index))))
        assert isinstance(found, SimulatedRecord)
        assert isinstance(alone, SimulatedRecord)
        assert all(np.array_equal(found.channels[c], alone.channels[c]) for c in alone.channels)
        told = {key: value for key, value in found.labels.items() if key not in alone.labels}
        assert found.labels == {**alone.labels, **told}
        assert (told["pair"], told["module_mm"]) == (index, pytest.approx((3.2, 2.0)[index]))
        assert told["centre_distance_mm"] == pytest.approx((107.2, 73.0)[index])
        assert found.labels["teeth_gear"] == (48, 52)[index]
        # What commands show of a record is what the set stores.
        shown = internals_table(config, record_id)
        for channel, signal in found.channels.items():
            assert np.array_equal(shown[f"accel_{channel}_m_s2"].to_numpy(), signal)
        rows = damage_rows(config, record_id)
        assert len(rows) == found.labels["damage_count"]
