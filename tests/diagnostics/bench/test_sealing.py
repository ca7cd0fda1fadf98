"""A benchmark from its making to its revealed labels, by command, and what is refused on the way."""

from __future__ import annotations

import hashlib
import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import diagnostics
import siggen
from diagnostics.bench.making import Tier
from diagnostics.scoring.benchmark import open_benchmark
from siggen.columns.record import RecordFailure
from siggen.errors import DatasetError
from siggen.sets.chosen_records import ChosenRecords
from tests.command import Ended, command
from tests.diagnostics.bench.conftest import GEARBOXES, SECRET, Made, make

AREA = "damaged_area_mm2"
FACTS = """
license: cc-by-4.0
title: A benchmark
version: 1.0.0
published: 2026-11-30
publisher: An institute
url: https://example.org/benchmark
citation: A citation
authors: [{name: "Family, Given"}]
"""


def diagnostics_command(*arguments: str) -> Ended:
    return command("diagnostics", *arguments)


def sealed(made: Made) -> dict[str, dict[str, dict[str, list[float]]]]:
    found: dict[str, dict[str, dict[str, list[float]]]] = json.loads(made.sealed.read_text())["parts"]
    return found


def predictions(made: Made, **wrong: list[float]) -> pa.Table:
    """Return the truth as predictions of both parts."""
    rows = []
    for part, told in sealed(made).items():
        tests = set(made.benchmark.part(part).labels("test", ["record_id"]).column("record_id").to_pylist())
        pairs = zip(told["labels"]["record_id"], told["labels"][AREA], strict=True)
        rows += [{"record_id": record, "damage": area} for record, area in pairs if record in tests]
    table = pa.Table.from_pylist(rows)
    for name, values in wrong.items():
        table = table.set_column(table.column_names.index(name), name, pa.array(values))
    return table


def copied(made: Made, folder: Path) -> Path:
    return Path(shutil.copytree(made.benchmark.path, folder / "bench"))


def test_a_benchmark_is_committed_to_scored_sealed_revealed_and_scored_again(made: Made, tmp_path: Path) -> None:
    bench, mine = copied(made, tmp_path), tmp_path / "mine.parquet"
    pq.write_table(predictions(made), mine)
    secret = ("--labels", str(made.sealed))
    early = diagnostics_command("score", str(bench), str(mine))
    assert early.returncode == 2
    assert "its labels are not revealed" in early.stderr
    for wrong in ((str(bench), str(mine), "--split", "validation"), (str(bench / "learn"), str(mine), *secret)):
        assert diagnostics_command("score", *wrong).returncode == 2
    printed = diagnostics.commit_benchmark(bench, made.sealed)
    assert printed == hashlib.sha256(made.sealed.read_bytes()).hexdigest()
    before = diagnostics_command("score", str(bench), str(mine), *secret, "--json")
    (tmp_path / "bench_secret").mkdir()
    shutil.copy(made.sealed, tmp_path / "bench_secret")
    assert diagnostics_command("score", str(bench), str(mine), "--json").stdout == before.stdout
    revealed = diagnostics.reveal_benchmark(bench)
    shutil.rmtree(tmp_path / "bench_secret")
    assert hashlib.sha256(revealed.read_bytes()).hexdigest() == printed
    after = diagnostics_command("score", str(bench), str(mine), "--json")
    assert before.stdout == after.stdout
    rows = json.loads(after.stdout)["scores"]
    perfect = {(row["set"], row["records"]): row["score"] for row in rows if row["task"] == "detect"}
    assert perfect["same", "every damage"] == perfect["other_fault", "every damage"] == 1.0
    assert perfect["same", "sham against healthy"] == 0.5
    assert {row["digest"] for row in rows} == {made.benchmark.digest}
    assert {row["simulation_version"] for row in rows} == {made.benchmark.simulation_version}


def test_what_is_revealed_makes_the_test_parts_again(made: Made) -> None:
    content = json.loads(made.sealed.read_text())
    told = content["parts"]["same"]["labels"]
    again = siggen.load_config(content["configurations"]["same"])
    assert len({config["seed"] for config in content["configurations"].values()}) == 4
    assert again.identity == siggen.open(made.simulated("same")).manifest["identity"]
    record, simulated = told["record_id"][30], told["simulated_record_id"][30]
    gearbox, case = divmod(simulated, again.records_per_specimen)
    drawn = siggen.draw(again, gearbox)
    (made_again,) = siggen.runs(drawn, [drawn.cases[case]])
    published = made.benchmark.part("same").record(record)
    (column, *_) = (channel.column for channel in made.benchmark.part("same").channels)
    assert np.array_equal(next(iter(made_again.channels.values())), published[column])


def test_a_part_that_is_judged_alone_holds_the_records_of_its_whole_set_and_only_they_are_simulated(
    made: Made, tmp_path: Path
) -> None:
    content = json.loads(made.sealed.read_text())
    sealed_part = content["parts"]["same_alone"]
    siggen.generate(siggen.load_config(content["configurations"]["same_alone"]), tmp_path / "whole", executor="serial")
    whole, part = siggen.open(tmp_path / "whole"), made.benchmark.part("same_alone")
    assert not made.simulated("same_alone").exists()
    told = sealed_part["labels"]
    rows = {row["record_id"]: row for row in whole.labels().to_pylist()}
    teeth = whole.damage().to_pylist()
    assert len(told["record_id"]) == GEARBOXES
    for place, (record, simulated) in enumerate(zip(told["record_id"], told["simulated_record_id"], strict=True)):
        published, again = part.record(record), whole.record(simulated)
        for name in (*(channel.column for channel in part.channels), "tacho_s"):
            assert published[name].tobytes() == again[name].tobytes()
        named = set(told) - {"record_id", "simulated_record_id"}
        assert {name: told[name][place] for name in named} == {name: rows[simulated][name] for name in named}
        damaged = zip(*(sealed_part["damage"][name] for name in ("record_id", "gear", "tooth")), strict=True)
        expected = [(row["gear"], row["tooth"]) for row in teeth if row["record_id"] == simulated]
        assert [(gear, tooth) for one, gear, tooth in damaged if one == record] == expected


def test_in_place_of_a_record_that_fails_the_next_one_is_published(
    made: Made, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The very choice that a set without that record would give."""
    told = json.loads(made.sealed.read_text())["parts"]["same_alone"]["labels"]
    simulate, lost = siggen.simulate_records, told["simulated_record_id"][0]

    def failing(design: Any, record_ids: list[int], workers: int | None) -> ChosenRecords:
        left = [one for one in record_ids if one != lost or design.name != "linear_pits_same_alone"]
        failures = (RecordFailure(lost, "outside_model", "planted"),) if len(left) < len(record_ids) else ()
        return replace(simulate(design, left, workers), failures=failures)

    monkeypatch.setattr(siggen, "simulate_records", failing)
    again = make(tmp_path, Tier(6, GEARBOXES))
    other = json.loads(again.sealed.read_text())["parts"]["same_alone"]["labels"]
    rows = dict(zip(other["simulated_record_id"], other["state"], strict=True))
    (instead,) = rows.keys() - set(told["simulated_record_id"])
    each = again.benchmark.learn().inventory.rows // 6
    assert instead // each == lost // each
    assert set(told["simulated_record_id"]) - rows.keys() == {lost}


def test_the_secret_alone_decides_seeds_and_order(made: Made, tmp_path: Path) -> None:
    facts = tmp_path / "publication.yaml"
    facts.write_text(FACTS)
    same, other = make(tmp_path / "same"), make(tmp_path / "other", secret=SECRET + b"!", facts=facts)
    again = make(tmp_path / "same")
    assert again.benchmark.digest == same.benchmark.digest != other.benchmark.digest
    assert again.sealed.read_bytes() == same.sealed.read_bytes()
    (seeds, others) = (
        {part: one["seed"] for part, one in json.loads(found.sealed.read_text())["configurations"].items()}
        for found in (same, other)
    )
    assert len({*seeds.values(), *others.values()}) == 4
    assert max(map(int.bit_length, (*seeds.values(), *others.values()))) > 100
    shutil.rmtree(same.hidden)
    with pytest.raises(DatasetError, match="was made with another secret"):
        make(tmp_path / "same", secret=SECRET + b"!")
    card = (other.benchmark.path / "README.md").read_text()
    assert "license: cc-by-4.0" in card
    assert "Cite as: A citation" in card
    assert (other.benchmark.path / "learn" / "croissant.json").is_file()
    learned = json.loads((made.benchmark.path / "learn" / "manifest.json").read_text())["seed"]
    assert learned not in (*seeds.values(), *others.values())


def test_labels_of_another_benchmark_and_changed_parts_are_refused(made: Made, tmp_path: Path) -> None:
    other = make(tmp_path, secret=SECRET + b"?")
    mine = tmp_path / "mine.parquet"
    pq.write_table(predictions(made), mine)
    found = diagnostics_command("score", str(made.benchmark.path), str(mine), "--labels", str(other.sealed))
    assert found.returncode == 2
    assert made.benchmark.digest[:12] in found.stderr
    assert other.benchmark.digest[:12] in found.stderr
    wrong = tmp_path / "wrong.json"
    wrong.write_text(made.sealed.read_text().replace('"salt": "', '"salt": "0'))
    found = diagnostics_command("score", str(made.benchmark.path), str(mine), "--labels", str(wrong))
    assert "These are other labels" in found.stderr
    bench = copied(made, tmp_path / "mixed")
    shutil.rmtree(bench / "test" / "same")
    shutil.copytree(other.benchmark.path / "test" / "same", bench / "test" / "same")
    with pytest.raises(DatasetError, match="its parts are not those that were published"):
        open_benchmark(bench)
    named = predictions(made).replace_schema_metadata({"diagnostics.identity": other.benchmark.digest})
    pq.write_table(named, mine)
    found = diagnostics_command("score", str(made.benchmark.path), str(mine), "--labels", str(made.sealed))
    assert found.returncode == 2
    assert "holds predictions of the set" in found.stderr


def test_problems_of_all_parts_come_in_one_list(made: Made, tmp_path: Path) -> None:
    mine = tmp_path / "mine.parquet"
    table = predictions(made)
    values = table.column("damage").to_numpy().copy()
    values[[0, -1]] = np.nan
    pq.write_table(predictions(made, damage=values.tolist()).slice(1, len(table)), mine)
    found = diagnostics_command("score", str(made.benchmark.path), str(mine), "--labels", str(made.sealed))
    assert found.returncode == 2
    assert "2 problems" in found.stderr
    assert "other_fault: 1 record missing" in found.stderr
    assert "same_alone: damage is nan in 1 record" in found.stderr
