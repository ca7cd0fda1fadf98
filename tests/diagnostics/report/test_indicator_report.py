"""The page of the evaluation of indicators: complete, self-contained, and telling what its numbers rest on."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from diagnostics.indicators.ranking_table import ranking_table
from diagnostics.indicators.registry import taken_of
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.report.indicator_report import kind_notes, write_indicator_report
from diagnostics.statistics.assessment import AssessmentSettings
from diagnostics.statistics.detectable_size import noise_curve

SETTINGS = AssessmentSettings(resamples=60)


@pytest.fixture(scope="module")
def folder(dataset: Any, measured: RecordTable, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("indicators")
    table = ranking_table(measured, dataset)
    rng = np.random.default_rng(1)
    table.matrix.labels["snr_bearing_vertical_db"] = rng.uniform(0, 30, len(table.notes))
    table.matrix.values[0, table.matrix.names.index("phase_modulation_gear_h1__bearing_vertical")] = np.nan
    write_indicator_report(dataset, table, folder, SETTINGS, explorer="explorer.html")
    return folder


def test_page_loads_nothing_from_elsewhere_and_names_every_indicator(folder: Path) -> None:
    page = (folder / "indicators.html").read_text(encoding="utf-8")
    assert not re.search(r'(src|href)="(?!data:|#|explorer\.html#)', page)
    for text in ("Ranking", "Definitions", "Undefined values", "other specimens", "manufacturing errors"):
        assert text in page
    for definition in taken_of(RECORDED.word):
        assert definition.name.replace("_", "_<wbr>") in page
    assert page.count("<img") == len(list((folder / "figures").glob("*.png"))) == 3
    separation = page.split("Separation of each state")[-1].split("</table>")[0]
    assert 0 < separation.count('class="shade') <= 36 * 4  # the heat map: two states in two designs
    assert separation.count('href="explorer.html#state=') == separation.count('class="shade')


def test_numbers_are_those_of_the_tables(folder: Path) -> None:
    numbers = json.loads((folder / "indicators.json").read_text(encoding="utf-8"))
    table = pq.read_table(folder / "evaluation.parquet")
    assert [r["indicator"] for r in numbers["results"]] == table.column("indicator").to_pylist()
    first = numbers["results"][0]
    assert first["score_other_specimens"]["value"] == table.column("score_other_specimens")[0].as_py()
    assert set(first["other_specimens"]) == {"slight", "severe"} == set(numbers["states"])
    assert numbers["indicator_settings"]["samples_per_tooth"] == 128
    assert pq.read_table(folder / "indicators.parquet").num_rows == numbers["records"] == 72


def test_summary_says_what_is_best_and_what_survives(folder: Path) -> None:
    text = " ".join(json.loads((folder / "indicators.json").read_text(encoding="utf-8"))["summary"])
    for part in ("separates best", "After Holm's correction at 0.05", "smallest damaged area"):
        assert part in text
    assert "NA4, NA4* and NB4" in (folder / "indicators.html").read_text(encoding="utf-8")


def test_set_of_healthy_records_and_of_one_specimen_still_give_a_page(make_dataset: Any, tmp_path: Path) -> None:
    import pyarrow.compute as pc

    healthy = make_dataset(("test", "test"))
    healthy.table = healthy.table.filter(pc.equal(healthy.table.column("state"), "healthy"))
    single = make_dataset(("test",))
    for name, dataset in (("healthy", healthy), ("single", single)):
        page = write_indicator_report(dataset, ranking_table(record_table(dataset), dataset), tmp_path / name, SETTINGS)
        assert "Definitions" in page.read_text(encoding="utf-8")


def test_noise_curve_falls_where_noise_covers_the_effect() -> None:
    rng = np.random.default_rng(2)
    snr = rng.uniform(-20, 20, 800)
    positive = np.arange(800) % 2 == 1
    values = positive + rng.standard_normal(800) * 10 ** (-snr / 20)
    curve = noise_curve(values, positive, snr, np.arange(800) // 20, np.ones((2, 800)))
    areas = [found.value for found in curve.auc]
    assert areas[3] > areas[2] > max(areas[:2])
    assert areas[0] < 0.72  # a shift of 0.1 to 0.3 deviations at -20 to -10 dB: Phi(0.2 / sqrt 2) = 0.56, 4 x 0.04
    assert areas[-1] > 0.99
    assert list(curve.snr_db) == pytest.approx([-15, -5, 5, 15], abs=2.5)


def with_labels(dataset: Any, **columns: list[Any]) -> Any:
    table = dataset.table
    for name, values in columns.items():
        table = table.drop_columns([name]) if name in table.column_names else table
        table = table.append_column(name, pa.array(values))
    return replace(dataset, table=table)


def test_states_of_several_kinds_are_noted_with_their_kinds(dataset: Any) -> None:
    state = dataset.table.column("state").to_pylist()
    assert kind_notes(dataset, ("slight", "severe")) == []
    faults = {"healthy": "healthy", "slight": "pitting", "severe": "spalling"}
    (note,) = kind_notes(with_labels(dataset, fault=[faults[name] for name in state]), ("slight", "severe"))
    assert "2 kinds (pitting: slight; spalling: severe)" in note
    assert "--state" in note
    (note,) = kind_notes(with_labels(dataset, through_face=[name == "severe" for name in state]), ("slight", "severe"))
    assert "pitting: slight; pitting through the face: severe" in note


def test_page_carries_the_note_on_kinds(make_dataset: Any, tmp_path: Path) -> None:
    dataset = make_dataset(("train", "test"))
    state = dataset.table.column("state").to_pylist()
    mixed = with_labels(dataset, through_face=[name == "severe" for name in state])
    table = ranking_table(record_table(mixed), mixed)
    write_indicator_report(mixed, table, tmp_path, SETTINGS)
    assert "pitting through the face: severe" in (tmp_path / "indicators.html").read_text(encoding="utf-8")
