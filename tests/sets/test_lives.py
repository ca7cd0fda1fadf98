"""Sets of gearboxes that run to failure: as files and commands show them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import siggen
from diagnostics.records.record_classes import set_classes
from siggen.checks.loading import load_config
from siggen.cli.app import app
from siggen.errors import ConfigError, UsageError
from siggen.gearbox.description import class_words
from siggen.gearbox.plan import plan
from tests.config.minimal import by_name, minimal

LIFE: dict[str, Any] = {"reference_torque_nm": 60.0, "scale": 0.03, "interval_h": 1.2, "most": 6, "removed_share": 0.0}
"""Gearboxes of 30 Hz pit after 2 to 3 h and fail after 4 to 5."""


def lives(life: dict[str, Any] | None = None, **changes: Any) -> dict[str, Any]:
    """Return a small set of short records."""
    return minimal(states={}, life={**LIFE, **(life or {})}, specimens=2, duration_s=0.05, fs_hz=20_000.0, **changes)


def run(*arguments: str) -> str:
    """Return what a command says."""
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    return result.output


def rows(path: Path) -> list[dict[str, Any]]:
    """Return everything of the records of a set, by record."""
    found = [row for batch in siggen.open(path).records() for row in batch.to_pylist()]
    return sorted(found, key=lambda row: row["record_id"])


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("fleet")
    siggen.generate(load_config(lives()), path / "set", workers=0)
    return path / "set"


def test_a_record_of_a_life_is_the_static_record_of_its_damage(fleet: Path, tmp_path: Path) -> None:
    (tmp_path / "lives.yaml").write_text(yaml.safe_dump(lives(), sort_keys=False))
    run("inspect", "life", str(tmp_path / "lives.yaml"), "--out", str(tmp_path / "states.yaml"))
    siggen.generate(load_config(tmp_path / "states.yaml", ["specimens=1"]), tmp_path / "set", workers=0)
    own = [{**row, "record_id": 0} for row in rows(fleet) if row["specimen_id"] == 0]
    static = [{**row, "record_id": 0} for row in rows(tmp_path / "set")]
    assert own == static
    other = ["--gearbox", "1", "--out", str(tmp_path / "other.yaml")]
    run("inspect", "life", str(tmp_path / "lives.yaml"), *other)
    states = yaml.safe_load((tmp_path / "other.yaml").read_text())["states"]
    assert len(states) == sum(row["specimen_id"] == 1 for row in rows(fleet))
    assert any(row["damaged_area_share"] > 0.04 for row in own)


def test_ids_have_a_fixed_stride_and_tables_tell_the_same_truth_as_labels(fleet: Path) -> None:
    dataset = siggen.open(fleet)
    labels = {row["record_id"]: row for row in dataset.labels().to_pylist()}
    inspections = dataset.life("inspections").to_pylist()
    assert sorted(labels) == sorted(row["record_id"] for row in inspections)
    assert {row["record_id"] - 6 * row["specimen_id"] - row["inspection"] for row in inspections} == {0}
    worst: dict[int, float] = {}
    for row in dataset.life("teeth").to_pylist():
        worst[row["record_id"]] = max(worst.get(row["record_id"], 0.0), row["area_share"])
    for record_id, label in labels.items():
        # edges are straight in arc there and in height here
        assert label["damaged_area_share"] == pytest.approx(worst.get(record_id, 0.0), rel=0.03)
    units = {row["specimen_id"]: row for row in dataset.life("units").to_pylist()}
    for row in inspections:
        assert row["age_h"] + row["rul_h"] == pytest.approx(units[row["specimen_id"]]["failure_h"], rel=1e-12)
        assert (
            labels[row["record_id"]]["severity"]
            == {"no pit": "healthy", "pitted": "slight", "rated": "severe"}[row["phase"]]
        )


@pytest.mark.slow
def test_more_gearboxes_leave_those_that_exist_as_they_are(fleet: Path, tmp_path: Path) -> None:
    siggen.generate(load_config({**lives(), "specimens": 1}), tmp_path / "grown", workers=0)
    siggen.generate(load_config(lives()), tmp_path / "grown", workers=0)
    assert rows(tmp_path / "grown") == rows(fleet)
    for table in ("units", "inspections", "teeth", "pits", "outlook", "debris", "pictures"):
        first, second = (siggen.open(folder).life(table).to_pylist() for folder in (tmp_path / "grown", fleet))
        assert sorted(map(str, first)) == sorted(map(str, second))
    assert "as its manifest promises" in run("verify", str(tmp_path / "grown"), "--sample", "1")


def test_another_schedule_changes_no_truth() -> None:
    often = load_config(lives({"interval_h": 0.3, "most": 30})).life(1)
    seldom = load_config(lives()).life(1)
    assert often.course.ends == seldom.course.ends
    for age_h in (1.0, 3.0, 4.0, 5.0):
        time = often.clock.time(age_h)
        assert often.course.teeth(time) == seldom.course.teeth(seldom.clock.time(age_h))


def test_before_the_first_pit_records_are_those_of_a_healthy_gearbox(tmp_path: Path) -> None:
    names = [{"name": f"inspection_{number:03d}"} for number in range(3)]
    young = {"interval_h": 1e-3, "most": 3}
    siggen.generate(load_config(lives(young)), tmp_path / "young", workers=0)
    siggen.generate(load_config({**lives(), "life": None, "states": by_name(names)}), tmp_path / "healthy", workers=0)
    first, second = (rows(tmp_path / name) for name in ("young", "healthy"))
    columns = set(first[0]) & set(second[0])
    assert [{c: row[c] for c in columns} for row in first] == [{c: row[c] for c in columns} for row in second]


def test_taken_out_gearboxes_have_no_remaining_life_but_a_least_one() -> None:
    from siggen.sets.drawn import life_rows

    config = load_config({**lives({"removed_share": 1.0}), "specimens": 14})
    units = [life_rows(config, number) for number in range(14)]
    taken = [one for one in units if one["units"][0]["event"] == "suspended"]
    assert 2 < len(taken) < 13
    for one in taken:
        assert all(row["rul_h"] is None and row["rul_at_least_h"] >= 0.0 for row in one["inspections"])
        assert one["units"][0]["observed_h"] < one["units"][0]["failure_h"]


@pytest.mark.parametrize("gear", ["pinion", "gear"])
def test_pits_begin_where_flanks_slide_against_their_rolling(gear: str) -> None:
    from siggen.sets.drawn import life_rows

    config = load_config({**lives(), "specimens": 6})
    pair = config.gearbox(0).pair
    rows = [row for number in range(6) for row in life_rows(config, number)["pits"] if row["gear"] == gear]
    # Below the pitch point, whose arc from the base circle is R_b tan²(α)/2; from the lowest contact on.
    pitch_mm = 1e3 * 0.5 * pair.member(gear).base_radius_m * np.tan(pair.working_pressure_angle_rad) ** 2
    heights = np.array([row["height_mm"] for row in rows])
    assert 0.9 * pitch_mm < heights.max() < pitch_mm
    face = np.array([row["face_mm"] for row in rows])
    assert np.all((face > 0.0) & (face < 1e3 * pair.face_width_m))


def test_a_record_after_the_end_is_refused_with_those_that_there_are(tmp_path: Path) -> None:
    (tmp_path / "lives.yaml").write_text(yaml.safe_dump(lives(), sort_keys=False))
    count = len(load_config(lives()).life(0).ages_h)
    assert count < 6
    result = CliRunner().invoke(
        app, ["show", str(tmp_path / "lives.yaml"), "--record", "5", "--out", str(tmp_path / "r.csv")]
    )
    assert result.exit_code != 0
    assert f"allowed: 0 to {count - 1}" in str(result.exception)


@pytest.mark.parametrize(
    ("changes", "path", "said"),
    [
        ({"states": {"healthy": {}}}, "states", "states beside a section life"),
        ({"operating_points": [{"speed_hz": 30.0, "torque_nm": -60.0}]}, "operating_points.0.torque_nm", "-60"),
        ({"life": {**LIFE, "history": [[5.0, -1.0]]}}, "life.history.0", "torque from 0 to 100 over"),
        ({"life": {**LIFE, "history": [[5.0, 0.0]]}}, "life.history", "no block with torque and speed above 0"),
        ({"life": None}, "states", "an empty mapping"),
    ],
)
def test_lives_that_cannot_be_are_refused(changes: dict[str, Any], path: str, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        load_config({**lives(), **changes})
    assert [problem.path for problem in error.value.problems] == [path]
    assert said in str(error.value)


def test_neither_states_nor_a_life_is_refused_with_both_ways_on() -> None:
    with pytest.raises(ConfigError, match=r"states: received an empty mapping; .* or a section life in its place"):
        load_config({**lives(), "life": None})


def test_a_file_of_states_is_never_overwritten(tmp_path: Path) -> None:
    (tmp_path / "lives.yaml").write_text(yaml.safe_dump(lives(), sort_keys=False))
    command = ["inspect", "life", str(tmp_path / "lives.yaml"), "--out", str(tmp_path / "states.yaml")]
    assert "wrote" in run(*command)
    with pytest.raises(UsageError, match="is there already"):
        CliRunner().invoke(app, command, catch_exceptions=False)


@pytest.mark.parametrize(
    ("life", "said"),
    [
        ({"interval_h": 0.01}, "no gearbox of 2 has a pit before its last inspection"),
        ({"interval_h": 0.5}, "no gearbox of 2 fails before its last inspection"),
    ],
)
def test_plan_tells_a_schedule_that_sees_no_end(tmp_path: Path, life: dict[str, Any], said: str) -> None:
    (tmp_path / "lives.yaml").write_text(yaml.safe_dump(lives(life), sort_keys=False))
    assert said in " ".join(run("plan", str(tmp_path / "lives.yaml"), "--trial", "0").split())


def test_plan_tells_cpu_hours_in_proportion_to_records(tmp_path: Path) -> None:
    (tmp_path / "lives.yaml").write_text(yaml.safe_dump(lives({"history": [[0.5, 1.0], [0.5, 0.0]]}), sort_keys=False))
    found = json.loads(CliRunner().invoke(app, ["plan", str(tmp_path / "lives.yaml"), "--json"]).stdout)
    cost, pitted = found["cost"], round(found["records"] * found["life"]["pitted_inspections"])
    of_records = found["records"] * (cost["record_s"] + found["duration_s"] * cost["signal_s"])
    whole_s = 2 * cost["gearbox_s"] + of_records + pitted * cost["damage_s"]
    assert cost["cpu_hours"] == pytest.approx(whole_s / 3600.0, rel=1e-12)
    assert 0 < pitted < found["records"]
    assert cost["gearbox_s"] > 0.0
    assert (found["life"]["history_h"], found["life"]["schedule_h"]) == (1.0, 6.0)


def test_plan_counts_the_records_that_there_will_be(fleet: Path) -> None:
    assert len(plan(load_config(lives()))) == len(siggen.open(fleet).labels())


def test_a_card_of_lives_tells_damage_and_counts_inspections_in_one_column(fleet: Path) -> None:
    card = " ".join(siggen.open(fleet).card().split())
    assert "| split | specimens | records | inspections | MB |" in card
    assert "runs until a tooth fails" in card
    assert "synthetic gearbox vibration, pitting" in card
    assert "every state is healthy" not in card


def test_published_classes_of_lives_hold_every_word_of_their_labels(fleet: Path) -> None:
    labels = siggen.open(fleet).labels()
    for column, words in class_words(load_config(lives())).items():
        assert set(labels.column(column).to_pylist()) <= set(words)


def test_classifiers_refuse_lives_and_name_what_shows_them(fleet: Path) -> None:
    for kind in ("state", "fault"):
        with pytest.raises(UsageError, match=r"has no classes: .* folder life/; siggen-diagnostics report"):
            set_classes(siggen.open(fleet), kind)
