"""What anybody gets of the labels of a benchmark: `python docs/scripts/sealed_labels.py FOLDER`, with its labels.

First: numbers of what is published, in families, as attackers of damage and of shams. Of each family the attacker
whose mean AUC over the parts lies farthest from 0.5, and the share of 2,000 permutations of the labels that reach as
much. Labels are permuted within gearboxes, of parts with one record of a gearbox within the part.

Second: what other asked records tell of one. A logistic regression learns six indicators on the part to learn from.
Its score is taken as it is, and less the mean of other records: of the same gearbox, or of the three of the part that
are nearest in speed and torque. Mean of AUC over the parts, with its standard error.

Third: the AUC of numbers of records for damage, over 1,000 secrets, beside its scatter by chance (Mann and Whitney).
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow as pa

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))  # the attackers are those of the tests

import diagnostics  # noqa: E402
from diagnostics.audit.detectability import ADDED, LEVELS, PLAIN  # noqa: E402
from diagnostics.base.single_thread import single_thread  # noqa: E402
from diagnostics.bench.making import SimulatedPart, renumbered  # noqa: E402
from diagnostics.bench.question import damage_records, is_alone  # noqa: E402
from diagnostics.records.state_classes import HEALTHY, SHAM  # noqa: E402
from diagnostics.scoring.benchmark import Benchmark, labelled, labels_of  # noqa: E402
from diagnostics.statistics.evaluation import column_auc, weighted_auc  # noqa: E402
from tests.diagnostics.bench.attackers import SIGNAL, attackers, permuted_within  # noqa: E402

PERMUTATIONS, SECRETS = 2000, 1000
FAMILIES: Mapping[str, Callable[[str], bool]] = {
    "order and ids": lambda name: not name.startswith((SIGNAL, "column", "last bits", "length")),
    "conditions, texts": lambda name: name.startswith(("column", "last bits", "length")),
    "tacho": lambda name: name.startswith(SIGNAL) and "pulse" in name,
    "sizes in bytes": lambda name: name.startswith(f"{SIGNAL}bytes"),
    "noise": lambda name: name.startswith((f"{SIGNAL}noise", f"{SIGNAL}zeros", f"{SIGNAL}values twice")),
    "all other of signals": lambda name: name.startswith(SIGNAL),
}
"""The first that takes an attacker's name has it."""


class Part(NamedTuple):
    """Asked records of a part: gearbox, state and fault (n,), what attackers make of each, and conditions (n, 2)."""

    gearbox: np.ndarray
    state: np.ndarray
    fault: np.ndarray
    values: Mapping[str, np.ndarray]
    conditions: np.ndarray
    record: np.ndarray


def asked(benchmark: Benchmark, name: str) -> Part:
    """Return the asked records of a part, with their labels."""
    dataset = labelled(benchmark.part(name), labels_of(benchmark, None), name)
    records, values = attackers(benchmark.path / "test" / name)
    rows = {row["record_id"]: row for row in dataset.labels("test").to_pylist()}
    own = [rows[record] for record in records.tolist()]
    gearbox, state, fault = (np.array([row[key] for row in own]) for key in ("specimen_id", "state", "fault"))
    conditions = np.array([[row["speed_hz"], row["torque_nm"]] for row in own])
    return Part(gearbox, state, fault, values, conditions, records)


def strongest(parts: list[Part], names: list[str], damaged: bool) -> tuple[str, float, float]:
    """Return the strongest attacker by its mean over parts, that mean, and the share of permutations that reach it."""
    areas, rng = np.zeros((PERMUTATIONS + 1, len(names))), np.random.default_rng(0)
    for part in parts:
        rows = np.ones(part.state.size, bool) if damaged else part.fault == HEALTHY
        positive = (part.fault != HEALTHY if damaged else part.state == SHAM)[rows]
        lone = np.unique(part.gearbox).size == part.gearbox.size
        gearbox = np.zeros(positive.size) if lone else part.gearbox[rows]
        mixed = np.stack([positive, *(permuted_within(positive, gearbox, rng) for _ in range(PERMUTATIONS))])
        areas += column_auc(np.stack([part.values[name][rows] for name in names], axis=1), mixed) / len(parts)
    best = np.abs(areas - 0.5).max(axis=1)
    first = int(np.abs(areas[0] - 0.5).argmax())
    return names[first], float(areas[0, first]), float(np.mean(best >= best[0] - 1e-12))


def print_attackers(parts: Mapping[str, Part]) -> None:
    """Print the table of attackers."""
    print(
        "| attackers | how many | parts | damage: strongest, AUC, p | sham: strongest, AUC, p |\n|---|---|---|---|---|"
    )
    for alone in (False, True):
        own = [part for name, part in parts.items() if is_alone(name) == alone]
        common = [name for name in own[0].values if all(name in part.values for part in own)]
        for family in FAMILIES:
            names = [name for name in common if next(key for key, take in FAMILIES.items() if take(name)) == family]
            cells = []
            for damaged in (True, False):
                told = [part for part in own if (part.state == SHAM).any() or damaged]
                if alone and not damaged:  # three shams of eighteen healthy ones at most
                    told = []
                cells.append("{}, {:.2f}, {:.3f}".format(*strongest(told, names, damaged)) if told else "-")
            side = "`NAME_alone`" if alone else "`NAME`"
            print(f"| {family} | {len(names)} | {side} | {' | '.join(cells)} |", flush=True)


def area(score: np.ndarray, part: Part) -> float:
    """Return the AUC between records of different gearboxes."""
    return float(weighted_auc(score, part.fault != HEALTHY, np.ones((1, score.size)), part.gearbox)[0])


def print_centred(benchmark: Benchmark, parts: Mapping[str, Part]) -> None:
    """Print what the mean of other records is worth."""
    learn = diagnostics.table(benchmark.learn())
    names = [name for name in learn.names if name.partition("__")[0] in (*LEVELS, *PLAIN, *ADDED)]
    known = learn.columns(names)
    model = diagnostics.LogisticBaseline(strengths=(0.01,))
    model.fit(known.values, np.where(known.labels["fault"] == HEALTHY, "0", "1"), known.groups)
    found: dict[tuple[bool, str], list[float]] = {}
    for name, part in parts.items():
        table = diagnostics.table(benchmark.part(name)).split("test").columns(names)
        row = {record: place for place, record in enumerate(table.labels["record_id"].tolist())}
        probability = model.predict_proba(table.values)[[row[one] for one in part.record.tolist()], 1]
        score = np.log(probability) - np.log1p(-probability)
        same = part.gearbox[:, None] == part.gearbox
        apart = np.abs(np.log(part.conditions)[:, None] - np.log(part.conditions)).sum(axis=2)
        near = np.argsort(np.where(same, np.inf, apart), axis=1)[:, :3]
        scores = {"as it is": score, "less the nearest in speed and torque": score - score[near].mean(axis=1)}
        if not is_alone(name):
            scores["less the mean of its gearbox"] = score - same @ score / same.sum(axis=1)
        for what, own in scores.items():
            found.setdefault((is_alone(name), what), []).append(area(own, part))
    print("\n| parts | score | mean AUC | standard error |\n|---|---|---|---|")
    for (alone, what), areas in sorted(found.items()):
        error = np.std(areas, ddof=1) / len(areas) ** 0.5
        print(f"| {'`NAME_alone`' if alone else '`NAME`'} | {what} | {np.mean(areas):.2f} | {error:.2f} |")


def print_numbers(gearboxes: int = 14) -> None:
    """Print what numbers of records tell, over many secrets."""
    states = {"healthy": HEALTHY, "healthy_again": HEALTHY, "damaged": "spalling", SHAM: HEALTHY}
    rows = [
        {
            "record_id": len(states) * gearbox + place,
            "specimen_id": gearbox,
            "operating_point_id": 0,
            "state_id": place,
            "state": state,
            "fault": fault,
            SHAM: state == SHAM,
        }
        for gearbox in range(gearboxes)
        for place, (state, fault) in enumerate(states.items())
    ]
    part = SimulatedPart(pa.Table.from_pylist(rows), pa.table({}), (), [])
    faults, areas = {row["record_id"]: row["fault"] for row in rows}, []
    for secret in (f"secret {number}".encode() for number in range(SECRETS)):
        shown = damage_records(rows, secret, "same")
        numbers = renumbered(part, shown, secret, "same", 0).record
        told = np.array([(numbers[old], faults[old] != HEALTHY) for old in shown.asked])
        areas.append(column_auc(told[:, :1].astype(np.float64), told[:, 1] > 0)[0])
    damaged, others = gearboxes, gearboxes * (len(states) - 2)
    chance = ((damaged + others + 1) / (12 * damaged * others)) ** 0.5
    print(f"\nnumbers of records, {SECRETS} secrets: AUC {np.mean(areas):.3f}, scatter {np.std(areas):.3f}; by chance "
          f"0.500, {chance:.3f}")  # fmt: skip


@single_thread()
def main(folder: str) -> None:
    """Print all tables."""
    benchmark = diagnostics.open_benchmark(folder)
    parts = {name: asked(benchmark, name) for name in benchmark.parts}
    print_attackers(parts)
    print_centred(benchmark, parts)
    print_numbers()


if __name__ == "__main__":
    main(sys.argv[1])
