"""Which records a page shows, and which healthy record each is laid over.

What a set does not give to the page, and how it would.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnostics.page.wording import counted
from diagnostics.records.state_classes import HEALTHY


def missing_parts(
    labels: Mapping[str, np.ndarray],
    overlaid: Sequence[int | None],
    damaged_flanks: bool,
    internals: bool,
    *,
    named: bool,
) -> list[str]:
    """Return sentences on what is missing; none for a set that has everything."""
    healthy = labels["fault"] == HEALTHY
    alone = sum(other is None for other in overlaid)
    found = []
    if not healthy.any():
        found.append(
            "No healthy records: no overlay, no difference, and no place of an indicator among healthy gearboxes. A "
            "state without damage under “states” in the configuration gives them."
        )
    elif alone:
        found.append(
            f"{counted(alone, 'record')} of {healthy.size} without another healthy record of the same gearbox at the "
            "same operating point: these have no overlay. More “repeats” give healthy records a second one."
        )
    if healthy.any() and np.unique(labels["specimen_id"][healthy]).size < 2:
        found.append("Healthy records of one gearbox only: an indicator has no place among other healthy gearboxes.")
    if not damaged_flanks:
        found.append("No table of damage beside the labels, or no damaged record: no flank is drawn.")
    if not internals:
        found.append(
            "Neither transmission error nor mesh force in the set: quantities that no sensor sees are not there to "
            "show. “internals” in the configuration stores them."
        )
    if not named:
        found.append(
            "No model: the page does not say what a classifier names each record. `siggen-diagnostics explore --model` "
            "takes the folder that `report` wrote."
        )
    return found


def chosen_records(labels: Mapping[str, np.ndarray], limit: int, first: Sequence[int] = ()) -> np.ndarray:
    """Return the rows of whole gearboxes, spread evenly over the set, that stay within the limit.

    Of a set whose first gearbox alone has more records, rows spread evenly over it come back.

    Parameters
    ----------
    labels : mapping of str to (records,)
        Column `specimen_id`.
    limit : int
        Most records.
    first : sequence of int
        Gearboxes that come before all others, in this order, as far as the limit allows.
    """
    specimens, counts = np.unique(labels["specimen_id"], return_counts=True)
    if labels["specimen_id"].size <= limit:
        return np.arange(labels["specimen_id"].size)
    size = dict(zip(specimens.tolist(), counts.tolist(), strict=True))
    kept = _first_within([number for number in dict.fromkeys(first) if number in size], size, limit)
    rest = np.array([number for number in specimens.tolist() if number not in kept])
    left = limit - sum(size[number] for number in kept)
    for wanted in range(rest.size, -1, -1):
        place = np.unique(np.linspace(0, rest.size - 1, wanted).round().astype(np.int64))
        found = [*kept, *rest[place].tolist()]
        if found and sum(size[number] for number in rest[place].tolist()) <= left:
            return np.flatnonzero(np.isin(labels["specimen_id"], found))
    rows = np.flatnonzero(labels["specimen_id"] == specimens[0])
    return np.asarray(rows[np.unique(np.linspace(0, rows.size - 1, limit).round().astype(np.int64))])


def _first_within(wanted: Sequence[int], size: Mapping[int, int], limit: int) -> list[int]:
    """Return the gearboxes, in order, until the next would exceed the limit."""
    total = np.cumsum([size[number] for number in wanted])
    return [number for number, records in zip(wanted, total, strict=True) if records <= limit]


def overlaid_records(labels: Mapping[str, np.ndarray]) -> list[int | None]:
    """Return for every row the row of its gearbox's healthy record, None where there is no other than itself.

    Same gearbox and operating point; the same repeat if there is one, for a healthy record another repeat.
    """
    healthy = labels["fault"] == HEALTHY
    found: list[int | None] = []
    for row in range(healthy.size):
        same = healthy & (labels["specimen_id"] == labels["specimen_id"][row])
        same &= labels["operating_point_id"] == labels["operating_point_id"][row]
        same[row] = False
        rows = np.flatnonzero(same)
        nearest = rows[np.argsort(labels["repeat"][rows] != labels["repeat"][row], kind="stable")]
        found.append(int(nearest[0]) if nearest.size else None)
    return found
