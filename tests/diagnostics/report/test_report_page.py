"""The report of a small set: one self-contained page that says first what its scores mean."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from html import unescape
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from urllib.parse import parse_qs

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv
import pytest

from diagnostics.audit.audit import ALONE
from diagnostics.indicators.registry import columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import RecordTable
from diagnostics.judging import of_split
from diagnostics.judging.of_split import NetworkOptions, Training
from diagnostics.page.provenance import without_path
from diagnostics.records.usable_records import with_channels
from diagnostics.report import report
from diagnostics.report.audit_words import audit_beside, audit_sentence
from diagnostics.report.report import PageOptions, write_report
from diagnostics.signal.spectrum import OrderSpectrum, strongest_harmonic
from diagnostics.training import cnn
from diagnostics.training.realism import meaning_of_scores
from siggen.errors import DatasetError, UsageError
from tests.diagnostics.conftest import CHANNELS


@pytest.fixture(scope="module")
def folder(dataset: Any, measured: RecordTable, training: Training, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the set, whose table and training are those that other files share."""
    out = tmp_path_factory.mktemp("report")
    labels = dataset.labels("test", ["record_id", "damaged_area_mm2"])
    mine = labels.rename_columns(["record_id", "damage"])
    pyarrow.csv.write_csv(mine, out / "mine.csv")
    page = PageOptions(out / "mine.csv", limit=12)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(report, "measured_table", lambda *_, **__: measured)
        patch.setattr(report, "train_models", lambda *_, **__: training)
        write_report(dataset, out, seed=0, network=NetworkOptions(cnn=False), page=page)
    return out


def test_the_users_predictions_have_a_row_beside_the_classifiers(dataset: Any, folder: Path, tmp_path: Path) -> None:
    rows = json.loads((folder / "metrics.json").read_text())["yours"]
    of_damage = {row["name"]: row for row in rows if row["records"] == "every damage"}
    assert set(of_damage) == {"yours", "rms", "indicators", "boosting"}
    assert of_damage["yours"]["score"] == 1.0
    assert of_damage["rms"]["difference"] == pytest.approx(1.0 - of_damage["rms"]["score"])
    section = (folder / "report.html").read_text().split('id="your-predictions"')[1].split("<h2")[0]
    assert "<td>yours</td>" in section
    (tmp_path / "wrong.csv").write_text("record_id,damage\n0,1\n")
    with pytest.raises(UsageError, match="records missing"):
        write_report(dataset, tmp_path / "out", seed=0, page=PageOptions(tmp_path / "wrong.csv"))


def test_the_answer_stands_first_and_says_that_error_free_gears_separate_trivially(folder: Path) -> None:
    text = (folder / "report.html").read_text()
    opening = re.search(
        r'</h1>\s*<p>[^<]*all simulated[^<]*</p>\s*<section class="answer".*?</section>', text, re.DOTALL
    )
    assert opening is not None
    first = re.sub(r"<[^>]*>", "", opening.group())
    assert "Pitting from 1\xa0mm² on (slight; none of this kind is smaller) is found in nine of ten records." in first
    headline = json.loads((folder / "metrics.json").read_text())["headline"]
    assert headline in first
    assert "lifts" not in first
    assert "24\xa0gearboxes was judged by a model that had learnt from others alone." in first
    assert "5\xa0% give a false alarm. All damage together: AUC 1.00" in first
    detectors = text.split('id="which-damage-is-found"')[1].split("<h2")[0]
    said = [re.sub(r"<[^>]*>", "", part) for part in re.findall(r"<p>(<b>.*?)</p>", detectors)]
    questions = ["From which size", "By what", "With a healthy record of the same gearbox", "How sure"]
    assert [part.split(".")[0] for part in said] == questions
    assert "Pitting is found in nine of ten records from 1\xa0mm² on, the smallest of the set" in said[0]
    assert "no manufacturing errors, so any damage above the noise is trivial to separate" in said[3]
    assert "says nothing about a real machine" in said[3]
    limits = text.split('id="what-limits-the-answer"')[1].split("<h2")[0]
    assert "They do not show that such damage could be found on a real machine" in limits
    assert "The audit was not run" in limits


def test_an_audit_of_another_set_is_none_of_this_one(dataset: Any, tmp_path: Path) -> None:
    beside = replace(dataset, path=tmp_path / "set")
    (tmp_path / "set_audit").mkdir()
    audit = tmp_path / "set_audit" / "audit.json"
    audit.write_text(json.dumps({"identity": "another", "verdict": "No leak was found."}))
    assert audit_beside(beside) is None
    audit.write_text(json.dumps({"identity": dataset.manifest["identity"], "verdict": "No leak was found."}))
    assert audit_sentence(beside, audit_beside(beside)) == "No leak was found."
    reached = {ALONE: {"states": [{"state": "severe", "auc": {"value": 1.0}}]}}
    few = {"verdict": "Too few.", "too_few_gearboxes": True, "strongest": reached}
    assert audit_sentence(beside, few) == "Too few."
    assert "severe 1.00" in audit_sentence(beside, {**few, "too_few_gearboxes": False})


def test_meaning_changes_once_gears_have_errors() -> None:
    assert "no manufacturing errors" in meaning_of_scores({})
    assert "no manufacturing errors" not in meaning_of_scores({"manufacture": {"accuracy_class": 6}})


def test_page_loads_nothing_from_elsewhere(folder: Path) -> None:
    text = (folder / "report.html").read_text()
    document = re.sub(r"(?s)<script\b.*?</script>", "", text)
    assert set(re.findall(r'(?:src|href)=(".{5}|[^"])', re.sub(r'href="#[^"]*"', "", document))) == {'"data:'}
    assert "://" not in re.sub(r"base64,[A-Za-z0-9+/=]+", "", document)
    assert 'name="viewport"' in text


def test_every_row_of_a_table_has_a_cell_below_each_head(folder: Path) -> None:
    tables = re.findall(r"<table class.*?</table>", (folder / "report.html").read_text(), re.DOTALL)
    assert len(tables) > 10
    for table in tables:
        heads, body = table.count('scope="col"'), table.split("<tbody>")[1]
        assert {row.count("</td>") + row.count("</th>") for row in body.split("</tr>")[:-1]} == {heads}, table[:200]


def test_every_link_leads_to_a_place_on_the_page(folder: Path) -> None:
    text = re.sub(r"(?s)<script>.*?</script>", "", (folder / "report.html").read_text())
    places = re.findall(r' id="([^"]*)"', text)
    targets = {target for target in re.findall(r'href="#([^"]*)"', text) if "=" not in target}
    assert len(places) == len(set(places))
    assert {"scores", "term-fm4"} <= targets <= set(places)


def test_figures_and_tables_lead_to_the_records_behind_them(dataset: Any, folder: Path) -> None:
    text = unescape((folder / "report.html").read_text())
    labels = dataset.labels()
    asked = [parse_qs(found) for found in re.findall(r'href="#([^"]*=[^"]*)"', text)]
    records, states = set(labels.column("record_id").to_pylist()), set(labels.column("state").to_pylist())
    assert {int(one["record"][0]) for one in asked if "record" in one} <= records
    assert {one["state"][0] for one in asked if "state" in one} == states
    known = set(feature_columns(folder))
    shown = {one["indicator"][0] for one in asked if "indicator" in one}
    assert {name for name in shown if "__" in name} <= known
    assert len(shown) >= 100  # the table of the best indicators
    first, *figures = re.findall(r"<figcaption.*?</figcaption>", text, re.DOTALL)
    assert "#state=severe" in first
    assert sum('href="#' in one for one in figures) >= len(figures) - 2  # all but permuted labels and all detectors


def feature_columns(folder: Path) -> list[str]:
    return [entry["feature"] for entry in json.loads((folder / "metrics.json").read_text())["separability"]["features"]]


def test_an_indicator_has_a_human_name_and_its_definition_on_hover(folder: Path) -> None:
    text = (folder / "report.html").read_text().replace("<wbr>", "")
    table = next(part for part in text.split("<table")[1:] if ">Indicator, channel<" in part)
    assert '<a href="#term-fm4">FM4, pinion</a> <small>bearing_vertical; fm4_pinion</small>' in table
    assert 'id="term-rms" data-hint="sqrt(mean x²); from record"' in text  # a script gives it to links


def test_figures_tables_models_and_metrics_lie_beside_it(dataset: Any, folder: Path) -> None:
    written = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    figures = (
        "first",
        "scores",
        "permuted",
        "stiffness_loss",
    )
    assert {f"figures/{name}.png" for name in figures} <= written
    assert {"features.parquet", "evaluation.csv", "evaluation.parquet", "models/model_card.md"} <= written
    metrics = json.loads((folder / "metrics.json").read_text())
    assert metrics["training"]["specimens"] == {"train": 12, "validation": 4, "test": 8}
    assert len(metrics["training"]["classifiers"]["indicators"]["permuted_macro_auroc"]) == 20
    validated = {name: found["validation_macro_auroc"] for name, found in metrics["training"]["classifiers"].items()}
    assert validated["rms"] < min(validated["indicators"], validated["boosting"]) <= 1.0
    channels = len(dataset.channels)
    assert len(metrics["separability"]["features"]) == channels * len(columns(IndicatorSettings()))


def test_page_card_and_metrics_tell_calibration_without_and_with_temperature(folder: Path) -> None:
    found = json.loads((folder / "metrics.json").read_text())["training"]["classifiers"]["rms"]
    names = ("brier_score", "expected_calibration_error")
    values = [found[f"{name}{end}"]["value"] for name in names for end in ("_uncalibrated", "")]
    texts = [f"{value:.2f}" for value in (found["temperature"], *values, found["expected_calibration_error_if_true"])]
    card = (folder / "models" / "model_card.md").read_text()
    row = next(line for line in card.splitlines() if line.startswith("| rms |") and line.count("|") == 8)
    assert [cell.split()[0] for cell in row.strip("| ").split(" | ")[1:]] == texts
    page = (folder / "report.html").read_text().replace("<wbr>", "")
    (table,) = (text for text in page.split("<table")[1:] if "Calibration error if true" in text)
    assert re.findall(r"<td[^>]*>([\d.]+)", table.split("RMS alone")[1])[: len(texts)] == texts


def test_a_page_names_what_to_cite_and_no_place_on_the_machine_that_made_it(folder: Path, dataset: Any) -> None:
    text = (folder / "report.html").read_text().replace("<wbr>", "")
    assert "with seed 0 from the set memory_set, identity 000000" in text
    assert "72\xa0records of 1\xa0s in 2\xa0channels" in text
    assert str(folder) not in text
    error = DatasetError(f"{Path('/data/sets/memory_set')}: 3 records")
    assert without_path(error, SimpleNamespace(path=Path("/data/sets/memory_set"))) == "memory_set: 3 records"


@pytest.mark.slow  # trains everything twice
def test_one_process_and_several_give_the_same_page(make_dataset: Callable[..., Any], tmp_path: Path) -> None:
    small = make_dataset(("train",) * 3 + ("validation",) + ("test",) * 2)
    pages = [
        write_report(small, tmp_path / str(k), 0, network=NetworkOptions(cnn=False), page=PageOptions(workers=k))
        for k in (1, 2)
    ]
    assert pages[0].read_bytes() == pages[1].read_bytes()


@pytest.mark.slow  # trains everything once more, a network too
def test_seven_revolutions_and_no_validation_specimens_still_train_every_classifier(
    make_dataset: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cnn, "NetworkSettings", partial(cnn.NetworkSettings, most_epochs=4))
    monkeypatch.setattr(of_split, "PERMUTED_EPOCHS", 2)
    short = with_channels(make_dataset(("train",) * 3 + ("test",) * 2, duration_s=0.25), CHANNELS[:1])
    earlier = tmp_path / "figures" / "confusion_network.png"
    earlier.parent.mkdir()
    earlier.write_bytes(b"of an earlier run")
    write_report(short, tmp_path, seed=0)
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    assert set(metrics["training"]["classifiers"]) == {"indicators", "boosting", "rms", "network"}
    assert "no validation specimens: trained for 4 epochs without stopping" in metrics["notes"]
    assert any("gear sidebands not resolved by 2 gear revolutions" in note for note in metrics["notes"])
    assert any("no validation specimens" in note for note in metrics["notes"])
    assert not earlier.exists()


def test_strongest_mesh_harmonic_is_found() -> None:
    order = np.arange(18 * 64 * 10) / 10
    amplitude = np.full(order.size, 0.1)
    amplitude[[18 * 10, 5 * 18 * 10, 7 * 10]] = [1.0, 2.0, 9.0]  # the strongest line of all is no mesh line
    assert strongest_harmonic(OrderSpectrum(order, amplitude, 10), 18) == 5


def test_a_set_without_test_specimens_still_gets_its_report(dataset: Any, tmp_path: Path) -> None:
    only_training = dataset.table.filter(pc.equal(dataset.table.column("split"), "train"))
    small = type(dataset)(pa.table(only_training).slice(0, 9))
    write_report(with_channels(small, CHANNELS[:1]), tmp_path, seed=0)
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    assert metrics["training"] is None
    assert any("No classifier: split 'test' has no specimens" in note for note in metrics["notes"])
    assert "No classifier was trained" in (tmp_path / "report.html").read_text()
