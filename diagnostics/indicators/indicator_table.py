"""All indicators of every record and channel of a set, one row per record, in one pass by any number of workers.

Values do not depend on the number of workers: records are handed out in the order of the files and come back in it.
"""

from __future__ import annotations

import json
import math
import pickle
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import asdict, dataclass
from itertools import islice
from multiprocessing import get_context
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.indicators.channel_indicators import IndicatorSettings, channel_indicators
from diagnostics.indicators.feature_table import FeatureMatrix
from diagnostics.indicators.needed_duration import duration_advice
from diagnostics.indicators.own_indicator import Gears, OwnIndicator, registered
from diagnostics.indicators.state_history import history_indicators
from diagnostics.records.chosen_states import chosen_states
from diagnostics.records.record_problems import RecordProblem, problem_list, record_problems
from diagnostics.records.recording import LABEL_NAMES, Recording, recordings
from diagnostics.signal.order_domain import angle_grid
from diagnostics.signal.shaft_signals import record_shafts
from diagnostics.signal.tacholess_angle import mesh_ridge, tacholess_pulses
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError

SETTINGS_KEY = b"diagnostics.indicators"
CHUNK_RECORDS = 8
OPTIONAL_LABELS = ("damage_profile_length_mm", "damage_face_length_mm", "contact_length_loss_mm")


@dataclass(frozen=True, slots=True)
class RecordIndicators:
    """What one record gave: values by column with channel, moments by channel, revolutions, notes, problems."""

    labels: dict[str, Any]
    values: dict[str, float]
    moments: dict[str, dict[str, float]]
    revolutions: tuple[int, int]
    notes: str
    problems: list[RecordProblem]


@dataclass(frozen=True, slots=True)
class IndicatorTable:
    """Labels and indicators of all records.

    Attributes
    ----------
    matrix : FeatureMatrix
        Values (records, columns), NaN where undefined; labels of records, with sizes of damage and, where the set has
        them, `snr_<channel>_db`.
    channels : tuple of str
    revolutions : (records, 2) int
        Whole revolutions of pinion and gear that were averaged.
    notes : tuple of str
        Per record, what is undefined and why beyond the definitions.
    problems : tuple of RecordProblem
        Records or channels that were left out.
    settings : IndicatorSettings
    """

    matrix: FeatureMatrix
    channels: tuple[str, ...]
    revolutions: np.ndarray
    notes: tuple[str, ...]
    problems: tuple[RecordProblem, ...]
    settings: IndicatorSettings

    def arrow(self) -> pa.Table:
        """Return everything as one table, the settings in its metadata."""
        labels = {name: values.tolist() for name, values in self.matrix.labels.items()}
        values = dict(zip(self.matrix.names, self.matrix.values.T, strict=True))
        revolutions = {"revolutions_pinion": self.revolutions[:, 0], "revolutions_gear": self.revolutions[:, 1]}
        table = pa.table({**labels, **revolutions, "notes": list(self.notes), **values})
        return table.replace_schema_metadata({SETTINGS_KEY: json.dumps(asdict(self.settings)).encode()})


def indicator_table(
    dataset: Dataset,
    own: Sequence[OwnIndicator] = (),
    settings: IndicatorSettings | None = None,
    *,
    workers: int = 1,
    leave_out: bool = False,
    states: Sequence[str] = (),
    advance: Callable[[], None] | None = None,
) -> IndicatorTable:
    """Return all indicators of a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    own : sequence of OwnIndicator
        The user's, besides those that are registered.
    settings : IndicatorSettings, optional
        Default: `IndicatorSettings()`.
    workers : int
        Processes; 1 computes in this one.
    leave_out : bool
        Leave records and channels out that cannot be used, instead of stopping.
    states : sequence of str
        Damaged states to take besides the healthy ones; all where empty.
    advance : callable, optional
        Called after every record.

    Raises
    ------
    DatasetError
        If the set holds no records, or some cannot be used or make an own indicator fail and `leave_out` is not set.
    UsageError
        If two indicators have one name, or the set has no such state.
    """
    chosen = settings or IndicatorSettings()
    mine = _distinct((*registered(), *own))
    found: list[RecordIndicators] = []
    chunks = _chunks(recordings(dataset, states=chosen_states(dataset, states)), CHUNK_RECORDS)
    for results in _mapped(chunks, mine, chosen, workers):
        for result in results:
            found.append(result)
            if advance:
                advance()
        problems = [problem for result in results for problem in result.problems]
        if problems and not leave_out:
            raise DatasetError(
                f"{dataset.path}: {len(problems)} problems among the first {len(found)} records\n"
                f"{problem_list(problems)}\n"
                f"{duration_advice(dataset, chosen.frame_samples)}"
                "Mend them, or give --leave-out to do without these records and channels."
            )
    if not found:
        raise DatasetError(f"{dataset.path}: no records to take indicators of; received {list(dataset.splits)}")
    return _table(dataset, found, chosen)


def _distinct(own: tuple[OwnIndicator, ...]) -> tuple[OwnIndicator, ...]:
    names = [indicator.name for indicator in own]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise UsageError(f"indicators: the names {twice} came twice; rename one function of each pair")
    return own


def _check_sendable(own: tuple[OwnIndicator, ...]) -> None:
    """Check that other processes can take the user's functions: they go there by module and name."""
    for indicator in own:
        try:
            pickle.dumps(indicator)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise UsageError(
                f"indicator {indicator.name!r} cannot go to other processes ({error}). Define it with `def` at the top "
                "of its module, or give --workers 1."
            ) from error


def _chunks(records: Iterable[Recording], size: int) -> Iterator[list[Recording]]:
    iterator = iter(records)
    while chunk := list(islice(iterator, size)):
        yield chunk


def _mapped(
    chunks: Iterator[list[Recording]], own: tuple[OwnIndicator, ...], settings: IndicatorSettings, workers: int
) -> Iterator[list[RecordIndicators]]:
    """Yield the results of the chunks in their order, with at most two chunks per worker on the way."""
    if workers <= 1:
        for chunk in chunks:
            yield chunk_indicators(chunk, own, settings)
        return
    _check_sendable(own)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        waiting: deque[Future[list[RecordIndicators]]] = deque()
        try:
            for chunk in chunks:
                waiting.append(pool.submit(chunk_indicators, chunk, own, settings))
                if len(waiting) >= 2 * workers:
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for future in waiting:
                future.cancel()


def chunk_indicators(
    chunk: list[Recording], own: tuple[OwnIndicator, ...], settings: IndicatorSettings
) -> list[RecordIndicators]:
    """Return the indicators of several records; the unit of work of a process."""
    return [record_indicators(record, own, settings) for record in chunk]


def record_indicators(
    record: Recording, own: Sequence[OwnIndicator] = (), settings: IndicatorSettings | None = None
) -> RecordIndicators:
    """Return all indicators of one record but those with a history, for which it returns moments.

    Parameters
    ----------
    record : Recording
        Labels, channels and pulses.
    own : sequence of OwnIndicator
        The user's.
    settings : IndicatorSettings, optional
        Default: `IndicatorSettings()`.
    """
    chosen = settings or IndicatorSettings()
    problems = record_problems(record, chosen.frame_samples, needs_tacho=chosen.speed_range_hz is None)
    labels = dict(record.labels)
    if any(not problem.channel for problem in problems):
        return RecordIndicators(labels, {}, {}, (0, 0), "; ".join(problem.text for problem in problems), problems)
    bad = {problem.channel for problem in problems}
    good = {name: np.asarray(signal, dtype=np.float64) for name, signal in record.channels.items() if name not in bad}
    order = chosen.order_domain
    teeth = (int(labels["teeth_pinion"]), int(labels["teeth_gear"]))
    gears = Gears(*teeth, record.fs_hz, float(labels["speed_hz"]), float(labels["torque_nm"]))
    try:
        pulses = _pulses(record, good, teeth[0], chosen)
    except UsageError as error:
        lost = RecordProblem(int(labels["record_id"]), "", str(error))
        return RecordIndicators(labels, {}, {}, (0, 0), str(error), [*problems, lost])
    grid = angle_grid(pulses, teeth[0] * order.samples_per_tooth) if pulses.size > 1 else None
    shafts = record_shafts(grid, teeth, order.samples_per_tooth, order.sidebands)
    values: dict[str, float] = {}
    moments = {}
    for channel, signal in good.items():
        found = channel_indicators(signal, record.fs_hz, grid, shafts, chosen)
        mine, failed = _own_values(own, signal, pulses, gears)
        problems += [RecordProblem(int(labels["record_id"]), channel, text) for text in failed]
        values |= {f"{name}__{channel}": value for name, value in (found.values | mine).items()}
        moments[channel] = found.moments
    notes = [*(shaft.note for shaft in shafts if shaft.note), *(f"{p.channel}: {p.text}" for p in problems)]
    turns = (shafts[0].revolutions, shafts[1].revolutions)
    return RecordIndicators(labels, values, moments, turns, "; ".join(notes), problems)


def _own_values(
    own: Sequence[OwnIndicator], signal: np.ndarray, pulses: np.ndarray, gears: Gears
) -> tuple[dict[str, float], list[str]]:
    """Return the user's indicators of one channel, undefined where they fail, and how they failed."""
    values, failed = {}, []
    for indicator in own:
        try:
            values[indicator.name] = indicator.value(signal, pulses, gears)
        except UsageError as error:
            values[indicator.name] = math.nan
            failed.append(str(error))
    return values, failed


def _pulses(record: Recording, channels: dict[str, np.ndarray], teeth: int, settings: IndicatorSettings) -> np.ndarray:
    """Return the pulse times: the tacho's, or those that the mesh lines of the clearest usable channel give."""
    if settings.speed_range_hz is None or not channels:
        return np.asarray(record.tacho_s, dtype=np.float64)
    clarity = {
        name: mesh_ridge(signal, record.fs_hz, teeth, settings.speed_range_hz).clarity
        for name, signal in channels.items()
    }
    clearest = channels[max(clarity, key=lambda name: clarity[name])]
    return tacholess_pulses(clearest, record.fs_hz, teeth, settings.speed_range_hz)


def _table(dataset: Dataset, found: list[RecordIndicators], settings: IndicatorSettings) -> IndicatorTable:
    channels = tuple(channel.name for channel in dataset.channels)
    labels = {name: np.asarray([result.labels[name] for result in found]) for name in LABEL_NAMES}
    labels |= _more_labels(dataset, labels["record_id"], channels)
    columns = list(dict.fromkeys(name for result in found for name in result.values))
    values = {name: np.array([result.values.get(name, np.nan) for result in found]) for name in columns}
    for channel in channels:
        values |= history_indicators(labels, [result.moments.get(channel, {}) for result in found], channel)
    if not columns:
        raise DatasetError(
            f"{dataset.path}: not one of {len(found)} records can be used\n"
            f"{problem_list([problem for result in found for problem in result.problems])}\n"
            f"{duration_advice(dataset, settings.frame_samples)}Without usable records there is nothing to rank."
        )
    stacked = np.stack(list(values.values()), axis=1)
    stacked[~np.isfinite(stacked)] = np.nan
    matrix = FeatureMatrix(stacked, tuple(values), labels)
    revolutions = np.array([result.revolutions for result in found])
    problems = tuple(problem for result in found for problem in result.problems)
    return IndicatorTable(matrix, channels, revolutions, tuple(r.notes for r in found), problems, settings)


def _more_labels(dataset: Dataset, record_ids: np.ndarray, channels: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return further label columns that the set has, in the order of the records."""
    table = dataset.labels()
    wanted = [*OPTIONAL_LABELS, *(f"snr_{channel}_db" for channel in channels)]
    present = [name for name in wanted if name in table.column_names]
    place = {number: row for row, number in enumerate(table.column("record_id").to_pylist())}
    rows = np.array([place[number] for number in record_ids.tolist()])
    return {name: np.asarray(table.column(name).to_pylist(), dtype=np.float64)[rows] for name in present}
