"""Asked is how long a gearbox still runs, at the last of its inspections that a part shows.

A whole history tells its length. So each gearbox is shown up to an inspection that the secret draws, each of its
inspections alike; what comes later is not written. Only the last one shown is asked about: of those before everybody
can see that the gearbox ran on. Signals, debris, pictures, age and the number of the inspection go along. Gearboxes
that were taken out are asked about like all others, and are in no error.

The baselines learn on the part to learn from. They count hours by what wears as much there: the load of every part and
the exponent of torque are published.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.bench.conditions import LIFE_CONDITIONS
from diagnostics.bench.derived_secret import derived
from diagnostics.bench.question import PublishedRecords, Question, Ranking, Renumbered, Words
from diagnostics.indicators.table import record_table
from diagnostics.scoring.benchmark import Benchmark
from diagnostics.scoring.prediction_file import CLASSIFIER, RECORD
from diagnostics.scoring.remaining_life import COLUMNS, EVERY, REMAINING_LIFE
from diagnostics.training.lives import Inspections, blind_inspections, inspections_of, predictors
from siggen.dataset.reading import Dataset
from siggen.errors import counted


def life_predictions(benchmark: Benchmark, seed: int, workers: int) -> Iterator[pa.Table]:
    """Yield the rows of every baseline.

    Raises
    ------
    DatasetError
        If fewer than four gearboxes of the part to learn from failed.
    """
    parts = {name: benchmark.part(name) for name in benchmark.parts}
    learn = inspections_of(benchmark.learn(), record_table(benchmark.learn(), workers=workers))
    tests = [blind_inspections(part, record_table(part, workers=workers)) for part in parts.values()]
    found = joined([learn, *tests])
    paces = [pace(benchmark.learn().config, LIFE_CONDITIONS.get(name, {})) for name in parts]
    hour = np.repeat([1.0, *paces], [one.specimen.size for one in (learn, *tests)])
    found = replace(found, age_h=found.age_h * hour)
    known = np.arange(found.specimen.size) < learn.specimen.size
    asked = ~known & (found.split == "test")
    for name, predict in predictors(found, seed).items():
        hours = np.maximum(predict(known, asked) / hour[asked, None], 0.0)  # lives are never below 0
        record = pa.array(found.record_id[asked], pa.int64())
        yield pa.table({CLASSIFIER: [name] * len(record), RECORD: record, **dict(zip(COLUMNS, hours.T, strict=True))})


def pace(config: Mapping[str, Any], changes: Mapping[str, Any]) -> float:
    """Return how many hours of a configuration of lives wear as much as one with some changes; speeds are alike.

    It is 1 where the configuration gives its load in N m: that of the test part is relative.
    """
    life = config["life"]
    histories = [own or [[1.0, 1.0]] for own in ({**life, **changes.get("life", {})}["history"], life["history"])]
    if any(len(block) > 2 for own in histories for block in own):
        return 1.0
    given = life["damage"]["torque_exponent"]
    exponent = 0.5 * sum(given) if isinstance(given, list) else given  # gearboxes draw theirs: the middle
    wear, usual = (sum(h * ratio**exponent for h, ratio in own) / sum(h for h, _ in own) for own in histories)
    return float(wear / usual)


def joined(parts: Sequence[Inspections]) -> Inspections:
    """Return the inspections of several sets, no two of which share a number of a gearbox; without averages."""
    arrays = {
        one.name: np.concatenate([getattr(part, one.name) for part in parts])
        for one in fields(Inspections)
        if one.name not in ("indicators", "averages")
    }
    indicators = {name: np.concatenate([part.indicators[name] for part in parts]) for name in parts[0].indicators}
    return replace(parts[0], **arrays, indicators=indicators, averages=None)


KEYS = ("record_id", "specimen_id", "split", "inspection")
SEEN = {"inspections": ("age_h", "age_rev"), "debris": ("debris_mg",), "pictures": ("gear", "tooth", "png")}
"""Tables of `life/` and their columns that a model may see; all else is truth."""
SEALED = ("inspections", "outlook")
RULES = """* One number for each record of the split `test`, the last inspection shown of a gearbox: `rul_h`, the hours
  until its functional end; `rul_q10_h` and `rul_q90_h` may stand beside it.
* Everything that the part shows of the gearbox may be used: signals, `life/inspections` (age), `life/debris`,
  `life/pictures`. Other gearboxes of the part may not be used.
* Learn and choose on `learn` alone. Nothing is learned from test parts.
* In `other_load` gearboxes run between inspections at 1.05 times the torque of their records, and not as in `learn`.
* Gearboxes that were taken out before they failed are in no error. Nobody can tell them before labels are revealed."""


def part_card(title: str, name: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the card of a test part."""
    asked = len({row["specimen_id"] for row in rows})
    return f"""# {title}, test part {name}

{counted(len(rows), "record")} of {counted(asked, "gearbox", "gearboxes")}, each up to one of its inspections, which
was drawn. The split `test` has that inspection, at which the remaining life is asked, the split `train` those before.
`state` and all that follows from it say `unknown`, or NaN. `life/` has ages, debris and pictures. Numbers of records
and gearboxes were drawn; order and files tell nothing. `config.yaml` is that of the part to learn from; the seed of
this part is secret until labels are revealed.
"""


def shown_records(dataset: Dataset, secret: bytes, name: str) -> PublishedRecords:
    """Return the records of every gearbox up to an inspection drawn from all that it has."""
    rows = dataset.labels(columns=["record_id", "specimen_id", "state_id"]).to_pylist()
    numbers: dict[int, set[int]] = {}
    for row in rows:
        numbers.setdefault(row["specimen_id"], set()).add(row["state_id"])
    last = {gearbox: _drawn(sorted(own), secret, name, gearbox) for gearbox, own in numbers.items()}
    state_id = {row["record_id"]: row["state_id"] for row in rows if row["state_id"] <= last[row["specimen_id"]]}
    asked = (row["record_id"] for row in rows if row["state_id"] == last[row["specimen_id"]])
    return PublishedRecords(state_id, frozenset(), frozenset(asked))


def _drawn(inspections: list[int], secret: bytes, name: str, gearbox: int) -> int:
    draw = int.from_bytes(derived(secret, "cut", name, gearbox)[:16], "big")  # 128 bits: as good as uniform
    return inspections[draw % len(inspections)]


def life_tables(dataset: Dataset, numbers: Renumbered) -> tuple[dict[str, pa.Table], dict[str, pa.Table]]:
    """Return the tables of `life/` to publish, and those to seal; of inspections that are shown alone."""
    first = _first_records(dataset, numbers)
    whole = {name: _shown_rows(dataset.life(name), first, numbers) for name in dict.fromkeys((*SEEN, *SEALED))}
    seen = {name: whole[name].select([*KEYS, *columns]) for name, columns in SEEN.items()}
    return seen, {name: whole[name] for name in SEALED}


def _first_records(dataset: Dataset, numbers: Renumbered) -> dict[tuple[int, int], int]:
    """Return the first published record of every gearbox and inspection, by its number in the simulated set."""
    found: dict[tuple[int, int], int] = {}
    for row in dataset.labels(columns=["record_id", "specimen_id", "state_id"]).to_pylist():
        if row["record_id"] in numbers.record:
            key = row["specimen_id"], row["state_id"]
            found[key] = min(found.get(key, row["record_id"]), row["record_id"])
    return found


def _shown_rows(table: pa.Table, first: Mapping[tuple[int, int], int], numbers: Renumbered) -> pa.Table:
    rows = sorted(_renumbered_rows(table, first, numbers), key=lambda row: int(row["record_id"]))
    return pa.Table.from_pylist(rows, schema=table.schema)


def _renumbered_rows(
    table: pa.Table, first: Mapping[tuple[int, int], int], numbers: Renumbered
) -> Iterator[dict[str, Any]]:
    for row in table.to_pylist():
        record = first.get((row["specimen_id"], row["inspection"]))
        if record is not None:
            own = {"record_id": numbers.record[record], "specimen_id": numbers.gearbox[row["specimen_id"]]}
            yield {**row, **own, "split": numbers.split(record)}


LIFE_QUESTION = Question(
    title="siggen-bench 1.0, lives",
    conditions=LIFE_CONDITIONS,
    parts=dict,
    words=Words("Remaining life of gears", RULES, "history", part_card),
    ranking=Ranking(
        REMAINING_LIFE,
        EVERY,
        None,
        "error [h]",
        "error_h",
        "mean absolute errors of the remaining life at the last inspection shown, so less is better (gearboxes that "
        "were taken out are in none)",
        {False: "Remaining life"},
    ),
    shown=shown_records,
    tables=life_tables,
    predictions=life_predictions,
)
