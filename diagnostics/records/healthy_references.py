"""Which healthy records of the same gearbox a record is compared with, so that the choice itself tells nothing."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from diagnostics.records.state_classes import HEALTHY

PLACE = ("specimen_id", "operating_point_id", "repeat")
"""Where a damaged record has its healthy twin."""


def healthy_references(labels: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Return the rows that every record refers to: its specimen's healthy records but one; empty where there is none.

    A healthy record leaves itself out. A damaged one leaves out the first healthy record at its operating point and
    repeat, its twin, so that neither number nor nearness of the references tells the states apart. A damaged record
    without a twin has no reference: its references would stand farther away than those of any healthy record.

    Parameters
    ----------
    labels : mapping of str to (records,)
        Columns `specimen_id`, `fault`, `operating_point_id`, `repeat`, `state_id`, `record_id`.
    """
    healthy = labels["fault"] == HEALTHY
    order = np.lexsort((labels["record_id"], labels["state_id"]))
    own: dict[int, list[int]] = {}
    twin: dict[tuple[int, ...], int] = {}
    places = list(zip(*(labels[name].tolist() for name in PLACE), strict=True))
    for row in order[healthy[order]].tolist():
        own.setdefault(places[row][0], []).append(row)
        twin.setdefault(places[row], row)
    found = []
    for row, place in enumerate(places):
        left_out = row if healthy[row] else twin.get(place)
        rows = [] if left_out is None else [other for other in own[place[0]] if other != left_out]
        found.append(np.array(rows, dtype=np.int64))
    return found
