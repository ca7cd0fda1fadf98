"""The evaluation of indicators: tables and blocks of a page, complete, and telling what their numbers rest on."""

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

from diagnostics.indicators.ranking_table import IndicatorTable, ranking_table
from diagnostics.indicators.registry import taken_of
from diagnostics.indicators.table import RecordTable, record_table
from diagnostics.page.style import png_bytes
from diagnostics.records.channel_quantities import RECORDED, channel_quantities
from diagnostics.report.indicator_evaluation import evaluated, write_evaluation
from diagnostics.report.indicator_sections import detail_blocks, evaluation_notes, figures, kind_notes, ranking_blocks
from diagnostics.statistics.assessment import AssessmentSettings
from diagnostics.statistics.detectable_size import noise_curve

SETTINGS = AssessmentSettings(resamples=60)


def blocks(dataset: Any, table: IndicatorTable) -> str:
    found = evaluated(table, SETTINGS)
    drawn = figures(found, channel_quantities(dataset))
    pictures = {name: (png_bytes(figure), text) for name, (figure, text) in drawn.items()}
    notes = evaluation_notes(dataset, found)
    return "".join([*ranking_blocks(dataset, found), *detail_blocks(found, pictures), *notes])


@pytest.fixture(scope="module")
def folder(dataset: Any, measured: RecordTable, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("indicators")
    table = ranking_table(measured, dataset)
    rng = np.random.default_rng(1)
    table.matrix.labels["snr_bearing_vertical_db"] = rng.uniform(0, 30, len(table.notes))
    table.matrix.values[0, table.matrix.names.index("phase_modulation_gear_h1__bearing_vertical")] = np.nan
    write_evaluation(dataset, evaluated(table, SETTINGS), folder, values=True)
    (folder / "blocks.html").write_text(blocks(dataset, table), encoding="utf-8")
    return folder


def test_blocks_load_nothing_from_elsewhere_and_name_every_indicator(folder: Path) -> None:
    page = (folder / "blocks.html").read_text(encoding="utf-8")
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    for text in ("Ranking", "undefined", "other specimens", "Revolutions averaged"):
        assert text in page
    for definition in taken_of(RECORDED.word):
        assert definition.name.replace("_", "_<wbr>") in page
    assert page.count("<img") == 3
    separation = page.split("Separation of each state")[-1].split("</table>")[0]
    assert 0 < separation.count('class="shade') <= 36 * 4  # the heat map: two states in two designs
    history = re.findall(r"<tr>.*?</tr>", separation)
    single = [row for row in history if not re.search(r'href="#term-n[ab]4', row)]
    assert separation.count('href="#indicator=') == sum(row.count('class="shade') for row in single) > 100


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
    page = (folder / "blocks.html").read_text(encoding="utf-8")
    assert "NA4, NA4* and NB4" in page
    assert 'href="#indicator=na4' not in page  # of several records: none has it


def test_set_of_healthy_records_and_of_one_specimen_still_give_blocks(make_dataset: Any) -> None:
    import pyarrow.compute as pc

    healthy = make_dataset(("test", "test"))
    healthy.table = healthy.table.filter(pc.equal(healthy.table.column("state"), "healthy"))
    single = make_dataset(("test",))
    for dataset in (healthy, single):
        assert "Ranking" in blocks(dataset, ranking_table(record_table(dataset), dataset))


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


def test_notes_carry_the_one_on_kinds(make_dataset: Any) -> None:
    dataset = make_dataset(("train", "test"))
    state = dataset.table.column("state").to_pylist()
    mixed = with_labels(dataset, through_face=[name == "severe" for name in state])
    table = ranking_table(record_table(mixed), mixed)
    assert "pitting through the face: severe" in blocks(mixed, table)
