"""Check of a whole set before features, classifiers or an audit: which records they cannot take, and the way out.

The channels of a set that are asked for by name.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Sequence

import numpy as np

from diagnostics.records.record_problems import LARGEST_CLIPPED_SHARE, PROBLEMS_SHOWN, varies, whole_record_problem
from diagnostics.records.recording import Recording
from diagnostics.records.state_classes import HEALTHY
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError

RECORDS_SHOWN = 3
CLIPPED = f"is clipped in more than {LARGEST_CLIPPED_SHARE:.1%} of the samples"
CLIPPED_RECORDS = 0.05
"""Share of clipped records of a channel up to which they are noted, not refused: single ones clip in real sets too."""


def with_channels(dataset: Dataset, names: Sequence[str]) -> Dataset:
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


def of_quantity(dataset: Dataset, quantity: str | None) -> Dataset:
    """Return the set with the channels that hold a quantity, such as "acceleration"; all where None is asked for.

    Raises
    ------
    UsageError
        If no channel holds it.
    """
    if quantity is None:
        return dataset
    held = {channel.name: channel.quantity for channel in dataset.channels}
    if quantity not in held.values():
        has = ", ".join(dict.fromkeys(held.values()))
        raise UsageError(f"quantity: received {quantity!r}; channels of {dataset.path} hold {has}. Name one of these")
    return with_channels(dataset, [name for name, what in held.items() if what == quantity])


class RecordCheck:
    """Collects what is wrong with the records of a set, one after the other, and refuses them together."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, str], list[int]] = {}
        self._clipped: dict[str, list[int]] = {}
        self._count = 0

    def add(self, number: int, refused: Iterable[tuple[str, str]], clipped: Iterable[str]) -> None:
        """Remember what is wrong with a record: `refused_parts`, `clipped_channels`.

        Clipping alone is judged over the whole set.
        """
        self._count += 1
        for key in refused:
            self._found.setdefault(key, []).append(number)
        for name in clipped:
            self._clipped.setdefault(name, []).append(number)

    def finish(self, dataset: Dataset, *, can_leave_channels: bool = False) -> tuple[str, ...]:
        """Return notes on single clipped records, which are used all the same.

        Raises
        ------
        DatasetError
            Naming channels, records and what to do, if some cannot be used or a channel is clipped throughout.
        """
        found = dict(self._found)
        for name, records in self._clipped.items():
            if len(records) > CLIPPED_RECORDS * self._count:
                found[name, f"{CLIPPED} (`range_m_s2` of an accelerometer is too narrow)"] = records
        if found:
            raise DatasetError(_refusal(dataset, found, can_leave_channels))
        return tuple(f"channel {name} {CLIPPED} in {_shown(records)}" for name, records in self._clipped.items())


def check_states(dataset: Dataset) -> None:
    """Check that a set has healthy and damaged records to compare.

    Raises
    ------
    DatasetError
        If one kind is missing.
    """
    labels = dataset.labels(columns=["fault", "state"])
    healthy = [fault == HEALTHY for fault in labels.column("fault").to_pylist()]
    if any(healthy) and not all(healthy):
        return
    states = ", ".join(sorted(set(labels.column("state").to_pylist()))) or "no records"
    missing = "damaged" if any(healthy) else "healthy"
    raise DatasetError(
        f"{dataset.path}: no {missing} records to rank indicators with; received the states {states}. Add a {missing} "
        "state under `states` in the configuration and generate the set into a new folder; `siggen-diagnostics "
        "indicators --out FILE.parquet` writes the values alone."
    )


def refused_parts(record: Recording, *, needs_tacho: bool = True) -> list[tuple[str, str]]:
    """Return (channel, what is wrong) of what cannot be used at all; an empty channel means the whole record."""
    whole = whole_record_problem(record, needs_tacho=needs_tacho, gear_turns=False)
    if whole:
        return [("", whole)]
    return [(name, text) for name, signal in record.channels.items() if (text := _channel_problem(signal))]


def _channel_problem(signal: np.ndarray) -> str:
    if not np.isfinite(signal).all():
        return "holds values that are not finite"
    return "" if varies(signal) else "is constant"


def _refusal(dataset: Dataset, found: dict[tuple[str, str], list[int]], can_leave_channels: bool) -> str:
    lines = [
        f"  channel {channel} {text} in {_shown(records)}" if channel else f"  {_shown(records)}: {text}"
        for (channel, text), records in found.items()
    ]
    rest = len(lines) - PROBLEMS_SHOWN
    more = [f"  and {rest} more"] if rest > 0 else []
    return "\n".join(
        [
            f"{dataset.path}: records that cannot be used",
            *lines[:PROBLEMS_SHOWN],
            *more,
            _way_out(dataset, found, can_leave_channels),
        ]
    )


def _way_out(dataset: Dataset, found: dict[tuple[str, str], list[int]], can_leave_channels: bool) -> str:
    broken = {channel for channel, _ in found}
    usable = [channel.name for channel in dataset.channels if channel.name not in broken]
    if can_leave_channels and usable and "" not in broken:
        return f"Leave the channel out: siggen-diagnostics report {' '.join(f'--channel {name}' for name in usable)}"
    return (
        f"`siggen verify {dataset.path}` tells whether files were changed; else mend the set's config.yaml and "
        "generate it into a new folder. `siggen-diagnostics indicators --leave-out` does without such records."
    )


def _shown(records: list[int]) -> str:
    more = " ..." if len(records) > RECORDS_SHOWN else ""
    listed = ", ".join(str(number) for number in records[:RECORDS_SHOWN])
    return f"{len(records)} record(s) ({listed}{more})"
