"""NA4, NA4* and NB4 of a whole set: the states of one specimen, in order of severity, are the history of a machine.

A history is one specimen at one operating point, repeat and channel; its records stand in order of damaged area, then
of the state's place in the configuration. So these indicators know the healthy level of their own specimen, which the
others do not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from diagnostics.indicators.na4 import na4_of_moments
from diagnostics.records.state_classes import HEALTHY

SHAFTS = ("pinion", "gear")


def histories(labels: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Return the rows of each history in order.

    Parameters
    ----------
    labels : mapping of str to (n,)
        Columns `specimen_id`, `operating_point_id`, `repeat`, `damaged_area_mm2`, `state_id`.
    """
    owner = np.stack([labels[name] for name in ("specimen_id", "operating_point_id", "repeat")], axis=1)
    order = np.lexsort((labels["state_id"], labels["damaged_area_mm2"]))
    _, group = np.unique(owner, axis=0, return_inverse=True)
    group = group.reshape(-1)[order]
    return [order[group == number] for number in range(int(group.max()) + 1)]


def history_indicators(
    labels: Mapping[str, np.ndarray], moments: Sequence[Mapping[str, float]], channel: str
) -> dict[str, np.ndarray]:
    """Return NA4, NA4* and NB4 of both shafts in one channel, (n,) each by column.

    Parameters
    ----------
    labels : mapping of str to (n,)
        As of `histories`, and `fault`.
    moments : sequence of mapping
        What `channel_indicators` returned for each record, in the order of the labels.
    channel : str
        Name of the channel.
    """
    count = len(moments)
    columns = {
        f"{name}_{shaft}__{channel}": np.full(count, np.nan) for name in ("na4", "na4_star", "nb4") for shaft in SHAFTS
    }
    for rows in histories(labels):
        records = [moments[row] for row in rows]
        healthy = labels["fault"][rows] == HEALTHY
        for shaft in SHAFTS:
            for name, values in _one_history(records, healthy, shaft).items():
                columns[f"{name}_{shaft}__{channel}"][rows] = values
    return columns


def _one_history(records: Sequence[Mapping[str, float]], healthy: np.ndarray, shaft: str) -> dict[str, list[float]]:
    """Return the indicators of one shaft over one history; NaN from an unusable record on."""
    fourth = [record.get(f"residual_fourth_{shaft}", np.nan) for record in records]
    second = np.array([record.get(f"residual_second_{shaft}", np.nan) for record in records])
    dominant = records[0].get(f"dominant_{shaft}", np.nan)
    which = f"{shaft}_h{int(dominant)}" if np.isfinite(dominant) else "none"
    envelope_fourth = [record.get(f"envelope_fourth_{which}", np.nan) for record in records]
    envelope_second = np.array([record.get(f"envelope_second_{which}", np.nan) for record in records])
    steps = range(len(records))
    return {
        "na4": [na4_of_moments(fourth[i], second[: i + 1].tolist()) for i in steps],
        "na4_star": [na4_of_moments(fourth[i], second[: i + 1][healthy[: i + 1]].tolist()) for i in steps],
        "nb4": [na4_of_moments(envelope_fourth[i], envelope_second[: i + 1].tolist()) for i in steps],
    }
