"""Precision of a finished set: some of its records integrated again, finely and by another method.

The reference is the classical Runge-Kutta method under the same law, with the same draws, started nine decay times
before. Its steps are halved, record by record, until two of them agree to a tenth of the tolerance. Compared is what
reaches the converter, noise included: the relative rms difference of a channel; the worst channel of a record counts.
The converter itself is left out of both: it rounds two signals that differ by less than its step to different codes now
and then, which is 1e-3 of a quiet record with 16 bits however fine the steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import asdict, dataclass
from itertools import zip_longest
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import numpy as np

from siggen.columns.record import ChannelColumn
from siggen.dataset.manifest import PHYSICS, read_manifest
from siggen.dataset.reading import Dataset, as_record
from siggen.dataset.seal import sealed
from siggen.dataset.storage import LocalFolder
from siggen.errors import DatasetError
from siggen.gearbox.design import SetDesign
from siggen.sensors.quantity import ACCELERATION, STILL_M_S2
from siggen.sets import physics as contents
from siggen.sets.verification import OneRecord, design_of_set, why_not_again
from siggen.workers.choice import workers_of
from siggen.workers.tasks import Workers, results

FIRST_STEPS, MOST_STEPS = 16, 512
"""Per sample, of the first two references and of the last one."""
AGREEING = 0.1
"""Of the tolerance: what two references may differ by."""
LABEL = "integration_error"
LABEL_OF = "integration_error_of"


@dataclass(frozen=True, slots=True)
class StatePrecision:
    """Errors of the records of one state: how many, and the median and largest of their worst channels."""

    state: str
    records: int
    median: float
    largest: float


@dataclass(frozen=True, slots=True)
class Precision:
    """What was found, by state in the order of the configuration.

    Attributes
    ----------
    records
        Ids of the records that were integrated again, ascending.
    reference
        Its method, and the steps per sample that the hardest record took.
    apart
        How far the last two references of a record differ at most: no error is known better.
    told
        How many errors are above the tolerance, with a label of the record that says so.
    untold
        How many are, with a label that does not, or without one.
    tolerance
        What the set states; None where its integrator states none.
    """

    identity: str
    records: tuple[int, ...]
    reference: str
    apart: float
    told: int
    untold: int
    tolerance: float | None
    states: tuple[StatePrecision, ...]

    @property
    def largest(self) -> float:
        """The largest error of all records."""
        return max(found.largest for found in self.states)

    @property
    def within(self) -> bool:
        """Whether every record meets the tolerance or has a label that says that it does not, or none is stated."""
        return self.tolerance is None or self.untold == 0


def measure_precision(
    path: Path | str,
    count: int,
    show: Callable[[int, int], None] | None = None,
    *,
    workers: int | None = None,
    executor: Executor | str | None = None,
) -> Precision:
    """Integrate `count` records of a finished set again, compare, and keep the result in its physics.json.

    Records are spread over all states; which ones follows from the identity. No other file of the set changes, and
    neither identity nor manifest know of the result.

    Parameters
    ----------
    path : path
    count : int
        At least 1.
    show : callable, optional
        Receives records done and their number.
    workers, executor
        As for `verify`.

    Raises
    ------
    DatasetError
        If there is no finished set, another version of the simulation made it, a record fails now, or the disk takes no
        more.
    ConfigError
        If this version reads its configuration otherwise.
    """
    if count < 1:
        raise ValueError(f"count: received {count}; allowed: at least 1")
    storage = LocalFolder(path)
    manifest = read_manifest(storage)
    if reason := why_not_again(manifest, count):
        raise DatasetError(f"{storage.location}: {reason}")
    dataset, design = Dataset(storage), design_of_set(storage, manifest)
    chosen = chosen_records(dataset, design.state_names, count)
    ids = sorted(chosen)
    own = workers_of(executor, 0 if executor is None and workers is None else workers)
    delivered = dict(_again(own, design.unrounded(), ids))
    compared = []
    for done, fine in enumerate(_references(own, design.unrounded(), ids, dataset.channels), start=1):
        compared.append(_compared(dataset.channels, chosen[fine.record_id], delivered.pop(fine.record_id), fine))
        if show is not None:
            show(done, len(ids))
    found = _found(design, ids, compared)
    with storage.writing():
        storage.put(PHYSICS, sealed({**asdict(found), "largest": found.largest, "within": found.within}))
    return found


class _Reference(NamedTuple):
    """A record by the reference, its steps per sample, and how far it is from that with half of them."""

    record_id: int
    record: Mapping[str, Any]
    steps: int
    apart: float


class _Compared(NamedTuple):
    """The error of a record and what its label says, not a number without one."""

    state: str
    error: float
    label: float
    steps: int
    apart: float


def _references(
    workers: Workers, design: SetDesign, ids: Sequence[int], channels: Sequence[ChannelColumn]
) -> Iterator[_Reference]:
    """Yield every record by a reference that agrees with one of half the steps, or by the finest."""
    steps, left = FIRST_STEPS, list(ids)
    coarse = dict(_again(workers, design.by_reference(steps), left))
    agreeing = AGREEING * design.integration_tolerance
    while left:
        steps *= 2
        done = set()
        for record_id, fine in _again(workers, design.by_reference(steps), left):
            apart = record_error(channels, coarse[record_id], fine)
            coarse[record_id] = fine
            if apart <= agreeing or steps >= MOST_STEPS:
                done.add(record_id)
                yield _Reference(record_id, coarse.pop(record_id), steps, apart)
        left = [record_id for record_id in left if record_id not in done]


def _compared(
    channels: Sequence[ChannelColumn], state: str, delivered: Mapping[str, Any], fine: _Reference
) -> _Compared:
    rattles = delivered.get(LABEL_OF) == "levels"  # samples that depend on every rounding
    label = np.inf if rattles else float(delivered.get(LABEL, np.nan))
    return _Compared(state, record_error(channels, delivered, fine.record), label, fine.steps, fine.apart)


def _found(design: SetDesign, ids: Sequence[int], compared: Sequence[_Compared]) -> Precision:
    """Return what was found of the records of a set."""
    tolerance = design.tolerance
    above = [] if tolerance is None else [one for one in compared if not one.error <= tolerance]
    told = sum(tolerance is not None and one.label > tolerance for one in above)
    errors = {state: [one.error for one in compared if one.state == state] for state in design.state_names}
    reference = f"runge_kutta, up to {max(one.steps for one in compared)} steps per sample"
    apart = max(one.apart for one in compared)
    return Precision(
        design.identity, tuple(ids), reference, apart, told, len(above) - told, tolerance, _by_state(errors)
    )


def _again(workers: Workers, design: SetDesign, ids: Sequence[int]) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Yield record after record of a configuration, as they are done."""
    tasks = [OneRecord((record_id,)) for record_id in ids]
    with closing(results(workers, contents.physics().simulation(design), tasks)) as answers:
        for index, result in answers:
            if result.failures:
                failure = result.failures[0]
                method = f"{design.method}, {design.steps_per_sample} steps per sample"
                raise DatasetError(f"record {ids[index]} fails with {method}: {failure.status} ({failure.reason})")
            yield ids[index], as_record(result.rows)


def chosen_records(dataset: Dataset, states: Sequence[str], count: int) -> dict[int, str]:
    """Return id -> state of records spread evenly over all states, in an order that follows from the identity."""
    labels = dataset.labels(columns=["record_id", "state"])
    pairs = sorted(zip(labels["record_id"].to_pylist(), labels["state"].to_pylist(), strict=True))
    Random(dataset.inventory.identity).shuffle(pairs)
    by_state = [[pair for pair in pairs if pair[1] == state] for state in states]
    in_turn = [pair for turn in zip_longest(*by_state) for pair in turn if pair is not None]
    return dict(in_turn[:count])


def record_error(channels: Sequence[ChannelColumn], delivered: Mapping[str, Any], again: Mapping[str, Any]) -> float:
    """Return the relative rms difference of the worst channel; accelerations count as STILL_M_S2 at least."""
    worst = 0.0
    for channel in channels:
        wanted = again[channel.column].astype(float)
        least = STILL_M_S2**2 if channel.quantity == ACCELERATION.word else np.finfo(float).tiny
        apart = delivered[channel.column].astype(float) - wanted
        worst = max(worst, float(np.sqrt(np.mean(apart**2) / max(np.mean(wanted**2), least))))
    return worst


def _by_state(errors: Mapping[str, Sequence[float]]) -> tuple[StatePrecision, ...]:
    return tuple(
        StatePrecision(state, len(found), float(np.median(found)), max(found))
        for state, found in errors.items()
        if found
    )


def precision_lines(found: Precision) -> list[str]:
    """Return the table of errors by state."""
    width = max(len("state"), *(len(state.state) for state in found.states))
    stated = "none stated" if found.tolerance is None else f"tolerance {found.tolerance:g}"
    lines = [
        f"{len(found.records)} records integrated again ({found.reference}); "
        f"relative rms error of the delivered signals before the converter, worst channel ({stated}); "
        f"accelerations count as {STILL_M_S2:g} m/s^2 at least:"
    ]
    lines += [f"  {'state':<{width}}  records   median  largest"]
    lines += [f"  {s.state:<{width}}  {s.records:7d}  {s.median:7.1e}  {s.largest:7.1e}" for s in found.states]
    lines.append(f"references with half the step differ by {found.apart:.1e} at most")
    if found.told:
        lines.append(f"above the tolerance with a label that says so ({LABEL}): {found.told}")
    if not found.within:
        lines.append(f"above the tolerance: {found.largest:.1e}; allowed: {found.tolerance:g}")
    return lines
