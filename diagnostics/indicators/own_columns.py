"""Columns of the user's own indicators over the records of a set."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from diagnostics.indicators.own_indicator import Gears, OwnIndicator, registered
from diagnostics.indicators.workers import mapped
from diagnostics.records.record_problems import RecordProblem
from diagnostics.records.recording import Recording, recordings
from siggen.dataset.reading import Dataset
from siggen.errors import UsageError

Found = tuple[dict[str, float], list[RecordProblem]]


def all_own(own: Sequence[OwnIndicator]) -> tuple[OwnIndicator, ...]:
    """Return the registered indicators and these.

    Raises
    ------
    UsageError
        If two have one name.
    """
    found = (*registered(), *own)
    names = [indicator.name for indicator in found]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise UsageError(f"indicators: the names {twice} came twice; rename one function of each pair")
    return found


def own_columns(
    dataset: Dataset,
    own: Sequence[OwnIndicator],
    pulses_s: Sequence[np.ndarray],
    refused: Sequence[Sequence[tuple[str, str]]],
    *,
    workers: int = 1,
    advance: Callable[[], None] | None = None,
) -> tuple[dict[str, np.ndarray], list[RecordProblem]]:
    """Return the user's indicators by column, (records,) each, undefined where they fail, and how they failed.

    Parameters
    ----------
    dataset : siggen Dataset
        The set.
    own : sequence of OwnIndicator
        All of them, each name once.
    pulses_s : sequence of (k,) float64
        Pulse times of every record.
    refused : sequence of sequence of (str, str)
        What cannot be used of every record: channel (empty: all of them) and why.
    workers : int
        Processes.
    advance : callable, optional
        Called after every record.
    """
    if not own:
        return {}, []
    if workers > 1:
        _check_sendable(own)
    rows, problems = [], []
    for values, failed in mapped(_usable(dataset, pulses_s, refused), partial(own_values, tuple(own)), workers):
        rows.append(values)
        problems += failed
        if advance:
            advance()
    names = [f"{indicator.name}__{channel.name}" for channel in dataset.channels for indicator in own]
    return {name: np.array([row.get(name, math.nan) for row in rows]) for name in names}, problems


def _usable(
    dataset: Dataset, pulses_s: Sequence[np.ndarray], refused: Sequence[Sequence[tuple[str, str]]]
) -> Iterator[Recording]:
    """Yield the records with the channels that can be used and the pulses that their angles come from."""
    for record, pulses, parts in zip(recordings(dataset), pulses_s, refused, strict=True):
        lost = {channel for channel, _ in parts}
        kept = {} if "" in lost else {name: s for name, s in record.channels.items() if name not in lost}
        yield replace(record, channels=kept, tacho_s=pulses)


def own_values(own: Sequence[OwnIndicator], record: Recording) -> Found:
    """Return the user's indicators of one record by column, and how they failed."""
    values: dict[str, float] = {}
    failed: list[RecordProblem] = []
    for channel, signal in record.channels.items():
        for indicator in own:
            name = f"{indicator.name}__{channel}"
            try:
                values[name] = indicator.value(np.asarray(signal, np.float64), record.tacho_s, _gears(record))
            except UsageError as error:
                values[name] = math.nan
                failed.append(RecordProblem(int(record.labels["record_id"]), channel, str(error)))
    return values, failed


def _gears(record: Recording) -> Gears:
    labels = record.labels
    teeth = int(labels["teeth_pinion"]), int(labels["teeth_gear"])
    return Gears(*teeth, record.fs_hz, float(labels["speed_hz"]), float(labels["torque_nm"]))


def _check_sendable(own: Sequence[OwnIndicator]) -> None:
    """Check that other processes can take the user's functions: they go there by module and name."""
    for indicator in own:
        try:
            pickle.dumps(indicator)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise UsageError(
                f"indicator {indicator.name!r} cannot go to other processes ({error}). Define it with `def` at the top "
                "of its module, or give --workers 1."
            ) from error
