"""A sham that nothing tells from healthy records passes; one that a leak tells does not, and the summary says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diagnostics.audit.bank import sham_leaks, sham_sentences, shams_found
from diagnostics.audit.condition_leaks import level_detectors
from diagnostics.audit.measured_set import MeasuredSet
from diagnostics.audit.raw_records import RawColumns
from diagnostics.judging.alarms import judged_alarm
from diagnostics.judging.learners import best_column

GEARBOXES = 24
SPECIMEN = np.repeat(np.arange(GEARBOXES), 4)
STATES = np.tile(["healthy", "again", "sham", "severe"], GEARBOXES)
LABELS = {
    "specimen_id": SPECIMEN,
    "state": STATES,
    "state_id": np.tile(np.arange(4), GEARBOXES),
    "fault": np.where(STATES == "severe", "spalling", "healthy"),
    "sham": STATES == "sham",
    "speed_hz": np.full(SPECIMEN.size, 30.0),
    "torque_nm": np.ones(SPECIMEN.size),
    "damaged_area_mm2": np.where(STATES == "severe", 4.0, 0.0),
}


def measured(**labels: np.ndarray) -> MeasuredSet:
    values = {"pulses_per_s": np.full((SPECIMEN.size, 1), 30.0)}
    return MeasuredSet({**LABELS, **labels}, (), values, (), [], [], np.zeros((SPECIMEN.size, 1)), {}, [])


def noise(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal((SPECIMEN.size, 3))


def test_a_gain_of_shams_is_told_by_raw_levels_and_a_clean_set_is_not_accused() -> None:
    rms = np.random.default_rng(4).normal(0.0, 0.5, SPECIMEN.size)
    for gain_db, expected in ((0.0, []), (2.0, ["sham_told_from_healthy"])):
        raw = RawColumns(levels={"rms of lid": rms + gain_db * (STATES == "sham")})
        asked = replace(measured(), raw=raw)
        found = shams_found(asked, {"alone": level_detectors(asked, referenced=False)}, 0)
        assert [leak.leak for leak in sham_leaks(found)] == expected


def test_noise_tells_a_sham_as_often_as_chance_does() -> None:
    found = [
        shams_found(measured(), {"alone": [best_column("x", noise(seed), ("a", "b", "c"))]}, seed)[0]
        for seed in range(20)
    ]
    # more than 4 of 20 at 5 % each come in 0.3 % of the cases; the seeds are fixed
    assert sum(one.told for one in found) <= 4
    assert sham_leaks(found) == []
    passed = next(one for one in found if not one.told)
    assert sham_sentences([passed])[0].startswith("Shams, damage without effect, are not told from healthy: at most")


def test_a_leak_tells_a_sham() -> None:
    leaking = best_column("columns", noise(0) + 3.0 * (STATES == "sham")[:, None], ("a", "b", "c"))
    (found,) = shams_found(measured(), {"alone": [leaking]}, 0)
    assert found.told
    assert found.auc.value == 1.0
    assert [leak.leak for leak in sham_leaks([found])] == ["sham_told_from_healthy"]
    assert "is told from healthy: an AUC of 1.00" in sham_sentences([found])[0]


def test_damage_beside_it_does_not_count() -> None:
    # a column that tells damage and nothing else: a sham that stood among damaged records would be told by it
    damage = best_column("columns", noise(1) + 9.0 * (STATES == "severe")[:, None], ("a", "b", "c"))
    assert not shams_found(measured(), {"alone": [damage]}, 0)[0].told


def test_sets_without_one_are_asked_nothing() -> None:
    without = measured()
    del without.labels["sham"]
    assert shams_found(without, {"alone": [best_column("columns", noise(0), ("a", "b", "c"))]}, 0) == ()


def test_a_detector_has_the_area_of_shams_against_other_healthy_records() -> None:
    score = np.where(STATES == "sham", 1.0, 0.0)
    labels = {name: LABELS[name] for name in LABELS if name not in ("speed_hz", "torque_nm")}
    found = judged_alarm("planted", score, labels, seed=0)
    assert found is not None
    assert found.sham is not None
    assert found.sham.value == 1.0
    del labels["sham"]
    assert judged_alarm("planted", score, labels, seed=0).sham is None  # type: ignore[union-attr]
