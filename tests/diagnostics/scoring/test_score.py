"""Predictions are judged as an independent count says, whatever their order and form, and refused in one list."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
import pytest

import diagnostics
from diagnostics.indicators.classifier_table import feature_matrix
from diagnostics.records.recording import LABEL_NAMES
from diagnostics.scoring.abstain import risks
from diagnostics.scoring.prediction_file import predicted_rows, write_predictions
from diagnostics.scoring.score import Scores
from diagnostics.scoring.score_rows import ScoreRow
from diagnostics.scoring.tasks import truth_of
from diagnostics.statistics.evaluation import Predictions
from siggen.errors import UsageError
from tests.diagnostics.conftest import TEETH, MemoryDataset

AREA = "mean absolute error [mm²]"
CLASSES = ("healthy", "slight", "severe")
SEVERITY = {"healthy": 0.0, "slight": 1.0, "severe": 2.0}


def labels_of(dataset: Any, split: str) -> dict[str, np.ndarray]:
    table = dataset.labels(split, ["record_id", "specimen_id", "state"])
    return {name: np.asarray(table.column(name).to_pylist()) for name in table.column_names}


@pytest.fixture
def damage(dataset: Any) -> dict[str, np.ndarray]:
    """A number that rises with damage, with errors, of every record of the set."""
    found = dataset.labels(columns=["record_id", "state"])
    severity = np.array([SEVERITY[state] for state in found.column("state").to_pylist()])
    noise = np.random.default_rng(0).normal(size=severity.size)
    return {"record_id": found.column("record_id").to_numpy(), "damage": severity + noise}


def row(found: Scores, measure: str, records: str, name: str = "yours") -> ScoreRow:
    (one,) = [row for row in found.rows if (row.measure, row.records, row.name) == (measure, records, name)]
    return one


def test_detection_is_the_share_of_pairs_of_different_gearboxes(dataset: Any, damage: dict[str, np.ndarray]) -> None:
    found, labels = diagnostics.score(dataset, damage), labels_of(dataset, "test")
    value = dict(zip(damage["record_id"].tolist(), damage["damage"].tolist(), strict=True))
    of_record = list(zip(*(labels[name].tolist() for name in ("record_id", "specimen_id", "state")), strict=True))
    won = [
        value[damaged] > value[healthy]
        for damaged, own, state in of_record
        for healthy, other, at_rest in of_record
        if state == "slight" and at_rest == "healthy" and own != other
    ]
    assert row(found, "AUC", "slight").score.value == pytest.approx(np.mean(won), abs=1e-12)
    assert row(found, "AUC", "slight").score.low < np.mean(won) < row(found, "AUC", "slight").score.high
    assert {entry.task for entry in found.rows} == {"detect"}
    assert (found.records, found.gearboxes) == (24, 8)


def test_neither_order_nor_form_nor_records_of_other_splits_change_a_score(
    dataset: Any, damage: dict[str, np.ndarray], tmp_path: Path
) -> None:
    expected = diagnostics.score(dataset, damage).rows
    order = np.random.default_rng(1).permutation(damage["record_id"].size)
    shuffled = pa.table({name: column[order] for name, column in damage.items()})
    pa.csv.write_csv(shuffled, tmp_path / "own.csv")
    pq.write_table(shuffled, tmp_path / "own.parquet")
    test = np.isin(damage["record_id"], labels_of(dataset, "test")["record_id"])
    forms = (shuffled, tmp_path / "own.csv", str(tmp_path / "own.parquet"), {k: v[test] for k, v in damage.items()})
    for form in forms:
        assert diagnostics.score(dataset, form).rows == expected


def test_names_of_classes_and_of_states_are_graded(dataset: Any) -> None:
    labels = labels_of(dataset, "test")
    wrong = np.where(labels["state"] == "slight", "healthy", labels["state"])
    found = diagnostics.score(dataset, {"record_id": labels["record_id"], "class": wrong})
    assert [(entry.task, entry.measure) for entry in found.rows] == [("grade", "balanced accuracy")]
    assert found.rows[0].score.value == pytest.approx(2 / 3)
    assert found.rows[0].chance == pytest.approx(1 / 3)


def test_every_problem_comes_in_one_list(dataset: Any, damage: dict[str, np.ndarray]) -> None:
    first = labels_of(dataset, "test")["record_id"][:6]
    record_id, number = damage["record_id"], damage["damage"].copy()
    number[record_id == first[0]] = np.nan
    kept = record_id != first[1]
    wrong = {"record_id": np.append(record_id[kept], [first[2], 9999]), "damage": np.append(number[kept], [0.0, 0.0])}
    size = wrong["record_id"].size
    wrong |= {"p_healthy": np.full(size, 0.9), "p_slight": np.full(size, 0.3), "p_severe": np.full(size, -1.0)}
    wrong["p_broken"], wrong["class"] = np.zeros(size), np.array(["torn"] * size)
    with pytest.raises(UsageError) as caught:
        diagnostics.score(dataset, wrong)
    said = str(caught.value)
    for part in (
        "8 problems",
        "1 record not in the set: record_id 9999",
        f"1 record missing: record_id {first[1]}",
        f"1 record there more than once: record_id {first[2]}",
        f"damage is nan in 1 record (record_id {first[0]}); allowed: finite numbers",
        "p_severe is -1 in 23 records",
        "column p_broken is of no class",
        "class is 'torn' in 23 records",
        "the sum of the probabilities is 0.2 in 23 records",
        "24 records of the split test",
        "Classes: healthy, slight, severe.",
    ):
        assert part in said, said


@pytest.mark.parametrize(
    ("columns", "part"),
    [
        ({"id": [1]}, "no column record_id; received id"),
        ({"record_id": [1.5]}, "record_id holds double"),
        ({"record_id": [1]}, "no columns of a task"),
        ({"record_id": [1], "rul_h": [9.0]}, "rul_h, the remaining life, is asked of sets of lives alone"),
        ({"record_id": [1], "p_slight": [1.0]}, "no column p_healthy, p_severe"),
        ({"record_id": [1], "damage": ["high"]}, "damage holds string in 24 records .*; allowed: finite"),
        ({"record_id": [1, 2], "damage": [0.0]}, "no table .* all of one length"),
    ],
)
def test_columns_that_cannot_be_used_are_named(dataset: Any, columns: dict[str, list[Any]], part: str) -> None:
    test = labels_of(dataset, "test")["record_id"]
    if columns.get("record_id") == [1]:
        columns = {name: test if name == "record_id" else values * test.size for name, values in columns.items()}
    with pytest.raises(UsageError, match=part):
        diagnostics.score(dataset, columns)


def test_a_tooth_is_right_on_its_gear_alone(dataset: Any) -> None:
    labels = labels_of(dataset, "test")
    specimen, odd = labels["specimen_id"], labels["specimen_id"] % 2 == 1
    mine = {"record_id": labels["record_id"], "gear": np.where(odd, "gear", "pinion"), "tooth": specimen % TEETH[0]}
    part = "damage on teeth"
    found = diagnostics.score(dataset, mine)
    assert [row(found, f"share of right {what}", part).score.value for what in ("gears", "teeth")] == [1.0, 1.0]
    # a gear by lot is right in one of two cases, a tooth of it in one of 18 or 47: half of the gearboxes each
    assert row(found, "share of right teeth", part).chance == pytest.approx((1 / TEETH[0] + 1 / TEETH[1]) / 4)
    found = diagnostics.score(dataset, {**mine, "gear": np.full(specimen.size, "pinion")})
    assert row(found, "share of right gears", part).score.value == pytest.approx(np.mean(~odd))
    wrong = {**mine, "gear": np.where(odd, "wheel", "pinion"), "tooth": np.where(odd, -1, 99)}
    with pytest.raises(UsageError) as caught:
        diagnostics.score(dataset, wrong)
    for text in ("gear is 'wheel' in 12 records", "tooth is -1 in 12 records", "tooth is 99 in 12 records"):
        assert text in str(caught.value)


def test_an_error_in_area_is_that_of_its_mean(dataset: Any) -> None:
    labels, test = dataset.labels("test", ["record_id", "damaged_area_mm2"]), labels_of(dataset, "test")
    truth = labels.column("damaged_area_mm2").to_numpy()
    said = truth + np.where(test["specimen_id"] % 2, 1.0, 3.0)
    found = row(diagnostics.score(dataset, {"record_id": test["record_id"], "area_mm2": said}), AREA, "all")
    assert found.score.value == pytest.approx(2.0)
    assert 1.0 <= found.score.low < 2.0 < found.score.high <= 3.0
    assert found.chance == pytest.approx(np.abs(truth - np.median(truth)).mean())
    assert found.falls
    with pytest.raises(UsageError, match=r"area_mm2 is -1 in 24 records"):
        diagnostics.score(dataset, {"record_id": test["record_id"], "area_mm2": -np.ones(24)})


def test_few_gearboxes_get_limits_unless_they_agree_and_shares_exact_ones(dataset: Any, tmp_path: Path) -> None:
    """Resamples of four gearboxes that are all as wrong have no width; four that are all right still may be luck."""
    own, few = labels_of(dataset, "validation"), dataset.labels("validation", ["damaged_area_mm2", "state"])
    truth = np.array(few["damaged_area_mm2"].to_pylist())
    answers = {"record_id": own["record_id"], "area_mm2": truth + 2.0, "damage": truth}
    found = diagnostics.score(dataset, answers, split="validation")
    assert found.gearboxes == 4
    assert np.isnan(row(found, AREA, "all").score.low)
    assert row(found, "AUC", "severe").score.low == pytest.approx(0.025 ** (1 / 4))
    assert "4 gearboxes: too few to tell classifiers apart; that takes 6" in str(found)
    assert "is not told from chance" in found.verdict
    apart = {"record_id": own["record_id"], "area_mm2": truth + np.repeat([1.0, 2.0, 3.0, 4.0], truth.size // 4)}
    differing = row(diagnostics.score(dataset, apart, split="validation"), AREA, "all").score
    assert differing.value == pytest.approx(2.5)
    assert 1.0 <= differing.low < 2.5 < differing.high <= 4.0


def test_risk_is_counted_over_all_that_are_as_sure(dataset: Any) -> None:
    rng = np.random.default_rng(4)
    answers = np.stack([rng.integers(0, 6, 40), rng.integers(0, 2, 40)], axis=1).astype(np.float64)
    weights = rng.integers(0, 3, (5, 40)).astype(np.float64)
    covered, risk, drawn = risks(answers, weights)
    order = np.argsort(-answers[:, 0], kind="stable")
    assert np.array_equal(drawn, weights[:, order])
    for b in range(5):
        for k, record in enumerate(order):
            answered = answers[:, 0] >= answers[record, 0]
            share = weights[b, answered].sum()
            assert covered[b, k] == pytest.approx(share / weights[b].sum())
            if share:
                assert risk[b, k] == pytest.approx((weights[b] * answers[:, 1])[answered].sum() / share)
    labels = labels_of(dataset, "test")
    wrong = labels["specimen_id"] % 4 == 0
    named = np.where(wrong, np.where(labels["state"] == "severe", "healthy", "severe"), labels["state"])
    mine = {"record_id": labels["record_id"], "class": named}
    sure, unsure = (
        row(diagnostics.score(dataset, {**mine, "confidence": sign * wrong}), "risk at 80% coverage", "all")
        for sign in (-1.0, 1.0)
    )
    assert sure.score.value == pytest.approx(0.25)  # the wrong quarter is as unsure: answered together
    assert unsure.score.value == pytest.approx(0.25)
    mean = [
        row(diagnostics.score(dataset, {**mine, "confidence": c * wrong}), "mean risk over all coverages", "all")
        for c in (-1.0, 1.0)
    ]
    assert mean[0].score.value == pytest.approx(0.25 * 0.25)
    assert mean[1].score.value == pytest.approx(0.25 + 0.75 * 0.25)


class Lives(MemoryDataset):
    """Every state is an inspection; gearboxes whose number is a multiple of five were taken out."""

    def life(self, table: str, split: str | None = None) -> pa.Table:
        assert table == "inspections"
        rows = self.labels(split, ["record_id", "specimen_id", "state_id"]).to_pylist()
        lives = [None if row["specimen_id"] % 5 == 0 else 30.0 - 10.0 * row["state_id"] for row in rows]
        return pa.table({"record_id": [row["record_id"] for row in rows], "rul_h": lives})


def test_remaining_lives_are_judged_where_they_are_known(dataset: Any) -> None:
    lives = Lives(dataset.table, config={"life": {}})
    table = lives.life("inspections", "test")
    known = np.array([one is not None for one in table.column("rul_h").to_pylist()])
    record_id = table.column("record_id").to_numpy()[known]
    truth = np.array(table.column("rul_h").to_pylist(), dtype=np.float64)[known]
    mine = {"record_id": record_id, "rul_h": truth + 2.0}
    found = diagnostics.score(lives, mine)
    assert [(one.measure, one.records, one.score.value) for one in found.rows] == [
        ("mean absolute error [h]", "all", 2.0)
    ]
    assert found.records == known.sum() == 21
    assert found.rows[0].chance == pytest.approx(np.abs(truth - 20.0).mean())
    inside = diagnostics.score(lives, {**mine, "rul_q10_h": np.zeros(21), "rul_q90_h": np.full(21, 25.0)})
    share = row(inside, "share between the limits (0.8 is right)", "all")
    assert share.score.value == pytest.approx(np.mean(truth <= 25.0))
    with pytest.raises(UsageError, match="rul_q10_h is above rul_q90_h in 7 records"):
        diagnostics.score(lives, {**mine, "rul_q10_h": truth, "rul_q90_h": np.full(21, 25.0)})
    with pytest.raises(UsageError, match="remaining life takes rul_h"):
        diagnostics.score(lives, {"record_id": record_id})


def test_scores_come_as_a_frame_and_as_a_figure(dataset: Any, damage: dict[str, np.ndarray]) -> None:
    found = diagnostics.score(dataset, damage)
    assert len(found.plot().axes) == 3
    if find_spec("pandas") is None:
        with pytest.raises(UsageError, match="to_table has the same rows"):
            found.to_frame()
    else:
        assert list(found.to_frame()["score"]) == [one.score.value for one in found.rows]


def written(dataset: Any, folder: Path, identity: str = "0" * 64) -> np.ndarray:
    """Write a training's predictions of two classifiers; return the probabilities of the first."""
    truth = truth_of(dataset, "test")
    own = np.random.default_rng(2).dirichlet(np.ones(3), size=truth.label.size) + 0.6 * np.eye(3)[truth.label]
    own /= own.sum(axis=1, keepdims=True)
    guess = np.full_like(own, 1.0 / 3.0)
    entries = [
        predicted_rows(
            name, "test", truth.record_id, Predictions(CLASSES, truth.label, found, truth.specimen), np.zeros(3)
        )
        for name, found in (("boosting", own), ("rms", guess))
    ]
    write_predictions(entries, identity, folder)
    return own


def test_differences_are_paired_with_the_classifiers_of_a_training(dataset: Any, tmp_path: Path) -> None:
    models = tmp_path / "report" / "models"
    models.mkdir(parents=True)
    probability = written(dataset, models)
    mine = {f"p_{name}": probability[:, k] for k, name in enumerate(CLASSES)}
    mine["record_id"] = labels_of(dataset, "test")["record_id"]
    for folder in (models, tmp_path / "report"):
        found = diagnostics.score(dataset, mine, baselines=folder)
        own, same, guess = (row(found, "AUC", "every damage", name) for name in ("yours", "boosting", "rms"))
        assert own.difference is None
        assert (same.score, same.difference.value, same.difference.high) == (own.score, 0.0, 0.0)
        assert guess.score.value == 0.5
        assert guess.difference.value == pytest.approx(own.score.value - 0.5)
        assert guess.difference.low < guess.difference.value < guess.difference.high
    alone = diagnostics.score(dataset, models / "predictions.parquet")
    assert row(alone, "macro AUROC", "all", "boosting").score == row(found, "macro AUROC", "all").score
    assert "gradient boosting on indicators" in str(found)
    assert str(found).splitlines()[-1] == found.verdict
    assert "and not told from gradient boosting on indicators" in found.verdict
    assert found.to_table().num_rows == len(found.rows)


def test_predictions_of_another_set_are_refused(dataset: Any, damage: dict[str, np.ndarray], tmp_path: Path) -> None:
    written(dataset, tmp_path, "1" * 64)
    with pytest.raises(UsageError, match="predictions of the set 111111111111; this one is 000000000000"):
        diagnostics.score(dataset, damage, baselines=tmp_path)
    with pytest.raises(UsageError, match=r"has no predictions\.parquet"):
        diagnostics.score(dataset, damage, baselines=tmp_path / "nothing")
    with pytest.raises(UsageError, match="received the split 'holdout'; those with records are train"):
        diagnostics.score(dataset, damage, split="holdout")


def test_a_table_has_a_role_for_every_column(features: pa.Table) -> None:
    table = feature_matrix(features)
    assert set(LABEL_NAMES) <= set(table.labels)
    assert set(table.roles) == {*table.names, *table.labels}
    assert table.roles["rms__bearing_vertical"] == "measured"
    assert table.classes == CLASSES
    parts = [table.split(name) for name in ("train", "validation", "test")]
    assert sum(len(part.values) for part in parts) == len(table.values)
    assert not set(parts[0].groups) & set(parts[2].groups)


def test_importing_diagnostics_costs_nothing() -> None:
    heavy = ("numpy", "pyarrow", "scipy")
    code = f"import sys, diagnostics; print([m for m in {heavy} if m in sys.modules], diagnostics.score)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.startswith("[] <function score")
