"""What the audit reads of the one table: labels, conditions, levels, indicators, averaged waveforms, noise sketches.

For every record a healthy record of the same specimen at the same operating point, and which records are alike.

A program that writes tables may leave in their metadata which records it treated, by their ids: siggen's own metadata
name none. What others name counts as a label. So does what share of its file a record's row group holds: a program that
treats some records and writes them by themselves cuts files where states change.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa

from diagnostics.audit.finding import must_not_tell
from diagnostics.audit.raw_records import RawColumns, raw_columns
from diagnostics.indicators.classifier_table import check_table
from diagnostics.indicators.line_levels import LEVELS
from diagnostics.indicators.matrix import FeatureMatrix
from diagnostics.indicators.own_indicator import OwnIndicator
from diagnostics.indicators.registry import first_columns, indicator_columns
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.indicators.table import PULSE_CONDITIONS, RecordTable, record_table
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import PAIR, GearNames
from diagnostics.records.recording import TACHO_NAME, names_of, recordings
from diagnostics.records.sample_bytes import BYTES
from diagnostics.records.state_classes import HEALTHY, ordered_states
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError
from siggen.keys.column import Role

OWN_METADATA = frozenset({b"unit", b"meaning", b"role", b"section"})
FEWEST_NAMED = 2
"""Ids in a text from which it counts; one number may be anything."""


def noted_records(schemas: Iterable[pa.Schema], record_id: np.ndarray) -> dict[str, np.ndarray]:
    """Return which records (records,) each text of the metadata names, (records,) bool by the text's place.

    Parameters
    ----------
    schemas : iterable of pyarrow.Schema
        Of the labels of every split; texts of one place are taken together.
    record_id : (records,) int
    """
    found: dict[str, np.ndarray] = {}
    for place, text in (entry for schema in schemas for entry in _metadata_texts(schema)):
        found[place] = found.get(place, False) | np.isin(record_id, _ids(text))
    return {place: named for place, named in found.items() if FEWEST_NAMED <= named.sum() < named.size}


def _metadata_texts(schema: pa.Schema) -> Iterator[tuple[str, str]]:
    for key, value in (schema.metadata or {}).items():
        yield f"named in `{key.decode(errors='replace')}` of the file", value.decode(errors="replace")
    for column in schema:
        for key, value in (column.metadata or {}).items():
            if key not in OWN_METADATA:
                yield f"named in `{key.decode(errors='replace')}` of {column.name}", value.decode(errors="replace")


def _ids(text: str) -> list[int]:
    return [int(number) for number in re.findall(r"(?<![\w.])\d{1,18}(?![\w.])", text)]


def group_shares(groups: Iterable[tuple[int, ...]]) -> dict[str, np.ndarray]:
    """Return the share of the rows of its file that the row group of every record holds, (records,) float64, by name.

    Nothing where each file is one group.

    Parameters
    ----------
    groups : iterable of tuple of int
        Rows of the groups of every file, in the order of the records.
    """
    found = [np.repeat(np.array(rows) / max(sum(rows), 1), rows) for rows in groups]
    shares = np.concatenate(found) if found else np.ones(0)
    return {"share of the file in its row group": shares} if (shares < 1.0).any() else {}


TORQUE_TOLERANCE = 0.01
SPEED_TOLERANCE = 0.002
CHANGED = "changed_keys"
"""Label of what a state changes on purpose."""


def reference_records(measured: MeasuredSet) -> np.ndarray:
    """Return the row of the reference of every record, (records,) int, or -1 where there is none.

    The reference is healthy, of the same specimen, within 1 % in torque and 0.2 % in speed (mean speed between the
    pulses where it is known); of several the one nearest in speed, then the first. All records at an operating point
    stand beside the same reference, the first healthy one, which has none itself. So healthy and damaged ones of a
    gearbox without damage could be exchanged: two healthy records beside each other would be one difference, counted
    twice. A reference beside which no other healthy record stands does not count.
    """
    labels = measured.labels
    speed = measured.values["pulses_per_s"][:, 0]
    speed = np.where(np.isfinite(speed), speed, labels["speed_hz"])
    torque = labels["torque_nm"].astype(np.float64)
    result = np.full(speed.size, -1, dtype=np.int64)
    for specimen in np.unique(labels["specimen_id"]):
        rows = np.flatnonzero(labels["specimen_id"] == specimen)
        result[rows] = _references(rows, measured.healthy[rows], speed[rows], torque[rows])
    return result


def _references(rows: np.ndarray, healthy: np.ndarray, speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Return the references of the records of one specimen, rows of the set or -1."""
    apart = np.abs(speed[:, None] / speed - 1.0)
    allowed = (apart <= SPEED_TOLERANCE) & (np.abs(torque[:, None] - torque) <= TORQUE_TOLERANCE * np.abs(torque))
    chosen: list[int] = []
    for place in np.flatnonzero(healthy).tolist():
        if not allowed[place, chosen].any():
            chosen.append(place)
    found = np.full(rows.size, -1, dtype=np.int64)
    if not chosen:
        return found
    nearest = np.where(allowed[:, chosen], apart[:, chosen], np.inf)
    place = np.asarray(chosen)[nearest.argmin(axis=1)]
    beside = np.isfinite(nearest.min(axis=1)) & ~np.isin(np.arange(rows.size), chosen)
    beside &= np.isin(place, place[beside & healthy])
    found[beside] = rows[place[beside]]
    return found


def exchange_blocks(measured: MeasuredSet) -> np.ndarray:
    """Return a number for every record, (records,) int: records of one number are alike but for the state.

    They are of one specimen and operating point and stand beside one reference; the reference stands alone.
    """
    reference, every = reference_records(measured), np.arange(len(measured.healthy))
    point = measured.labels.get("operating_point_id", np.zeros(every.size, dtype=np.int64))
    beside = np.where(np.isin(every, reference), every.size + every, reference)
    keys = np.stack([measured.labels["specimen_id"], point, beside]).astype(np.int64)
    return np.asarray(np.unique(keys, axis=1, return_inverse=True)[1]).ravel()


@dataclass(frozen=True, slots=True)
class MeasuredSet:
    """Labels of all records and what was measured of their channels.

    Attributes
    ----------
    labels : dict of str to (records,) array
        Scalar label columns as the set has them; lists stay lists (object arrays).
    channels : tuple of str
        Channel names.
    values : dict of str to (records, channels) float64
        Measured numbers by name, NaN where undefined: every indicator of one record, levels, conditions.
    indicators : tuple of str
        Which of these are indicators.
    waveforms : list of lists of (orders,) complex64
        Lines of the averaged waveform by record and channel.
    sketches : list of lists of (k,) complex64
        Noise sketches, empty where there is no noise.
    checksums : (records, channels) int64
        Checksum of the samples of every channel.
    config, failures
        Configuration and failed records of the set.
    other_quantities : dict of str to str
        Channel name -> quantity, of the channels that hold no acceleration.
    roles, sections : dict of str
        Role of the label columns, and the section of the configuration that draws them; of others conditions.
    raw : RawColumns
        Numbers of the raw records.
    gears : GearNames
        What indicators are called after.
    about : mapping of str to mapping
        Label columns by what they hold (`teeth`, `faulty_teeth`, `shaft_hz`) and of which gear or shaft.
    """

    labels: dict[str, np.ndarray]
    channels: tuple[str, ...]
    values: dict[str, np.ndarray]
    indicators: tuple[str, ...]
    waveforms: list[list[np.ndarray]]
    sketches: list[list[np.ndarray]]
    checksums: np.ndarray
    config: dict[str, Any]
    failures: list[dict[str, Any]]
    other_quantities: dict[str, str] = field(default_factory=dict)
    roles: dict[str, Role] = field(default_factory=dict)
    sections: dict[str, str] = field(default_factory=dict)
    raw: RawColumns = field(default_factory=RawColumns)
    gears: GearNames = PAIR
    about: Mapping[str, Mapping[str, str]] = field(default_factory=dict)

    def first(self, quantity: str) -> np.ndarray | None:
        """Return what labels hold of the first driver, (records,): its `teeth`, `faulty_teeth`; None where unknown."""
        return self.labels.get(self.about.get(quantity, {}).get(self.gears[0].gears[0], ""))

    @property
    def pulsed_shaft_hz(self) -> np.ndarray | None:
        """What labels say of the speed of the first shaft, which has the tacho, (records,) [Hz]; None where unknown."""
        return self.labels.get(next(iter(self.about.get("shaft_hz", {}).values()), ""))

    @property
    def teeth(self) -> np.ndarray:
        """(records,) int: teeth of the first driver."""
        teeth = self.first("teeth")
        assert teeth is not None
        return teeth

    def column(self, name: str) -> str:
        """Return the name of a measured number; of an indicator of gears that about the first one."""
        return name if name in self.values else self.columns_of(name)[0]

    def columns_of(self, indicator: str, **fields: Any) -> tuple[str, ...]:
        """Return the columns of an indicator about the first gear, of a planetary set about each of its members."""
        return first_columns(IndicatorSettings(), self.gears, indicator, **fields)

    @property
    def accelerations(self) -> np.ndarray:
        """(k,) int: places of the channels that hold accelerations, which is what ranges were measured of."""
        return np.array(
            [k for k, name in enumerate(self.channels) if name not in self.other_quantities], dtype=np.int64
        )

    @property
    def healthy(self) -> np.ndarray:
        """(records,) bool: which records show no damage."""
        return np.asarray(self.labels["fault"] == HEALTHY)

    @property
    def unchanged(self) -> np.ndarray:
        """(records,) bool: which records are of states that change no key of the machine."""
        changed = self.labels.get(CHANGED)
        return np.ones(len(self.healthy), dtype=bool) if changed is None else np.array([not one for one in changed])

    @property
    def conditions(self) -> dict[str, np.ndarray]:
        """Labels that must not tell a state, (records,) each."""
        return {
            name: values for name, values in self.labels.items() if values.ndim == 1 and must_not_tell(self.roles, name)
        }

    @property
    def steady_conditions(self) -> dict[str, np.ndarray]:
        """Conditions without those of sections that a state changes, since there a changed state differs on purpose."""
        changed = {key.partition(".")[0] for keys in self.labels.get(CHANGED, ()) for key in keys}
        return {name: values for name, values in self.conditions.items() if self.sections.get(name) not in changed}

    def states(self) -> tuple[str, ...]:
        """Return the states in the order of the configuration."""
        return ordered_states(self.labels)

    def matrix(self) -> FeatureMatrix:
        """Return all indicators of all channels, one column each."""
        taken = [(name, k) for k in range(len(self.channels)) for name in self.indicators if self.has(name, k)]
        names = tuple(f"{name}__{self.channels[k]}" for name, k in taken)
        columns = [self.values[name][:, k] for name, k in taken]
        return FeatureMatrix(np.stack(columns, axis=1), names, self.labels, gears=self.gears)

    def has(self, indicator: str, channel: int) -> bool:
        """Return whether an indicator is taken of what the channel of this place holds."""
        known = indicator_columns(IndicatorSettings(), self.gears).get(indicator)
        held = self.other_quantities.get(self.channels[channel], RECORDED.word)
        return known is None or known.entry.is_taken_of(held)


def measured_set(
    dataset: Dataset, own: Sequence[OwnIndicator] = (), advance: Callable[[], None] | None = None
) -> MeasuredSet:
    """Return what the audit reads of a set.

    Parameters
    ----------
    dataset : siggen Dataset
        What `siggen.open` returned.
    own : sequence of OwnIndicator
        The user's indicators.
    advance : callable, optional
        Called after every record of a pass.

    Raises
    ------
    DatasetError
        If the set holds no records, or some that cannot be used.
    """
    table = record_table(dataset, own=own, advance=advance)
    check_table(table, dataset)
    labels = {name: _array(column) for name, column in _scalar_labels(dataset).items()}
    labels |= noted_records((dataset.labels(split).schema for split in dataset.splits), labels["record_id"])
    labels |= group_shares(dataset.row_groups())
    if not np.array_equal(table.labels()["record_id"], labels["record_id"]):
        raise DatasetError(f"{dataset.path}: labels and signals are not in the same order; `siggen verify` names why")
    indicators = _indicators(table)
    return MeasuredSet(
        labels=labels,
        channels=table.channels,
        values=_values(table, indicators),
        indicators=indicators,
        waveforms=table.complex_rows("waveform"),
        sketches=table.complex_rows("sketch"),
        checksums=table.values([f"checksum.{channel}" for channel in table.channels]).astype(np.int64),
        config=dict(dataset.config),
        failures=list(dataset.manifest.get("failures", [])),
        other_quantities={c.name: c.quantity for c in dataset.channels if c.quantity != RECORDED.word},
        roles=_of_labels(dataset, dataset.role),
        sections=_of_labels(dataset, dataset.section),
        raw=raw_columns(recordings(dataset)),
        gears=names_of(dataset),
        about={quantity: dataset.columns_of(quantity) for quantity in ("teeth", "faulty_teeth", "shaft_hz")},
    )


def _indicators(table: RecordTable) -> tuple[str, ...]:
    """Return the indicators of all channels, each once, in the order of the first channel that has them."""
    ends = [f"__{channel}" for channel in table.channels]
    found = [name.removesuffix(end) for end in ends for name in table.names() if name.endswith(end)]
    return tuple(dict.fromkeys(found))


def _values(table: RecordTable, indicators: Sequence[str]) -> dict[str, np.ndarray]:
    """Return everything by name, (records, channels)."""
    count = len(table.channels)
    found = {name: np.repeat(table.values([name]), count, axis=1) for name in PULSE_CONDITIONS}
    for name in ("samples", *BYTES):
        found[name] = table.values([f"{name}.{channel}" for channel in table.channels])
    names = (*indicators, *LEVELS)
    wanted = [f"{name}__{channel}" for name in names for channel in table.channels]
    present = {*table.names(), *(name for name in wanted if name.split("__")[0] in LEVELS)}
    kept = [name in present for name in wanted]
    every = np.full((table.rows, len(wanted)), np.nan)  # not taken of what that channel holds
    every[:, kept] = table.values([name for name in wanted if name in present])
    return found | {name: every[:, k * count : (k + 1) * count] for k, name in enumerate(names)}


def _scalar_labels(dataset: Dataset) -> dict[str, Any]:
    table = dataset.labels()
    return _of_labels(dataset, table.column)


def _of_labels(dataset: Dataset, fact: Callable[[str], Any]) -> dict[str, Any]:
    """Return a fact of every label column."""
    signals = {channel.column for channel in dataset.channels} | {TACHO_NAME}
    return {name: fact(name) for name in dataset.labels().column_names if name not in signals}


def _array(column: Any) -> np.ndarray:
    if pa.types.is_list(column.type) or pa.types.is_fixed_size_list(column.type):
        rows = column.to_pylist()
        found = np.empty(len(rows), dtype=object)
        found[:] = [tuple(row) if row is not None else () for row in rows]
        return found
    return np.asarray(column.to_pylist())
