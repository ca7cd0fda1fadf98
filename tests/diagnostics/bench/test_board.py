"""Baselines of a benchmark and its leaderboard, on short records of perfect gears, by command."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import diagnostics
from diagnostics.bench.leaderboard import (
    BESIDE,
    BOARD,
    CHANCE,
    KURTOGRAM,
    NETWORK,
    NUMBERS,
    STACK,
    benchmark_records,
    best_by_chance,
    entries,
    seen_records,
)
from diagnostics.bench.question import parts_of
from diagnostics.scoring.benchmark import open_benchmark
from siggen.errors import DatasetError
from tests.diagnostics.bench.conftest import Made


@pytest.fixture(scope="module")
def learned(made: Made, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the benchmark with its baselines; for time without a network, with fewer folds and convolutions."""
    bench = Path(shutil.copytree(made.benchmark.path, tmp_path_factory.mktemp("learned") / "bench"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("diagnostics.bench.leaderboard.missing_packages", lambda *_: ("torch",))
        patch.setattr("diagnostics.bench.leaderboard.FOLDS", 2)
        patch.setattr("diagnostics.audit.signal_detectors.DILATIONS", (1, 8))
        diagnostics.benchmark_baselines(bench)
    return bench


def test_every_baseline_says_something_of_every_test_record(made: Made, learned: Path) -> None:
    table = pq.read_table(learned / "baselines" / "predictions.parquet")
    asked = {
        side: [
            record
            for part in parts_of(made.benchmark.parts, referenced=side)
            for record in made.benchmark.part(part).labels("test", ["record_id"]).column("record_id").to_pylist()
        ]
        for side in (False, True)
    }
    names = set(table.column("classifier").to_pylist())
    assert {CHANCE, KURTOGRAM, STACK, KURTOGRAM + BESIDE, STACK + BESIDE} <= names
    rows = table.to_pylist()
    for name in names:
        own = [row for row in rows if row["classifier"] == name]
        assert sorted(row["record_id"] for row in own) == sorted(asked[name.endswith(BESIDE)])
        assert {row["reference"] for row in own} == {name.endswith(BESIDE)}
        assert np.isfinite([row["damage"] for row in own]).all()
    assert not [*learned.rglob("*_table")]  # the folder is published
    assert (learned.with_name("bench_table") / "test" / "same").is_dir()


def test_the_board_orders_entries_and_pairs_their_differences(made: Made, learned: Path, tmp_path: Path) -> None:
    told = json.loads(made.sealed.read_text())["parts"]
    truth = {
        record: area
        for part in told.values()
        for record, area in zip(part["labels"]["record_id"], part["labels"]["damaged_area_mm2"], strict=True)
    }
    asked = sorted(set(pq.read_table(learned / "baselines" / "predictions.parquet").column("record_id").to_pylist()))
    entries = tmp_path / "entries"
    entries.mkdir()
    perfect = pa.table({"record_id": asked, "damage": [truth[record] for record in asked]})
    pq.write_table(perfect, entries / "knows <b>all.parquet")
    folder = diagnostics.leaderboard(learned, entries, labels=made.sealed).parent
    page = (folder / BOARD).read_text()
    assert "knows &lt;b&gt;all" in page
    assert made.benchmark.digest in page
    numbers = json.loads((folder / NUMBERS).read_text())
    rows = {row["name"]: row for row in numbers["entries"]}
    for track in numbers["counted"].values():
        assert 0.5 < track["best_by_chance"] < 0.9
    assert sum(track["entries"] for track in numbers["counted"].values()) == len(rows)
    first = rows["knows <b>all"]
    assert next(iter(rows)) == "knows <b>all"
    assert first["auc"]["mean"]["value"] == 1.0
    for row in rows.values():
        if not row["beside_a_healthy_record"]:
            difference = row["auc"]["same_alone"]["value"] - first["auc"]["same_alone"]["value"]
            assert row["minus_first"]["same_alone"]["value"] == pytest.approx(difference)
    chance = rows[CHANCE]["auc"]["same_alone"]
    assert chance["low"] < 0.5 < chance["high"]
    assert rows[CHANCE]["minus_first"]["same_alone"]["high"] < 0.0


def test_a_board_counts_entries_whose_files_are_gone_and_refuses_a_log_that_was_changed(
    made: Made, learned: Path, tmp_path: Path
) -> None:
    table = pq.read_table(learned / "baselines" / "predictions.parquet", columns=["record_id"])
    asked = sorted(set(table.column("record_id").to_pylist()))
    file, out, rng = tmp_path / "mine.parquet", tmp_path / "board", np.random.default_rng(0)

    def board(damage: np.ndarray) -> dict[str, Any]:
        pq.write_table(pa.table({"record_id": asked, "damage": damage}), file)
        diagnostics.leaderboard(learned, tmp_path, out=out, labels=made.sealed)
        found: dict[str, Any] = json.loads((out / NUMBERS).read_text())
        return found

    answers = rng.normal(size=(3, len(asked)))
    boards = [board(damage) for damage in (*answers, answers[0])]  # a second time is no further try
    first = len(boards[0]["log"])
    assert [len(one["log"]) - first for one in boards] == [0, 1, 2, 2]
    assert [len(one["entries"]) for one in boards] == [first] * 4
    limits = [one["counted"]["Alone"]["best_by_chance"] for one in boards]
    assert limits[0] < limits[1] < limits[2] == limits[3]
    assert boards[-1]["log"][-1]["chain"][:16] in (out / BOARD).read_text()
    for changed in (boards[-1]["log"][1:], [*boards[-1]["log"][:-2], boards[-1]["log"][-1]]):
        (out / NUMBERS).write_text(json.dumps({**boards[-1], "log": changed}))
        with pytest.raises(DatasetError, match="of its log is not what was written there"):
            board(answers[0])


def test_a_classifier_of_states_is_graded_where_it_could_learn_them_and_detects_elsewhere(
    made: Made, learned: Path
) -> None:
    bench = diagnostics.open_benchmark(learned)
    learn = diagnostics.table(bench.learn())
    model = diagnostics.LogisticBaseline(strengths=(0.01,)).fit(learn.values, learn.labels["class"], learn.groups)
    rows: dict[str, list[np.ndarray]] = {}
    for name in bench.parts:
        asked = diagnostics.table(bench.part(name)).split("test").columns(learn.names)
        rows.setdefault("record_id", []).append(asked.labels["record_id"])
        for label, column in zip(model.classes_, model.predict_proba(asked.values).T, strict=True):
            rows.setdefault(f"p_{label}", []).append(column)
    mine = {name: np.concatenate(columns) for name, columns in rows.items()}
    found = diagnostics.score_benchmark(bench, mine, labels=made.sealed)
    tasks = {scores.set_name: {row.task for row in scores.rows} for scores in found.parts}
    known, other = {"detect", "grade", "abstain"}, {"detect"}
    assert tasks == {"same": known, "same_alone": known, "other_fault": other, "other_fault_alone": other}
    shown = str(found)
    assert "kurtogram" in shown
    assert bench.digest[:12] in shown


def test_the_best_of_many_without_knowledge_exceeds_its_limit_in_one_board_of_twenty() -> None:
    rng, entries, boards = np.random.default_rng(0), 20, 4000
    best = rng.normal(0.5, 0.05, (boards, entries)).max(axis=1)
    # a share of 0.05 of 4000 boards scatters by 0.0034
    assert np.mean(best > best_by_chance(entries, 0.05)) == pytest.approx(0.05, abs=4 * 0.0034)


@pytest.mark.slow  # learns everything twice
def test_baselines_say_the_same_from_any_number_of_processes(made: Made, tmp_path: Path) -> None:
    files = []
    for workers in (1, 2):
        bench = Path(shutil.copytree(made.benchmark.path, tmp_path / str(workers) / "bench"))
        diagnostics.benchmark_baselines(bench, workers=workers)
        files.append(pq.read_table(bench / "baselines" / "predictions.parquet"))
    assert files[0].num_rows > 0
    assert files[1].equals(files[0])


@pytest.mark.slow  # trains the network once
def test_the_network_learns_from_the_records_that_it_may_see_alone(learned: Path) -> None:
    pytest.importorskip("torch")
    seen = seen_records(benchmark_records(open_benchmark(learned), 1), referenced=True)
    network = next(entry for entry in entries(seen, 0) if entry.name == NETWORK)
    unique = np.unique(seen.gearbox)
    half, own = np.isin(seen.gearbox, unique[: unique.size // 2]), network.X[: seen.learn]
    scores = []
    for damaged in (seen.damaged, np.where(half, seen.damaged, ~seen.damaged)):
        learnt = network.make().fit(own[half], damaged[half], seen.gearbox[half])
        scores.append(learnt.score(network.X))
    assert scores[0].size == seen.learn + seen.tests().size
    assert np.isfinite(scores[0]).all()
    assert np.array_equal(*scores)
