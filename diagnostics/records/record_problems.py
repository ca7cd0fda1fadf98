"""What makes a record, or one channel of it, unusable for indicators, and the way out of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.records.channel_quantities import ANGULAR_SPEED
from diagnostics.records.gear_train import first_teeth, gear_names
from diagnostics.records.recording import Recording
from diagnostics.signal.spectral_kurtosis import FEWEST_FRAMES

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

    def __str__(self) -> str:
        """One line that names record and channel."""
        return f"record {self.record_id}{f', channel {self.channel}' if self.channel else ''}: {self.text}"


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
            "--speed-range to do without."
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
        "higher speed; without a tacho `siggen-diagnostics indicators` takes --speed-range."
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


def problem_list(problems: list[RecordProblem]) -> str:
    """Return the first problems, a line each, and how many there are."""
    shown = [f"  {problem}" for problem in problems[:PROBLEMS_SHOWN]]
    rest = len(problems) - len(shown)
    return "\n".join([*shown, *([f"  and {rest} more"] if rest else [])])
