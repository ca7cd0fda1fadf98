"""Nobody gets test labels from what is published: attackers on it stay at chance, and find them where they are told."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

import siggen
from diagnostics.statistics.evaluation import column_auc
from tests.command import command
from tests.diagnostics.bench.attackers import SIGNAL, attackers, permuted_within
from tests.diagnostics.bench.conftest import GEARBOXES, Made

PERMUTATIONS, TAIL = 2000, 0.002
"""Share of permuted labels that reach what all attackers together do: below it, labels are told."""


def strongest(values: dict[str, np.ndarray], positive: np.ndarray, gearbox: np.ndarray) -> tuple[str, float]:
    """Return the attacker whose AUC lies farthest from 0.5, and the share of permuted labels that do as well."""
    names = [name for name, column in values.items() if column.size == positive.size and np.ptp(column) > 0]
    matrix = np.stack([values[name] for name in names], axis=1)
    rng = np.random.default_rng(0)
    shuffled = np.stack([permuted_within(positive, gearbox, rng) for _ in range(PERMUTATIONS)])
    found = np.abs(column_auc(matrix, np.concatenate([positive[None], shuffled])) - 0.5)
    best = found.max(axis=1)
    return names[int(found[0].argmax())], float(np.mean(best[1:] >= best[0]))


def truth(made: Made, part: str) -> dict[int, dict[str, object]]:
    labels = json.loads(made.sealed.read_text())["parts"][part]["labels"]
    return {
        row["record_id"]: row
        for row in (dict(zip(labels, own, strict=True)) for own in zip(*labels.values(), strict=True))
    }


def gearboxes(folder: Path, records: np.ndarray) -> np.ndarray:
    rows = siggen.open(folder).labels(columns=["record_id", "specimen_id"]).to_pylist()
    of = {row["record_id"]: row["specimen_id"] for row in rows}
    return np.array([of[record] for record in records.tolist()])


def test_attackers_on_what_is_published_stay_at_chance(made: Made) -> None:
    """A sham has no effect on signals, so that signals may not tell it either; damage may be told by signals alone."""
    folder = made.benchmark.path / "test" / "same"
    records, values = attackers(folder)
    assert records.size == GEARBOXES * 3
    assert len(values) >= 40
    told, own = truth(made, "same"), gearboxes(folder, records)
    states = np.array([told[record]["state"] for record in records.tolist()])
    silent = {name: column for name, column in values.items() if not name.startswith(SIGNAL)}
    assert len(silent) >= 20
    name, share = strongest(silent, states == "pits", own)
    assert share > TAIL, name
    undamaged = states != "pits"
    calm = {name: column[undamaged] for name, column in values.items()}
    name, share = strongest(calm, states[undamaged] == "sham", own[undamaged])
    assert share > TAIL, name


def test_the_same_attackers_find_the_labels_of_the_simulated_set(made: Made) -> None:
    """Were records published as they are simulated, without label columns, their numbers alone would tell."""
    folder = made.simulated("same")
    records, values = attackers(folder, blind=False)
    labels = {row["record_id"]: row for row in siggen.open(folder).labels().to_pylist()}
    states = np.array([labels[record]["state"] for record in records.tolist()])
    own = np.array([labels[record]["specimen_id"] for record in records.tolist()])
    for name in ("number modulo 4", "order among records of its gearbox"):
        assert strongest({name: values[name]}, states == "sham", own)[1] < TAIL


def test_no_published_file_says_what_is_secret(made: Made) -> None:
    sealed = json.loads(made.sealed.read_text())
    words = [sealed["salt"], "many"]
    for config in sealed["configurations"].values():
        words += [str(config["seed"]), siggen.load_config(config).identity]
    for path in sorted(path for path in made.benchmark.path.rglob("*") if path.is_file()):
        content = path.read_bytes()
        if path.suffix == ".parquet":
            file = pq.ParquetFile(path)
            texts = [name for name in file.schema_arrow.names if "string" in str(file.schema_arrow.field(name).type)]
            said = [str(file.schema_arrow.metadata), *map(str, file.read(texts).to_pydict().values())]
            content += "".join(said).encode()
        told = [word for word in words if word.encode() in content]
        assert not told, f"{path}: {told}"


@pytest.mark.parametrize("role", ["provenance", "consequence", "measured"])
def test_columns_of_a_test_part_follow_from_their_roles(made: Made, role: str) -> None:
    part = made.benchmark.part("same")
    simulated = siggen.open(made.simulated("same"))
    kept = set(part.labels().column_names) - {"mesh_stiffness_loss"}
    assert not [name for name in kept if simulated.role(name) == role]
    unknown = part.labels("test").to_pylist()
    assert {row["state"] for row in unknown} == {row["fault"] for row in unknown} == {"unknown"}
    assert all(np.isnan(row["damaged_area_mm2"]) and np.isnan(row["mesh_stiffness_loss"]) for row in unknown)


def test_a_test_part_verifies_by_its_hashes_and_is_not_published_alone(made: Made, tmp_path: Path) -> None:
    folder = made.benchmark.path / "test" / "same"
    found = command("siggen", "verify", str(folder), "--sample", "2")
    assert found.returncode == 0, found.stderr
    assert "what its rows were made of is secret" in found.stdout
    refused = command("siggen", "publish", str(folder), "--to", str(tmp_path / "upload"))
    assert refused.returncode == 2
    assert "is a test part of a benchmark" in refused.stderr


def test_a_gearbox_shows_one_record_where_records_are_judged_alone_and_numbers_are_rounded(made: Made) -> None:
    part, told = made.benchmark.part("same_alone"), truth(made, "same_alone")
    rows = part.labels().to_pylist()
    assert part.splits == ("test",)
    assert len({row["specimen_id"] for row in rows}) == len(rows) == GEARBOXES
    faults = [told[row["record_id"]]["fault"] for row in rows]
    assert faults.count("healthy") == GEARBOXES // 2
    for name in made.benchmark.parts:
        for row in made.benchmark.part(name).labels().to_pylist():
            assert all(float(f"{row[one]:.4g}") == row[one] for one in ("speed_hz", "torque_nm"))
