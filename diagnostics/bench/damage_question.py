"""Asked is whether a record shows damage. A part shows one healthy record of each gearbox as a reference."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from diagnostics.bench.baselines import damage_predictions
from diagnostics.bench.conditions import CONDITIONS, is_alone, with_alone
from diagnostics.bench.derived_secret import shuffled
from diagnostics.bench.question import PublishedRecords, Question, Ranking, Words
from diagnostics.records.state_classes import HEALTHY, SHAM
from diagnostics.scoring.detect import DETECT, EVERY, LEAK
from siggen.dataset.reading import Dataset
from siggen.errors import counted

RULES = """* One number for each record of the split `test`: `damage`, which rises with damage. Columns of other
  tasks may stand beside it.
* **Alone**, on the parts that end with `_alone`: a gearbox has one record there, which is judged by itself.
* **Beside**, on the others: the gearbox's record of the split `train`, which is healthy, may be used too; the
  predictions have a column `reference` that is true. Other records of the part may not be used.
* Learn and choose on `learn` alone. Nothing is learned from test parts."""


_TOLD = "The split `train` has one healthy record of each gearbox ({}), told as a reference"


def part_card(title: str, name: str, rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the card of a test part."""
    tests = sum(row["split"] == "test" for row in rows)
    told = len(rows) - tests
    given = "A gearbox has one record, and no reference" if is_alone(name) else _TOLD.format(told)
    return f"""# {title}, test part {name}

{counted(tests, "record")} without labels in the split `test`. {given}.
`state` and all that follows from it say `unknown`, or NaN. Numbers of records and
gearboxes were drawn; order and files tell nothing. `config.yaml` is that of the part to learn from; the seed of this
part is secret until labels are revealed.
"""


def shown_records(dataset: Dataset, secret: bytes, name: str) -> PublishedRecords:
    """Return all records; one healthy one of every gearbox and operating point is told, drawn by lot.

    Of a part that is judged alone one record of every gearbox, and none is told.
    """
    rows = dataset.labels().to_pylist()
    if is_alone(name):
        chosen = frozenset(_one_of_each(rows, secret, name))
        return PublishedRecords(dict.fromkeys(chosen, 1), frozenset(), chosen)
    every = frozenset(row["record_id"] for row in rows)
    told = frozenset(_references(rows, secret, name))
    return PublishedRecords({one: int(one not in told) for one in every}, told, every - told)


def _one_of_each(rows: list[dict[str, Any]], secret: bytes, name: str) -> Iterator[int]:
    """Yield a record of every gearbox by lot: without and with damage in turn, and of each the states in turn."""
    sides: list[dict[int, list[str]]] = [{}, {}]
    known: dict[tuple[int, str], list[int]] = {}
    for row in rows:
        sides[row["fault"] != HEALTHY].setdefault(row["state_id"], []).append(row["state"])
        known.setdefault((row["specimen_id"], row["state"]), []).append(row["record_id"])
    states = [[side[one][0] for one in shuffled(secret, f"states/{name}", side)] for side in sides]
    for place, gearbox in enumerate(shuffled(secret, f"shown/{name}", {row["specimen_id"] for row in rows})):
        own = states[place % 2] or states[1 - place % 2]
        first = place // 2 % len(own)
        held = next(known[gearbox, one] for one in own[first:] + own[:first] if (gearbox, one) in known)
        yield shuffled(secret, f"records of {gearbox}/{name}", held)[0]


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
    parts=with_alone,
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
