"""What damage can move accuses only where no damage explains it: noise beyond lines, and small damage like large."""

from __future__ import annotations

import numpy as np
import pytest

from diagnostics.audit.bank import DESIGN, permuted
from diagnostics.audit.condition_layers import noise_excess
from diagnostics.audit.condition_leaks import sized_states, small_damage_detectors
from diagnostics.audit.measured_set import MeasuredSet, reference_records
from diagnostics.audit.raw_records import RawColumns
from diagnostics.judging.evaluation import held_out

GEARBOXES = 24
STATES = np.tile(["healthy", "again", "small", "large"], GEARBOXES)
SPECIMEN = np.repeat(np.arange(GEARBOXES), 4)
BAND = "noise_band6_db"
ORDERS = 200
"""Orders of which those from 81 on lie in the band at 20 Hz and 12.8 kHz."""


def measured(line_db: np.ndarray, noise_db: np.ndarray, levels: dict[str, np.ndarray]) -> MeasuredSet:
    """Return a set whose lines of the pinion, noise and raw levels are given, (records,) each."""
    damaged = np.isin(STATES, ["small", "large"])
    labels = {
        "specimen_id": SPECIMEN,
        "state": STATES,
        "fault": np.where(damaged, "spalling", "healthy"),
        "speed_hz": np.full(SPECIMEN.size, 20.0),
        "torque_nm": np.ones(SPECIMEN.size),
        "teeth_pinion": np.full(SPECIMEN.size, 18),
        "damaged_area_mm2": np.select([STATES == "small", STATES == "large"], [1.0, 4.0], 0.0),
    }
    values = {"pulses_per_s": np.full((SPECIMEN.size, 1), 20.0), BAND: noise_db[:, None]}
    waves = [[np.full(ORDERS, 10.0 ** (db / 20.0), np.complex64)] for db in line_db]
    raw = RawColumns(levels=levels, fs_hz=12_800.0)
    about = {"teeth": {"pinion": "teeth_pinion"}}
    snr = np.zeros((SPECIMEN.size, 1))
    return MeasuredSet(labels, ("a",), values, (), waves, [], snr, {}, [], raw=raw, about=about)


@pytest.mark.parametrize(
    ("lines_rise_db", "noise_rise_db", "excess_db"),
    [(6.0, 3.0, 0.0), (0.0, 1.0, 1.0), (6.0, 7.5, 1.5), (6.0, -1.0, -1.0), (-3.0, 1.0, 1.0)],
    ids=["leftover_of_lines", "noise_alone", "both", "noise_taken_away", "weaker_lines"],
)
def test_noise_counts_beyond_what_lines_leave_in_it(
    lines_rise_db: float, noise_rise_db: float, excess_db: float
) -> None:
    large = STATES == "large"
    found = measured(lines_rise_db * large, noise_rise_db * large, {})
    reference = reference_records(found)
    excess = noise_excess(found, reference, (BAND,))[BAND][:, 0]
    assert excess[large] == pytest.approx(excess_db, abs=1e-5)
    assert excess[STATES == "again"] == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(excess[STATES == "healthy"]).all()


def test_leftover_of_lines_in_noise_never_exceeds_the_rise_of_the_lines() -> None:
    line_db = np.linspace(-10.0, 10.0, SPECIMEN.size)
    for share in (1e-3, 0.1, 10.0):
        noise_db = 10.0 * np.log10(1.0 + share * 10.0 ** (line_db / 10.0))
        found = measured(line_db, noise_db, {})
        excess = noise_excess(found, reference_records(found), (BAND,))[BAND]
        assert np.nanmax(excess) == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize(
    ("small_db", "large_db", "is_told"),
    [(0.3, 0.3, True), (0.3, 1.2, False), (0.3, -1.2, False), (0.0, 1.2, False)],
    ids=["a_gain", "damage_that_grows", "damage_that_turns_over", "small_damage_without_effect"],
)
def test_small_damage_counts_only_where_large_damage_does_no_more(
    small_db: float, large_db: float, is_told: bool
) -> None:
    scatter = np.random.default_rng(3).normal(0.0, 0.1, (SPECIMEN.size, 4))
    effect = small_db * (STATES == "small") + large_db * (STATES == "large")
    levels = {f"level {k}": 10.0 * SPECIMEN + scatter[:, k] + effect * (k == 2) for k in range(4)}
    found = measured(np.zeros(SPECIMEN.size), np.zeros(SPECIMEN.size), levels)
    assert [smallest for smallest, _ in sized_states(found)] == ["small"]
    (detector,) = small_damage_detectors(found, reference_records(found))
    rows = np.flatnonzero(detector.usable)
    of_state, specimen = STATES[rows] == "small", SPECIMEN[rows]
    folds = DESIGN.dealt(SPECIMEN, 0)[:, rows]
    auc = held_out(detector, rows, of_state, specimen, folds, 0).auc.value
    # 24 and 24 records without any effect scatter by 0.08
    assert auc > 0.9 if is_told else auc < 0.75


def test_permuting_finds_the_columns_anew() -> None:
    levels = {"level": np.random.default_rng(4).normal(0.0, 0.1, SPECIMEN.size)}
    found = measured(np.zeros(SPECIMEN.size), np.zeros(SPECIMEN.size), levels)
    (detector,) = small_damage_detectors(found, reference_records(found))
    rows = np.flatnonzero(detector.usable)
    ways = permuted(STATES[rows] == "small", SPECIMEN[rows], SPECIMEN[rows], 0, 20)
    folds = DESIGN.dealt(SPECIMEN, 0)[:, rows]
    areas = [held_out(detector, rows, way, SPECIMEN[rows], folds, 0).auc.value for way in ways]
    assert np.mean(areas) == pytest.approx(0.5, abs=0.06)  # 20 of a spread of 0.1
