"""Asked is whether a record shows damage. A part shows one healthy record of each gearbox as a reference."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from diagnostics.bench.baselines import damage_predictions
from diagnostics.bench.conditions import CONDITIONS
from diagnostics.bench.derived_secret import shuffled
from diagnostics.bench.question import PublishedRecords, Question, Ranking, Words
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring.detect import DETECT, EVERY, LEAK
from siggen.dataset.reading import Dataset
from siggen.errors import counted

RULES = """* One number for each record of the split `test`: `damage`, which rises with damage. Columns of other
  tasks may stand beside it.
* **Alone**: a record is judged by itself. **Beside**: the gearbox's record of the split `train`, which is healthy, may
  be used too; the predictions then have a column `reference` that is true. Other records of the part may not be used.
* Learn and choose on `learn` alone. Nothing is learned from test parts."""


def part_card(title: str, name: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the card of a test part."""
    tests = sum(row["split"] == "test" for row in rows)
    told = len(rows) - tests
    return f"""# {title}, test part {name}

{counted(tests, "record")} without labels in the split `test`. The split `train` has one healthy record of each gearbox
({told}), told as a reference. `state` and all that follows from it say `unknown`, or NaN. Numbers of records and
gearboxes were drawn; order and files tell nothing. `config.yaml` is that of the part to learn from; the seed of this
part is secret until labels are revealed.
"""


def shown_records(dataset: Dataset, secret: bytes, name: str) -> PublishedRecords:
    """Return all records; one healthy one of every gearbox and operating point is told, drawn by lot."""
    rows = dataset.labels().to_pylist()
    every = frozenset(row["record_id"] for row in rows)
    told = frozenset(_references(rows, secret, name))
    return PublishedRecords({one: int(one not in told) for one in every}, told, every - told)


def _references(rows: list[dict[str, Any]], secret: bytes, name: str) -> Iterator[int]:
    """Yield a healthy record of every gearbox and operating point that has two of them, drawn by lot."""
    healthy: dict[tuple[int, int], list[int]] = {}
    for row in rows:
        if row["fault"] == HEALTHY and not row.get(SHAM, False):
            healthy.setdefault((row["specimen_id"], row["operating_point_id"]), []).append(row["record_id"])
    yield from (shuffled(secret, f"references/{name}", own)[0] for own in healthy.values() if len(own) > 1)


DAMAGE_QUESTION = Question(
    title="siggen-bench 1.0",
    conditions=CONDITIONS,
    words=Words("Damage of gears", RULES, "reference", part_card),
    ranking=Ranking(
        DETECT,
        EVERY,
        LEAK,
        "AUC",
        "auc",
        "AUC of damaged against healthy records of other gearboxes",
        {False: "Alone", True: "Beside a healthy record of the same gearbox"},
    ),
    shown=shown_records,
    tables=lambda _dataset, _numbers: ({}, {}),
    predictions=damage_predictions,
)
