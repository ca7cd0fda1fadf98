"""What the ranking judges: all indicators of single records and those with a history, of the records it can use.

It leaves out what others take with a note: clipped channels, and records in which the gear turns too seldom.

How long the records of a set have to be, so that indicators can be taken of all of them.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
import pyarrow as pa

from diagnostics.indicators.classifier_table import SETTINGS_KEY
from diagnostics.indicators.history import history_indicators
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import RecordTable, revolution_columns
from diagnostics.records.recording import names_of, pair_teeth
from diagnostics.records.state_classes import chosen_states
from diagnostics.records.usable_records import FEWEST_REVOLUTIONS, RecordProblem, first_lines, is_rate, problem_lines
from diagnostics.signal.spectral_kurtosis import FEWEST_FRAMES
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError

OPTIONAL_LABELS = ("damage_profile_length_mm", "damage_face_length_mm", "contact_length_loss_mm")


def needed_duration(dataset: Dataset, frame_samples: int) -> tuple[float, float]:
    """Return the duration [s] that every record of a set has to have, and the speed [Hz] of the record that needs it.

    Whole revolutions lie between pulses, and the first pulse comes up to one revolution after the start: n of them are
    sure in n + 1 revolutions. Derived.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    frame_samples : int
        Samples per frame of the spectral kurtosis.
    """
    labels = dataset.labels(columns=["speed_hz", *pair_teeth(dataset)])
    columns = np.array([labels.column(name).to_pylist() for name in labels.column_names], dtype=np.float64)
    speed_hz, first, last = columns[:, (np.isfinite(columns) & (columns > 0.0)).all(axis=0)]
    if not speed_hz.size:
        return math.nan, math.nan
    turns = np.ceil(FEWEST_REVOLUTIONS * np.maximum(1.0, last / first)) + 1.0
    against_carrier = last / (first + last) if names_of(dataset)[0].planetary else 1.0
    needed_s = turns / (speed_hz * against_carrier)
    longest = int(np.argmax(needed_s))
    frames_s = (FEWEST_FRAMES + 1) * (frame_samples // 2) / dataset.fs_hz
    return max(float(needed_s[longest]), frames_s), float(speed_hz[longest])


def duration_advice(dataset: Dataset, frame_samples: int) -> str:
    """Return what to do about records that are too short, as a line of its own; nothing where they are long enough."""
    if not is_rate(dataset.fs_hz):
        return ""
    needed_s, speed_hz = needed_duration(dataset, frame_samples)
    if not dataset.duration_s < needed_s:
        return ""
    # rounded up, so that the number works as it is shown
    return (
        f"Records of this set last {dataset.duration_s:g} s; at its lowest speed, {speed_hz:.3g} Hz, they have to last "
        f"{np.ceil(100.0 * needed_s) / 100.0:.2f} s (duration_s).\n"
    )


@dataclass(frozen=True, slots=True)
class IndicatorTable:
    """Labels and indicators of the records that a ranking judges.

    Attributes
    ----------
    matrix : FeatureMatrix
        Values (records, columns), NaN where undefined; labels of records, with sizes of damage and, where the set has
        them, `snr_<channel>_db`.
    channels : tuple of str
    revolutions : (records, 2) int
        Whole revolutions of the first mesh's gears that were averaged.
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
        revolutions = dict(zip(revolution_columns(self.matrix.gears), self.revolutions.T, strict=True))
        table = pa.table({**labels, **revolutions, "notes": list(self.notes), **values})
        return table.replace_schema_metadata({SETTINGS_KEY: json.dumps(asdict(self.settings)).encode()})


def ranking_table(
    table: RecordTable, dataset: Dataset, *, states: Sequence[str] = (), leave_out: bool = False
) -> IndicatorTable:
    """Return what the ranking judges.

    Parameters
    ----------
    table : RecordTable
        Of the set.
    dataset : siggen Dataset
        The set.
    states : sequence of str
        Damaged states to take besides the healthy ones; all where empty. Histories run over these alone.
    leave_out : bool
        Leave records and channels out that cannot be used, instead of stopping.

    Raises
    ------
    DatasetError
        If some records cannot be used or make an own indicator fail and `leave_out` is not set, or none can be used.
    UsageError
        If the set has no such state.
    """
    rows = np.flatnonzero(np.isin(table.labels()["state"], chosen_states(dataset, states)))
    labels = {name: values[rows] for name, values in table.labels().items()}
    problems = _problems(table, rows)
    if problems and not leave_out:
        raise DatasetError(
            f"{dataset.path}: problems among {rows.size} records\n{first_lines(problem_lines(problems))}\n"
            f"{duration_advice(dataset, table.settings.frame_samples)}"
            "Mend them; `siggen-diagnostics indicators` does without these records and channels."
        )
    labels |= _more_labels(dataset, labels["record_id"], table.channels)
    names = table.names()
    values = dict(zip(names, table.values(names)[rows].T.copy(), strict=True))
    unusable = unusable_records(table, rows)
    for channel in table.channels:
        for name in names:
            if name.endswith(f"__{channel}"):
                values[name][unusable[channel]] = np.nan
        values |= with_history(table, labels, rows, channel, unusable[channel])
    if not any(np.isfinite(column).any() for column in values.values()):
        raise DatasetError(
            f"{dataset.path}: not one of {rows.size} records can be used\n{first_lines(problem_lines(problems))}\n"
            f"{duration_advice(dataset, table.settings.frame_samples)}Without usable records there is nothing to rank."
        )
    matrix = FeatureMatrix(np.stack(list(values.values()), axis=1), tuple(values), labels, gears=table.named)
    return IndicatorTable(
        matrix,
        table.channels,
        _revolutions(table, rows),
        _notes(table, rows, problems),
        tuple(problems),
        table.settings,
    )


def _problems(table: RecordTable, rows: np.ndarray) -> list[RecordProblem]:
    """Return what keeps the ranking from using the chosen records, in their order."""
    numbers = table.select(["record_id"]).column("record_id").to_pylist()
    stored = table.texts("problems")
    own: dict[int, list[RecordProblem]] = {}
    for problem in table.own_problems:
        own.setdefault(problem.record_id, []).append(problem)
    found = []
    for row in rows.tolist():
        number = int(numbers[row])
        found += [RecordProblem(number, *pair) for pair in stored[row] if pair[0] in ("", *table.channels)]
        found += own.get(number, [])
    return found


def unusable_records(table: RecordTable, rows: np.ndarray) -> dict[str, np.ndarray]:
    """Return by channel which of the chosen records cannot be used there."""
    lost = [{channel for channel, _ in pairs} for pairs in table.texts("problems")]
    return {c: np.array([bool({"", c} & lost[row]) for row in rows], dtype=bool) for c in table.channels}


def with_history(
    table: RecordTable, labels: dict[str, np.ndarray], rows: np.ndarray, channel: str, unusable: np.ndarray
) -> dict[str, np.ndarray]:
    """Return the indicators with a history of a channel, (rows,) each by column."""
    found = {name: values[rows] for name, values in table.moments(channel).items()}
    moments = {name: np.where(unusable, np.nan, values) for name, values in found.items()}
    columns: dict[str, np.ndarray] = {}
    for mesh in table.named:
        columns |= history_indicators(labels, moments, mesh)
    return {f"{name}__{channel}": values for name, values in columns.items()}


def _revolutions(table: RecordTable, rows: np.ndarray) -> np.ndarray:
    found = table.select(revolution_columns(table.named))
    turns = np.stack([column.to_numpy() for column in found.columns], axis=1)[rows]
    whole = [any(not channel for channel, _ in pairs) for pairs in table.texts("problems")]
    return np.where(np.array(whole)[rows, None], 0, turns)


def _notes(table: RecordTable, rows: np.ndarray, problems: Sequence[RecordProblem]) -> tuple[str, ...]:
    """Return per record what is undefined and why; of a record that cannot be used, only why."""
    numbers, notes = table.select(["record_id"]).column("record_id").to_pylist(), table.texts("notes")
    own: dict[int, list[RecordProblem]] = {}
    for problem in problems:
        own.setdefault(problem.record_id, []).append(problem)
    found = []
    for row in rows.tolist():
        mine = own.get(int(numbers[row]), [])
        whole = [problem.text for problem in mine if not problem.channel]
        shafts = [notes[row]] if notes[row] else []
        found.append("; ".join(whole or [*shafts, *(f"{p.channel}: {p.text}" for p in mine)]))
    return tuple(found)


def _more_labels(dataset: Dataset, record_ids: np.ndarray, channels: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Return further label columns that the set has, in the order of the records."""
    table = dataset.labels()
    wanted = [*OPTIONAL_LABELS, *(f"snr_{channel}_db" for channel in channels)]
    present = [name for name in wanted if name in table.column_names]
    place = {number: row for row, number in enumerate(table.column("record_id").to_pylist())}
    rows = np.array([place[number] for number in record_ids.tolist()])
    return {name: np.asarray(table.column(name).to_pylist(), dtype=np.float64)[rows] for name in present}
