"""A benchmark of lives by command, from its making to its revealed labels; nothing but sensors and age tells an end."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import yaml
from scipy.stats import kstest, rankdata

import diagnostics
import siggen
from diagnostics.bench.leaderboard import BOARD, NUMBERS, pace
from diagnostics.bench.making import SEALED, SECRET_FILE, SIMULATED, TIERS, Tier
from diagnostics.bench.question import LIFE_CONDITIONS
from diagnostics.scoring.benchmark import open_benchmark
from diagnostics.training.lives import AGE, DEBRIS
from siggen.dataset.reading import Dataset
from siggen.life.pitting import TORQUE_EXPONENT
from tests.command import Ended, command
from tests.diagnostics.bench.attackers import SIGNAL, attackers
from tests.diagnostics.bench.conftest import SECRET, Made
from tests.shared import shared_folder

CONFIG: dict[str, Any] = {
    "extends": str(Path(__file__).parents[2] / "configs" / "linear_pits.yaml"),
    "name": "brief_lives",
    "fs_hz": 12_800,
    "duration_s": 0.12,
    "mesh_harmonics": 3,
    "operating_points": [{"speed_hz": 30.0, "torque_nm": 60.0}],
    "states": None,
    "life": {"reference_torque_nm": 60.0, "scale": 0.03, "interval_h": 0.5, "most": 11, "removed_share": 0.3},
}
"""Gearboxes that fail after 2 to 6 h; some are taken out before."""
PARTS, GEARBOXES = ("same", "other_load"), 12
"""Of 24 at least one is taken out, but for a chance of 2e-4; 17 are left to show what a whole history would tell."""
PERMUTATIONS, TAIL = 2000, 0.002
"""Share of permuted lives that reach what all attackers together do: below it, lives are told."""
UNCUT = "number of inspections, uncut"
Row = dict[str, Any]


def bench(*arguments: str) -> Ended:
    ended = command("diagnostics", *arguments)
    assert ended.returncode == 0, ended.stderr
    return ended


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    """The benchmark with its baselines, committed to, not revealed."""

    def make(folder: Path) -> None:
        hidden, config = folder / "hidden", folder / "lives.yaml"
        hidden.mkdir(parents=True)
        (hidden / SECRET_FILE).write_bytes(SECRET)
        config.write_text(yaml.safe_dump(CONFIG, sort_keys=False))
        with pytest.MonkeyPatch.context() as patch:
            patch.setitem(TIERS, "tiny", Tier(5, GEARBOXES))
            diagnostics.make_benchmark(folder / "bench", config=str(config), secret=hidden, workers=0)
        diagnostics.commit_benchmark(folder / "bench", hidden / SEALED)
        diagnostics.benchmark_baselines(folder / "bench")

    folder = shared_folder(tmp_path_factory, "benchmark of lives", make)
    return Made(open_benchmark(folder / "bench"), folder / "hidden")


def truth(made: Made, part: str) -> list[Row]:
    """Return the sealed inspections of a part that are asked about."""
    table = pa.table(json.loads(made.sealed.read_text())["parts"][part]["life"]["inspections"])
    return [row for row in table.to_pylist() if row["split"] == "test"]


def test_predicted_lives_are_scored_and_ranked_by_their_error_before_and_after_labels_are_revealed(
    made: Made, tmp_path: Path
) -> None:
    rows = [row for part in PARTS for row in truth(made, part)]
    failed = {part: sum(row["rul_h"] is not None for row in truth(made, part)) for part in PARTS}
    assert any(0 < count < GEARBOXES for count in failed.values())  # some were taken out
    entries, secret = tmp_path / "entries", ("--labels", str(made.sealed))
    entries.mkdir()
    mine = entries / "knows all.parquet"
    hours = [(row["rul_h"], row["rul_at_least_h"]) for row in rows]
    known = [left if left is not None else least + 100.0 for left, least in hours]  # whose error would be large
    pq.write_table(pa.table({"record_id": [row["record_id"] for row in rows], "rul_h": known}), mine)
    folder = str(made.benchmark.path)
    early = command("diagnostics", "score", folder, str(mine))
    assert early.returncode == 2
    assert "its labels are not revealed" in early.stderr
    before = bench("score", folder, str(mine), *secret, "--json").stdout
    page = diagnostics.leaderboard(folder, entries, labels=made.sealed, out=tmp_path)
    diagnostics.reveal_benchmark(folder, made.sealed)
    try:
        assert bench("score", folder, str(mine), "--json").stdout == before
    finally:
        (made.benchmark.path / "revealed.json").unlink()
    errors = [row for row in json.loads(before)["scores"] if row["measure"].startswith("mean absolute error")]
    own = [row["score"] for row in errors if row["name"] == "yours" and row["records"] == "all"]
    assert own == [0.0, 0.0]
    assert {AGE, DEBRIS} < {row["name"] for row in errors}
    assert all(row["difference"] < 0.0 for row in errors if row["name"] == AGE)
    ranked = json.loads((page.parent / NUMBERS).read_text())["entries"]
    means = [row["error_h"]["mean"]["value"] for row in ranked]
    assert ranked[0]["name"] == "knows all"
    assert means == sorted(means)
    assert means[1] > 0.0
    assert ranked[-1]["minus_first"]["same"]["value"] == pytest.approx(ranked[-1]["error_h"]["same"]["value"])
    said = (page.parent / BOARD).read_text()
    assert "knows all leads with a mean error [h] of 0.00" in said
    assert "sham" not in said


def test_a_model_of_ones_own_takes_age_and_indicators_from_the_public_table(made: Made) -> None:
    """A line of age that knows the lives to learn from, to the least squares of numpy."""
    bench = diagnostics.open_benchmark(str(made.benchmark.path))
    learn, asked = diagnostics.table(bench.learn()), diagnostics.table(bench.part("same")).split("test")
    age_h, left_h = (learn.labels[name] for name in ("age_h", "rul_h"))
    failed = np.isfinite(left_h)
    assert failed.any()
    line = np.polyfit(age_h[failed], left_h[failed], 1)
    mine = {"record_id": asked.labels["record_id"], "rul_h": np.maximum(np.polyval(line, asked.labels["age_h"]), 0.0)}
    (found,) = diagnostics.score_benchmark(bench, mine, labels=made.sealed).parts
    told = {row["record_id"]: row["rul_h"] for row in truth(made, "same")}
    errors = [
        abs(told[record] - hours) for record, hours in zip(*mine.values(), strict=True) if told[record] is not None
    ]
    assert found.rows[0].score.value == pytest.approx(np.mean(errors))
    assert np.isnan(asked.labels["rul_h"]).all()
    assert asked.roles["rul_h"] == "target"
    assert asked.columns(learn.names).values.shape == (GEARBOXES, learn.values.shape[1])


@pytest.mark.parametrize(
    ("history", "expected"),
    [
        ([], 1.05 ** TORQUE_EXPONENT.at(0.5)),
        ([[2.0, 1.05], [1.0, 0.0]], 1.5),
        ([[1.0, 60.0, 30.0]], 1.0),
    ],
)
def test_baselines_count_hours_by_what_wears_as_much(history: list[Any], expected: float) -> None:
    config = {"life": {"history": history}}
    assert pace(config, LIFE_CONDITIONS["other_load"]) == pytest.approx(expected, rel=1e-12)
    assert pace(config, LIFE_CONDITIONS["same"]) == 1.0


def shown(made: Made, part: str) -> tuple[Dataset, Dataset, list[tuple[Row, Row]]]:
    """Return a part, its simulated set, and every published inspection beside the simulated one."""
    published, simulated = made.benchmark.part(part), siggen.open(made.simulated(part))
    labels = json.loads(made.sealed.read_text())["parts"][part]["labels"]
    old = dict(zip(labels["record_id"], labels["simulated_record_id"], strict=True))
    of_old = {row["record_id"]: row for row in simulated.life("inspections").to_pylist()}
    return (
        published,
        simulated,
        [(row, of_old[old[row["record_id"]]]) for row in published.life("inspections").to_pylist()],
    )


@pytest.mark.parametrize("part", PARTS)
def test_a_part_shows_each_gearbox_up_to_an_inspection_and_nothing_of_what_comes_later(made: Made, part: str) -> None:
    published, simulated, pairs = shown(made, part)
    assert sorted(path.stem for path in (Path(published.path) / "life").iterdir()) == [
        "debris",
        "inspections",
        "pictures",
    ]
    keys = ["record_id", "specimen_id", "split", "inspection"]
    assert published.life("inspections").column_names == [*keys, "age_h", "age_rev"]
    assert published.life("debris").column_names == [*keys, "debris_mg"]
    labels = published.labels().to_pylist()
    assert {row["state"] for row in labels} == {"unknown"}
    assert all(np.isnan(row["damaged_area_mm2"]) and np.isnan(row["damaged_area_share"]) for row in labels)
    assert {row["record_id"] for row in labels} == {new["record_id"] for new, _ in pairs}
    own: dict[int, list[Row]] = {}
    for new, old in pairs:
        assert (new["age_h"], new["inspection"]) == (old["age_h"], old["inspection"])
        own.setdefault(new["specimen_id"], []).append(new)
    assert len(own) == GEARBOXES
    for rows in own.values():
        ordered = sorted(rows, key=lambda row: row["inspection"])
        assert [row["inspection"] for row in ordered] == list(range(len(rows)))
        assert [row["split"] for row in ordered] == ["train"] * (len(rows) - 1) + ["test"]
    debris = {row["record_id"]: row["debris_mg"] for row in simulated.life("debris").to_pylist()}
    old_id = {new["record_id"]: old["record_id"] for new, old in pairs}
    assert all(row["debris_mg"] == debris[old_id[row["record_id"]]] for row in published.life("debris").to_pylist())
    pictures = [row for row in simulated.life("pictures").to_pylist() if row["record_id"] in old_id.values()]
    seen = sorted(
        (old_id[row["record_id"]], row["gear"], row["tooth"], row["png"])
        for row in published.life("pictures").to_pylist()
    )
    assert seen == sorted((row["record_id"], row["gear"], row["tooth"], row["png"]) for row in pictures)
    assert "as its manifest promises" in command("siggen", "verify", str(published.path)).stdout


def test_records_of_a_part_are_looked_at_and_a_report_says_why_it_cannot_judge(made: Made, tmp_path: Path) -> None:
    part = str(made.benchmark.path / "test" / "same")
    bench("explore", part, "--out", str(tmp_path / "look.html"))
    assert "Age [h]" in (tmp_path / "look.html").read_text()
    refused = command("diagnostics", "report", part, "--out", str(tmp_path / "report"))
    assert refused.returncode != 0
    assert "does not tell when its gearboxes fail, as a test part of a benchmark" in refused.stderr


def strongest(values: dict[str, np.ndarray], rest: np.ndarray) -> tuple[str, float]:
    """Return the attacker that orders best what age leaves of lives, and the share of permuted lives so ordered."""
    names = [name for name, column in values.items() if np.ptp(column) > 0]
    ranks = np.stack([_ranks(values[name]) for name in names])
    rng, own = np.random.default_rng(0), _ranks(rest)
    found = np.abs(ranks @ np.stack([own, *(rng.permutation(own) for _ in range(PERMUTATIONS))], axis=1))
    best = found.max(axis=0)
    return names[int(found[:, 0].argmax())], float(np.mean(best[1:] >= best[0]))


def _ranks(column: np.ndarray) -> np.ndarray:
    """Return ranks, equal values sharing theirs, with mean 0 and norm 1."""
    centred = rankdata(column) - 0.5 * (column.size + 1)
    return np.asarray(centred / np.linalg.norm(centred))


def attacked(made: Made, part: str) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray]:
    """Return what attackers make of the gearboxes of a part, their lives, and which failed; all beyond what age tells.

    How long those that were taken out would have run is known to the simulation. Numbers of inspections that are not
    published stand last.
    """
    published, simulated, pairs = shown(made, part)
    records, values = attackers(Path(published.path))
    units = {row["specimen_id"]: row for row in simulated.life("units").to_pylist()}
    asked = {new["record_id"]: (new, units[old["specimen_id"]]) for new, old in pairs if new["split"] == "test"}
    order = [asked[record] for record in records.tolist()]
    age_h = np.array([new["age_h"] for new, _ in order])
    left_h = np.array([unit["failure_h"] for _, unit in order]) - age_h
    silent = {name: column for name, column in values.items() if not name.startswith(SIGNAL)}
    counts = [sum(row["specimen_id"] == new["specimen_id"] for row, _ in pairs) for new, _ in order]
    silent["number of records"] = np.array(counts, dtype=np.float64)
    silent[UNCUT] = np.array([unit["inspections"] for _, unit in order], dtype=np.float64)
    beyond = {name: _beyond(age_h, column) for name, column in silent.items()}
    return beyond, _beyond(age_h, left_h), np.array([unit["event"] == "failed" for _, unit in order])


def _beyond(age_h: np.ndarray, column: np.ndarray) -> np.ndarray:
    """Return what a line of age leaves of a column, over its deviation; 0 where only rounding is left."""
    rest = column - np.polynomial.Polynomial.fit(age_h, column, 1)(age_h)
    return rest / rest.std() if rest.std() > 1e-9 * np.abs(column).max() else np.zeros_like(rest)


def test_numbers_order_and_conditions_tell_no_remaining_life_beyond_age(made: Made) -> None:
    parts = [attacked(made, part) for part in PARTS]
    values = {name: np.concatenate([one[0][name] for one in parts]) for name in parts[0][0]}
    rest, failed = (np.concatenate([one[k] for one in parts]) for k in (1, 2))
    uncut = values.pop(UNCUT)
    assert len(values) >= 20
    name, share = strongest(values, rest)
    assert share > TAIL, name
    assert strongest({UNCUT: uncut[failed]}, rest[failed])[1] < 0.05  # which a whole history would tell; one attacker


def test_lives_are_cut_anywhere(made: Made) -> None:
    """Place of the last inspection shown among all of its gearbox: uniform, by a test of 14 at a chance of 0.1 %."""
    places = []
    for part in PARTS:
        _, simulated, pairs = shown(made, part)
        units = {row["specimen_id"]: row["inspections"] for row in simulated.life("units").to_pylist()}
        places += [
            (old["inspection"] + 0.5) / units[old["specimen_id"]] for new, old in pairs if new["split"] == "test"
        ]
    assert kstest(places, "uniform").pvalue > 1e-3


def test_no_published_file_names_seed_or_identity_of_a_test_fleet(made: Made) -> None:
    content = json.loads(made.sealed.read_text())
    words = [content["salt"], *(str(config["seed"]) for config in content["configurations"].values())]
    words += [siggen.open(made.hidden / SIMULATED / part).manifest["identity"] for part in PARTS]
    for path in (path for path in made.benchmark.path.rglob("*") if path.is_file()):
        said = path.read_bytes()
        if path.suffix == ".parquet":
            said += str(pq.ParquetFile(path).schema_arrow.metadata).encode()
        assert not [word for word in words if word.encode() in said], path
