"""Which records of a set cannot be used for indicators, classifiers or an audit, or which channel of them; the way out.

The channels of a set that are asked for by name.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.records.channel_quantities import ANGULAR_SPEED
from diagnostics.records.gear_train import first_teeth, gear_names
from diagnostics.records.recording import Recording
from diagnostics.records.state_classes import HEALTHY
from diagnostics.signal.spectral_kurtosis import FEWEST_FRAMES
from siggen.dataset.reading import Dataset
from siggen.errors import DatasetError, UsageError, counted

FEWEST_REVOLUTIONS = 2
LARGEST_CLIPPED_SHARE = 1e-3
"""A thousandth of the samples at the limits bends kurtosis and every higher moment by more than noise does."""

CLIPPED_RUN = 3
PROBLEMS_SHOWN = 8


@dataclass(frozen=True, slots=True)
class RecordProblem:
    """One problem: of which record, of which channel (empty: of all), and what to do about it."""

    record_id: int
    channel: str
    text: str


def record_problems(record: Recording, frame_samples: int, *, needs_tacho: bool) -> list[RecordProblem]:
    """Return everything that keeps a record from being used.

    Parameters
    ----------
    record : Recording
        The record.
    frame_samples : int
        Samples per frame of the spectral kurtosis; a channel must hold eight half-overlapping ones.
    needs_tacho : bool
        Whether angles come from the pulses.
    """
    number = int(record.labels["record_id"])
    whole = whole_record_problem(record, needs_tacho=needs_tacho)
    found = [RecordProblem(number, "", whole)] if whole else []
    for channel, signal in record.channels.items():
        text = _channel_problem(signal, frame_samples) or _clipped_text(record, channel)
        if text:
            found.append(RecordProblem(number, channel, text))
    return found


def whole_record_problem(record: Recording, *, needs_tacho: bool = True, gear_turns: bool = True) -> str:
    """Return what keeps all channels of a record from being used, or an empty text.

    Parameters
    ----------
    record : Recording
        The record.
    needs_tacho : bool
        Whether angles come from the pulses.
    gear_turns : bool
        Whether the gear has to turn as often as an average needs, not the pinion alone.
    """
    teeth = [_number(count) for count in first_teeth(record.train)]
    if not is_rate(record.fs_hz):
        return f"sampling rate: received {record.fs_hz}; it must be positive. Correct fs_hz in the set's manifest."
    if not all(np.isfinite(z) and z >= 3 and z == round(z) for z in teeth):
        return (
            f"teeth of {' and '.join(_ends(record))}: received {teeth[0]:g}, {teeth[1]:g}; allowed are whole numbers "
            "from 3 on. Orders and averages need both: correct the columns."
        )
    return _pulse_problem(record, teeth[1] / teeth[0] if gear_turns else 1.0) if needs_tacho else ""


def _ends(record: Recording) -> tuple[str, str]:
    """Return the first and the last gear of a record's first mesh."""
    first, *_, last = gear_names(record.train)[0].gears
    return first, last


def _pulse_problem(record: Recording, ratio: float) -> str:
    pulses = np.asarray(record.tacho_s, dtype=np.float64)
    if not np.isfinite(pulses).all() or (pulses.size > 1 and not (np.diff(pulses) > 0).all()):
        return (
            "pulse times are not finite and increasing. Correct tacho_s; `siggen-diagnostics indicators` takes "
            "--speed to do without."
        )
    turns = max(pulses.size - 1, 0)
    if min(turns, turns / ratio) >= FEWEST_REVOLUTIONS:
        return ""
    shafts = "averages" if ratio == 1.0 else "averages of both shafts"
    planetary = gear_names(record.train)[0].planetary
    what = f"turns of the {_ends(record)[0]} against the carrier" if planetary else "turns of the first shaft"
    return (
        f"{turns} whole {what} between pulses; {shafts} over at least {FEWEST_REVOLUTIONS} "
        f"revolutions need {int(np.ceil(FEWEST_REVOLUTIONS * max(1.0, ratio)))}. Use longer records (duration_s) or a "
        "higher speed; without a tacho `siggen-diagnostics indicators` takes --speed."
    )


def _channel_problem(signal: np.ndarray, frame_samples: int) -> str:
    if signal.size < (FEWEST_FRAMES + 1) * (frame_samples // 2):
        return (
            f"{signal.size} samples; spectral kurtosis needs {(FEWEST_FRAMES + 1) * (frame_samples // 2)}. "
            "Use longer records."
        )
    broken = int(np.count_nonzero(~np.isfinite(signal)))
    if broken:
        return f"{broken} of {signal.size} samples are not finite. Mend the record or leave it out."
    low, high = float(signal.min()), float(signal.max())
    if low == high:
        return f"constant ({low:g}) over all {signal.size} samples: is the sensor connected?"
    return ""


def _clipped_text(record: Recording, channel: str) -> str:
    signal = record.channels[channel]
    if not _stands_clipped(record, channel):
        return ""
    return (
        f"{clipped_share(signal):.2%} of the samples stand clipped at {signal.min():g} or {signal.max():g}; up to "
        f"{LARGEST_CLIPPED_SHARE:.1%} is allowed. Widen the sensor's range (`range_m_s2` of an accelerometer)."
    )


def _stands_clipped(record: Recording, channel: str) -> bool:
    """Return whether a channel was clipped; counters of pulses clip nothing, their speed stands still between two."""
    counted = record.quantities.get(channel) == ANGULAR_SPEED
    return not counted and clipped_share(record.channels[channel]) > LARGEST_CLIPPED_SHARE


def clipped_share(signal: np.ndarray) -> float:
    """Return the share of samples that stand in runs of at least three at the largest or the smallest value."""
    share = 0
    for limit in (signal.max(), signal.min()):
        at = np.flatnonzero(signal == limit)
        runs = np.diff(np.flatnonzero(np.diff(at, prepend=-2, append=signal.size + 1) > 1))
        share += int(runs[runs >= CLIPPED_RUN].sum())
    return share / signal.size


def clipped_channels(record: Recording) -> list[str]:
    """Return the channels that stand clipped in more than a thousandth of the samples."""
    return [name for name, signal in record.channels.items() if varies(signal) and _stands_clipped(record, name)]


def varies(signal: np.ndarray) -> bool:
    """Return whether not all samples are equal."""
    return bool((signal != signal[0]).any())


def is_rate(fs_hz: object) -> bool:
    """Return whether what a set says of its sampling rate is one."""
    number = _number(fs_hz)
    return bool(np.isfinite(number) and number > 0.0)


def _number(value: Any) -> float:
    return float("nan") if value is None else float(value)


def problem_lines(problems: Iterable[RecordProblem]) -> list[str]:
    """Return every problem once, with the records and the channels that have it."""
    alike: dict[str, tuple[dict[int, None], dict[str, None]]] = {}
    for problem in problems:
        records, channels = alike.setdefault(problem.text, ({}, {}))
        records[problem.record_id] = channels[problem.channel] = None
    found = []
    for text, (records, channels) in alike.items():
        where = ", ".join(filter(None, channels))
        found.append(f"{_shown(list(records))}{f', channel {where}' if where else ''}: {text}")
    return found


def first_lines(lines: list[str]) -> str:
    """Return the first lines, indented, and how many more there are."""
    rest = len(lines) - PROBLEMS_SHOWN
    return "\n".join(f"  {line}" for line in [*lines[:PROBLEMS_SHOWN], *([f"and {rest} more"] if rest > 0 else [])])


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
    return [(name, text) for name, signal in record.channels.items() if (text := _refused_channel(signal))]


def _refused_channel(signal: np.ndarray) -> str:
    if not np.isfinite(signal).all():
        return "holds values that are not finite"
    return "" if varies(signal) else "is constant"


def _refusal(dataset: Dataset, found: dict[tuple[str, str], list[int]], can_leave_channels: bool) -> str:
    lines = [
        f"channel {channel} {text} in {_shown(records)}" if channel else f"{_shown(records)}: {text}"
        for (channel, text), records in found.items()
    ]
    way_out = _way_out(dataset, found, can_leave_channels)
    return f"{dataset.path}: records that cannot be used\n{first_lines(lines)}\n{way_out}"


def _way_out(dataset: Dataset, found: dict[tuple[str, str], list[int]], can_leave_channels: bool) -> str:
    broken = {channel for channel, _ in found}
    usable = [channel.name for channel in dataset.channels if channel.name not in broken]
    if can_leave_channels and usable and "" not in broken:
        return f"Leave the channel out: siggen-diagnostics report {' '.join(f'--channel {name}' for name in usable)}"
    return (
        f"`siggen verify {dataset.path}` tells whether files were changed; else mend the set's config.yaml and "
        "generate it into a new folder. `siggen-diagnostics indicators` does without such records."
    )


def _shown(records: list[int]) -> str:
    more = " ..." if len(records) > RECORDS_SHOWN else ""
    listed = ", ".join(str(number) for number in records[:RECORDS_SHOWN])
    return f"{counted(len(records), 'record')} ({listed}{more})"
