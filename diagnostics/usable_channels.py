"""Channels that a classifier can take: chosen by name, finite, and not constant."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa

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


def check_channels(table: pa.Table, dataset: Any) -> None:
    """Check by a feature table that every channel of every record has finite values that vary.

    Raises
    ------
    DatasetError
        Naming channels, records and the way to leave a channel out.
    """
    found = {channel.name: _problem(table, channel.name) for channel in dataset.channels}
    problems = {name: text for name, text in found.items() if text}
    if not problems:
        return
    usable = [name for name in found if name not in problems]
    listed = "; ".join(f"channel {name} {text}" for name, text in problems.items())
    way_out = (
        f"Leave it out: {' '.join(f'--channel {name}' for name in usable)}"
        if usable
        else "Check the sensors, their range and gain in the set's config.yaml, and generate the set again"
    )
    raise DatasetError(f"{dataset.path}: {listed}; classifiers need signals that vary. {way_out}.")


def _problem(table: pa.Table, channel: str) -> str:
    """Return what is wrong with a channel, or an empty text; kurtosis is undefined exactly where nothing varies."""
    level, shape = (
        table.column(f"{name}__{channel}").to_numpy(zero_copy_only=False).astype(np.float64)
        for name in ("rms", "kurtosis")
    )
    broken, constant = ~np.isfinite(level), np.isfinite(level) & ~np.isfinite(shape)
    for mask, text in ((broken, "holds values that are not finite"), (constant, "is constant")):
        if mask.any():
            record = table.column("record_id").to_numpy()[mask]
            shown = ", ".join(str(number) for number in record[:RECORDS_SHOWN])
            return f"{text} in {record.size} of {mask.size} records (record {shown}{' ...' if record.size > 3 else ''})"
    return ""
