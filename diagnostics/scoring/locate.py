"""Task `locate`: on which gear, and on which tooth, a damaged record has its damage.

Right is any tooth that is damaged. A damage of all teeth of a gear is right at every tooth of it; damage that is on no
gear is not asked about.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from diagnostics.scoring.task import Columns, Measure, Problem, Taken, Task, weighted_mean
from diagnostics.scoring.truth import Truth
from siggen.dataset.reading import Dataset

GEAR, TOOTH = "gear", "tooth"
ALL_TEETH = -1
DAMAGED_TEETH = "damaged_teeth"
ON_TEETH = "damage on teeth"


def _facts(dataset: Dataset, truth: Truth) -> dict[str, np.ndarray]:
    """Return the damaged teeth of every record: a tuple of (gear's place, tooth)."""
    table, place = dataset.damage(truth.split), {gear: k for k, gear in enumerate(truth.gears)}
    columns = [table.column(name).to_pylist() for name in ("record_id", GEAR, TOOTH)]
    damaged = set(truth.record_id[truth.damaged].tolist())
    found: dict[int, set[tuple[int, int]]] = {}
    for record, gear, tooth in zip(*columns, strict=True):
        if record in damaged and gear in place:  # rows of a sham say where nothing was removed
            found.setdefault(record, set()).add((place[gear], tooth))
    teeth = np.empty(truth.record_id.size, dtype=object)
    teeth[:] = [tuple(sorted(found.get(record, ()))) for record in truth.record_id.tolist()]
    return {DAMAGED_TEETH: teeth}


def _answers(columns: Columns, truth: Truth) -> np.ndarray | None:
    """Return whether gear and tooth are right, (n, 2) float64."""
    if GEAR not in columns or TOOTH not in columns or DAMAGED_TEETH not in truth.facts:
        return None
    rows = zip(truth.facts[DAMAGED_TEETH], columns[GEAR].tolist(), columns[TOOTH].tolist(), strict=True)
    right = [
        (any(on == gear for on, _ in teeth), any(on == gear and at in (tooth, ALL_TEETH) for on, at in teeth))
        for teeth, gear, tooth in rows
    ]
    return np.array(right, dtype=np.float64).reshape(-1, 2)


def _parts(truth: Truth) -> dict[str, np.ndarray]:
    teeth = truth.facts.get(DAMAGED_TEETH, np.empty(0, dtype=object))
    known = np.array([len(one) > 0 for one in teeth], dtype=bool)
    return {ON_TEETH: known} if known.any() else {}


def _problems(columns: Columns, truth: Truth) -> Iterator[Problem]:
    nowhere = np.zeros(truth.record_id.size, dtype=bool)
    for one, other in ((GEAR, TOOTH), (TOOTH, GEAR)):
        if one in columns and other not in columns:
            yield f"no column {other}", nowhere, f"{GEAR} and {TOOTH} together"
    if GEAR in columns and TOOTH in columns:
        teeth = np.stack([*truth.gears.values()], axis=1)
        gear = np.maximum(columns[GEAR], 0)
        bad = (columns[GEAR] >= 0) & (columns[TOOTH] >= teeth[np.arange(gear.size), gear])
        if bad.any():
            yield f"{TOOTH} is {columns[TOOTH][bad][0]:g}", bad, "0 to the gear's number of teeth - 1"


def _chance_of_gear(truth: Truth) -> float:
    """Return what naming any gear by lot reaches."""
    on = [len({gear for gear, _ in teeth}) for teeth in truth.facts[DAMAGED_TEETH]]
    return float(np.mean(on)) / len(truth.gears)


def _chance_of_tooth(truth: Truth) -> float:
    """Return what naming any gear and any of its teeth by lot reaches."""
    teeth = np.stack([*truth.gears.values()], axis=1)
    shares = [
        sum(1.0 if tooth == ALL_TEETH else 1.0 / teeth[row, gear] for gear, tooth in damaged)
        for row, damaged in enumerate(truth.facts[DAMAGED_TEETH])
    ]
    return float(np.mean(shares)) / len(truth.gears)


LOCATE = Task(
    "locate",
    f"{GEAR} (its name) and {TOOTH} (its index, from 0)",
    lambda truth: (
        Taken(GEAR, "a gear of the set", places={name: k for k, name in enumerate(truth.gears)}),
        Taken(TOOTH, "an index from 0", low=0.0, whole=True),
    ),
    _answers,
    _parts,
    (
        Measure(
            "share of right gears",
            lambda answers, _, weights: weighted_mean(answers[:, 0], weights),
            _chance_of_gear,
        ),
        Measure(
            "share of right teeth",
            lambda answers, _, weights: weighted_mean(answers[:, 1], weights),
            _chance_of_tooth,
        ),
    ),
    facts=_facts,
    problems=_problems,
)
