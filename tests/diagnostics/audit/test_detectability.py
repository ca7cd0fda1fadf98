"""AUC of planted effects, pairs of records, and the interpolated area of damage."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from planted_set import Plant, measured

from diagnostics.audit.detectability import (
    Detectability,
    area_at,
    dealt,
    detections,
    features,
    state_auc,
    waveform_change,
)
from diagnostics.audit.measured_set import MeasuredSet, exchange_blocks, reference_records
from diagnostics.statistics.evaluation import Interval


@pytest.fixture(scope="module")
def repeated(tmp_path_factory: pytest.TempPathFactory) -> MeasuredSet:
    """Two records per state at one operating point; in the severe state a pulse of ten times the mesh line."""
    return measured(Plant(specimens=8, points=1, repeats=2, severe_pulse=10.0), tmp_path_factory)


def planted_scores(shift: float, specimens: int = 60) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One feature with a specimen's offset (spread 1) and noise (spread 0.5), shifted in the faulty records."""
    rng = np.random.default_rng(11)
    specimen = np.repeat(np.arange(specimens), 4)
    positive = np.tile([False, False, True, True], specimens)
    value = rng.standard_normal(specimens)[specimen] + 0.5 * rng.standard_normal(specimen.size) + shift * positive
    return value[:, None], positive, specimen


def test_auc_of_a_planted_shift_is_that_of_two_normal_laws() -> None:
    values, positive, specimen = planted_scores(1.5)
    area = state_auc(values, positive, specimen, seed=0)
    # difference of two independent records: spread sqrt(2 * 1.25); 30 specimens a side fix the AUC to about 0.05
    expected = 0.5 * (1 + math.erf(1.5 / math.sqrt(2.5) / math.sqrt(2)))
    assert area[0] == pytest.approx(expected, abs=0.08)
    low, high = np.nanquantile(area[1:], [0.025, 0.975])
    assert low < expected < high


def test_auc_without_an_effect_is_chance() -> None:
    values, positive, specimen = planted_scores(0.0)
    # held-out scores of an effectless feature lean below 0.5 by the usual bias of cross-validation
    assert 0.35 < state_auc(values, positive, specimen, seed=0)[0] < 0.58


def test_no_specimen_serves_both_classes_and_folds_hold_whole_specimens() -> None:
    specimen = np.repeat(np.arange(20), 3)
    half, fold = dealt(specimen, seed=1, repeat=2)
    for owner in range(20):
        assert np.unique(half[specimen == owner]).size == np.unique(fold[specimen == owner]).size == 1
    assert half.sum() == 30
    assert {int(np.sum(half[fold == k])) for k in range(5)} == {6}


def test_a_pulse_is_detected_and_its_absence_is_not(repeated: MeasuredSet) -> None:
    found = {entry.state: entry.auc.value for entry in detections(repeated, features(repeated))}
    assert found["severe"] > 0.95
    assert found["slight"] < 0.75  # 8 specimens: four a class


def test_all_records_at_a_point_stand_beside_one_healthy_record_that_is_not_judged(repeated: MeasuredSet) -> None:
    reference, labels = reference_records(repeated), repeated.labels
    beside = reference >= 0
    assert np.array_equal(np.flatnonzero(~beside), np.unique(reference[beside]))
    assert np.all(repeated.healthy[reference[beside]])
    keys = [labels[name] for name in ("specimen_id", "operating_point_id")]
    for key in keys:
        assert np.array_equal(key[beside], key[reference[beside]])
    assert np.unique(reference[beside]).size == np.unique(np.stack(keys), axis=1).shape[1]
    blocks = exchange_blocks(repeated)
    alike = blocks[beside][:, None] == blocks[beside]
    assert np.array_equal(alike, reference[beside][:, None] == reference[beside])
    assert np.all(np.bincount(blocks)[blocks[~beside]] == 1)


def test_records_beyond_one_percent_torque_have_no_pair(repeated: MeasuredSet) -> None:
    torque = repeated.labels["torque_nm"] * np.where(repeated.healthy, 1.0, 1.011)
    found = reference_records(replace(repeated, labels={**repeated.labels, "torque_nm": torque}))
    assert np.all(found[~repeated.healthy] == -1)
    assert np.sum(found[repeated.healthy] >= 0) == repeated.healthy.sum() / 2


def test_without_repeats_healthy_records_have_no_pair_and_no_auc_is_given(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    single = measured(Plant(), tmp_path_factory)
    assert np.all(reference_records(single) == -1)
    assert all(math.isnan(entry.auc.value) for entry in detections(single, features(single, paired=True)))


def test_paired_differences_and_waveforms_find_the_pulse(repeated: MeasuredSet) -> None:
    paired = features(repeated, paired=True)
    assert paired.shape == (48, 6)
    assert np.array_equal(np.isfinite(paired).all(axis=1), reference_records(repeated) >= 0)
    for values in (paired, waveform_change(repeated)):
        found = {entry.state: entry.auc.value for entry in detections(repeated, values)}
        assert found["severe"] > 0.95


def entry(area: float, auc: float, fault: str = "spalling") -> Detectability:
    sizes = {"damaged_area_mm2": area, "damage_profile_length_mm": 0.4}
    return Detectability(f"s{area}", fault, sizes, Interval(auc, auc - 0.1, auc + 0.1), 20)


def test_damage_through_the_face_is_a_kind_of_its_own(repeated: MeasuredSet) -> None:
    through = repeated.labels["state"] == "severe"
    labelled = replace(repeated, labels={**repeated.labels, "through_face": through})
    kinds = {entry.state: entry.fault for entry in detections(labelled, features(labelled))}
    assert kinds["severe"] == f"{kinds['slight']} through the face"


def test_area_at_an_auc_is_interpolated_between_states_that_grow_in_area_alone() -> None:
    found = area_at([entry(0.5, 0.6), entry(1.0, 0.8), entry(2.0, 0.9), entry(1.0, 0.5, "pitting")], 0.85)
    assert found["spalling"] is not None
    assert found["spalling"].area_mm2 == pytest.approx(1.5)
    assert not found["spalling"].is_upper_bound
    assert found["pitting"] is None
    first = area_at([entry(0.5, 0.9)], 0.85)["spalling"]
    assert first is not None
    assert first.is_upper_bound


def test_states_of_one_area_give_no_area_at_an_auc() -> None:
    of_one_area = [entry(1.0, 0.6), entry(1.0, 0.7), entry(1.0, 0.9)]
    assert area_at(of_one_area, 0.85) == {}
    assert area_at([*of_one_area, entry(0.5, 0.9, "pitting")], 0.85).keys() == {"pitting"}
