"""Channels that a classifier can take: chosen by name, finite, and not constant."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

import numpy as np

from diagnostics.recording import recordings
from siggen.errors import DatasetError, UsageError

RECORDS_SHOWN = 3


def with_channels(dataset: Any, names: Sequence[str]) -> Any:
    """Return the set with the named channels only, in the set's order; all where none is named.

    Raises
    ------
    UsageError
        If the set has no channel of a name.
    """
    known = [channel.name for channel in dataset.channels]
    if unknown := [name for name in names if name not in known]:
        raise UsageError(f"--channel: received {', '.join(unknown)}; {dataset.path} has {', '.join(known)}")
    if not names:
        return dataset
    chosen = tuple(channel for channel in dataset.channels if channel.name in names)
    view = copy.copy(dataset)
    try:
        view.channels = chosen
    except AttributeError:  # a set whose channels are derived takes them from a class of its own
        view.__class__ = type("ChosenChannels", (type(dataset),), {"channels": chosen})
    return view


def check_channels(dataset: Any) -> None:
    """Check that every channel of every record has finite values that vary.

    Raises
    ------
    DatasetError
        Naming channels, records and the way to leave a channel out.
    """
    found: dict[tuple[str, str], list[int]] = {}
    for record in recordings(dataset):
        for name, signal in record.channels.items():
            if problem := _problem(signal):
                found.setdefault((name, problem), []).append(int(record.labels["record_id"]))
    if not found:
        return
    broken = {name for name, _ in found}
    usable = [channel.name for channel in dataset.channels if channel.name not in broken]
    listed = "; ".join(f"channel {name} {problem} in {_shown(records)}" for (name, problem), records in found.items())
    way_out = (
        f"Leave it out: {' '.join(f'--channel {name}' for name in usable)}"
        if usable
        else "Check the sensors, their range and gain in the set's config.yaml, and generate the set again"
    )
    raise DatasetError(f"{dataset.path}: {listed}; classifiers need signals that vary. {way_out}.")


def _problem(signal: np.ndarray) -> str:
    """Return what is wrong with a signal, or an empty text."""
    if not np.isfinite(signal).all():
        return "holds values that are not finite"
    return "" if (signal != signal[0]).any() else "is constant"


def _shown(records: list[int]) -> str:
    more = " ..." if len(records) > RECORDS_SHOWN else ""
    return f"{len(records)} record(s) ({', '.join(str(number) for number in records[:RECORDS_SHOWN])}{more})"
