"""Check: whether a new recording of a machine differs from its healthy ones; no state is named.

Source: derived; the test of the change is `change_score`.

Earlier checks of a machine, one line of JSON each beside its facts: what a trend is drawn from.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path

import numpy as np

from diagnostics.indicators.registry import column_title
from diagnostics.machine.comparable import FEWEST_OVER_SPEED, LOAD_RATIO, SPEED_RATIO, comparable
from diagnostics.machine.healthy_state import pieces_of
from diagnostics.machine.machine import CHECKS, Machine
from diagnostics.page.sentences import Sentences
from diagnostics.prediction.record_pieces import RecordPieces
from diagnostics.recordings.in_rig import in_rig
from diagnostics.recordings.level_alike import MOST_DB
from diagnostics.recordings.measured_recording import MeasuredRecording
from diagnostics.records.gear_train import gear_names
from diagnostics.statistics.change_score import FEWEST, ChangeScore, attainable_rate, change_score
from diagnostics.training.referenced import log_values
from siggen.errors import UsageError
from siggen.file_writing import write_file

MACHINE_WORDS = Sentences(Path(__file__).with_name("templates") / "machine.txt")
UNCHANGED, CHANGED, OTHER_CONDITIONS, CANNOT_TELL = "unchanged", "changed", "other load or speed", "cannot tell"
LISTED = 8
ALIKE_DB, DOUBTFUL_DB = 10.0, 15.0
"""Spread of channels that are off alike, and from where on that is said beside a change (assumed)."""
G_DB, G_NEAR_DB = 19.8, 2.0
"""20 log10(9.81), and how far a recording without other changes may lie from it."""


@dataclass(frozen=True, slots=True)
class PastCheck:
    """One line: when it was made (UTC), of what, with which verdict, score and limit (None where there was none)."""

    made: str
    recording: str
    verdict: str
    speed_hz: float | None
    score: float | None
    limit: float | None


def with_checks(history: Iterable[PastCheck], checks: Iterable[Check]) -> list[PastCheck]:
    """Return a machine's history, and the checks as its newest lines."""
    made = datetime.now(UTC).isoformat(timespec="seconds")
    rows = [*history]
    for check in checks:
        speed = check.speed_hz if isfinite(check.speed_hz) else None
        score, limit = (None, None) if check.score is None else (check.score.score, check.score.limit)
        rows.append(PastCheck(made, check.recording, check.verdict, speed, score, limit))
    return rows


def write_history(folder: Path, history: Iterable[PastCheck]) -> None:
    """Write a machine's history, oldest first."""
    write_file(folder / CHECKS, "".join(json.dumps(asdict(row)) + "\n" for row in history))


def past_checks(folder: Path) -> list[PastCheck]:
    """Return the history, oldest first.

    Raises
    ------
    UsageError
        If a line cannot be read; names it.
    """
    file = folder / CHECKS
    if not file.exists():
        return []
    history = []
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), start=1):
        try:
            history.append(PastCheck(**json.loads(line)))
        except (TypeError, ValueError) as error:
            raise UsageError(f"{file}: line {number} is damaged ({error}); delete that line") from None
    return history


@dataclass(frozen=True, slots=True)
class MovedIndicator:
    """An indicator that moved: which, on which channel, by what factor, and by how many spreads."""

    indicator: str
    channel: str
    factor: float
    spreads: float
    title: str = ""


@dataclass(frozen=True, slots=True)
class Check:
    """What is said about one recording.

    Attributes
    ----------
    recording : str
    verdict : str
        UNCHANGED, CHANGED, OTHER_CONDITIONS or CANNOT_TELL.
    reason : str
        In one sentence.
    speed_hz : float
        NaN where it was not found.
    score : ChangeScore or None
    moved : tuple of Moved
        Largest deviations first.
    used : int
        References that it was compared with.
    angle : str
        Where its angle comes from, and how sure it is.
    """

    recording: str
    verdict: str
    reason: str
    speed_hz: float
    score: ChangeScore | None = None
    moved: tuple[MovedIndicator, ...] = ()
    used: int = 0
    angle: str = ""

    @property
    def turning(self) -> str:
        """Speed and where the angle comes from, to be put behind the reason; empty where neither is known."""
        return f"; {self.speed_hz:.4f} Hz ({self.angle})" if self.angle else ""


def check_recording(machine: Machine, recording: MeasuredRecording, name: str, load: float | None = None) -> Check:
    """Return the verdict on a recording.

    Parameters
    ----------
    machine : Machine
    recording : MeasuredRecording
        With the machine's channels.
    name : str
        What the recording is called.
    load : float, optional
        As the references' loads were given.

    Raises
    ------
    UsageError
        If its sampling rate and its tacho say that the rate is wrong.
    """
    _refuse_other_rate(machine, recording)
    try:
        if recording.duration_s < 0.9 * machine.duration_s:
            told = f"{recording.duration_s:.3g} s; pieces of the references are {machine.duration_s:.3g} s long"
            raise UsageError(f"too short: {told}")
        pieces, pulses = pieces_of(recording, machine.fs_hz, machine.train, machine.speed_range_hz, machine.duration_s)
    except UsageError as error:
        reason = str(error).removeprefix(f"{recording.path}: ")
        if recording.fs_hz > machine.fs_hz:
            reason += f" It was sampled at {recording.fs_hz:g} Hz, the references at {machine.fs_hz:g} Hz."
        return Check(name, CANNOT_TELL, reason, float("nan"))
    return replace(_compared(machine, pieces, pulses.speed_hz, name, load), angle=pulses.origin)


def _refuse_other_rate(machine: Machine, recording: MeasuredRecording) -> None:
    """Refuse a rate with which a tacho turns as far from the references as the rate is from theirs."""
    if (hz := recording.tacho_hz) is None:
        return
    low, high = machine.speed_hz.min() / SPEED_RATIO, machine.speed_hz.max() * SPEED_RATIO
    if not low <= hz <= high and low <= hz * machine.fs_hz / recording.fs_hz <= high:
        shaft = gear_names(machine.train)[0].gears[0]
        raise UsageError(
            f"{recording.path}: {recording.fs_hz:g} Hz; the references {machine.fs_hz:g} Hz, their {shaft} "
            f"{machine.speed_hz.min():.4g} to {machine.speed_hz.max():.4g} Hz, this one {hz:.4g}. If the rate is "
            f"wrong: {in_rig(f'fs_hz: {machine.fs_hz:g}')}; if it is right, give references at this speed"
        )


def _compared(machine: Machine, pieces: RecordPieces, speed_hz: float, name: str, load: float | None) -> Check:
    logs = log_values(pieces.medians(machine.names)[None])[0]
    beside = comparable(machine, speed_hz, load)
    if beside is None:
        return Check(name, OTHER_CONDITIONS, _conditions(machine, speed_hz, load), speed_hz)
    healthy = log_values(machine.values[beside.used])
    if (same := _same(machine, logs)) is not None:
        return Check(name, CANNOT_TELL, f"it is the reference {same}; give another recording", speed_hz)
    try:
        score = change_score(healthy, logs, machine.false_alarms, beside.conditions)
    except UsageError as error:
        return Check(name, CANNOT_TELL, str(error), speed_hz)
    level = _level_db(machine, score.mean, logs)
    if abs(level) > MOST_DB:
        return Check(name, CANNOT_TELL, _other_level(level), speed_hz)
    moved = _moved(machine, logs, score)
    verdict = CHANGED if score.changed else UNCHANGED
    used = int(np.count_nonzero(beside.used))
    doubts = [_other_level(level)] if abs(level) > DOUBTFUL_DB else []
    if len(beside.conditions) == 0 and (where := _beyond_levels(machine, healthy, logs)):
        doubts.append(f"all channels are {where} than in every reference; other loads do that too: give --load to both")
    doubt = "".join(f"; {text}" for text in doubts) if score.changed else ""
    return Check(name, verdict, _reason(score, moved, used) + doubt, speed_hz, score, moved, used)


def load_sentence(machine: Machine, load: float | None) -> str:
    """Return what is missing where the references have loads and the recordings none.

    Raises
    ------
    UsageError
        If a load is given and nothing can be compared with it.
    """
    known = bool(np.isfinite(machine.load).all()) and not machine.load_from_slip
    if load is not None and not known:
        why = "slip tells the loads" if machine.load_from_slip else "its references have none"
        raise UsageError(f"--load: received {load:g}, but {why}; leave it out, or give loads to `baseline`")
    return "" if load is not None or not known else "Loads are known of the references: give --load as well."


def rate_sentence(references: int, wanted: float) -> str:
    """Return how many false alarms to expect, and what more recordings would give."""
    needed = int(np.ceil(1.0 / wanted - 1.0 - 1e-9))
    return MACHINE_WORDS.rate(references, attainable_rate(references, wanted), wanted, needed)


def _same(machine: Machine, logs: np.ndarray) -> str | None:
    """Return the reference that a recording is: all indicators are equal; noise does not repeat."""
    for name, row in zip(machine.references, log_values(machine.values), strict=True):
        if np.array_equal(row, logs, equal_nan=True):
            return name
    return None


def _conditions(machine: Machine, speed_hz: float, load: float | None) -> str:
    """Say what the references know nothing of, and what would be needed."""
    known = load is not None and bool(np.isfinite(machine.load).all()) and not machine.load_from_slip
    at = f"{speed_hz:.5g} Hz" + (f" and load {load:g}" if known else "")
    spans = f"{machine.speed_hz.min():.5g} to {machine.speed_hz.max():.5g} Hz"
    spans += f", loads {machine.load.min():g} to {machine.load.max():g}" if known else ""
    near, beside = f"{100 * (SPEED_RATIO - 1):.0f} %", f"{100 * (LOAD_RATIO - 1):.0f} %"
    return (
        f"nothing is known of {at}: it takes {FEWEST} references within {near} of the speed or {FEWEST_OVER_SPEED} on "
        f"both sides of it, under loads that reach within {beside} of this one, without load apart; the references: "
        f"{spans}" + ("; slip tells loads" if machine.load_from_slip else "")
    )


def _level_db(machine: Machine, mean: np.ndarray, logs: np.ndarray) -> float:
    """Return by how much all channels are off in level alike [dB], of the nearest one; 0 where they differ."""
    levels = [k for k, name in enumerate(machine.names) if name.startswith("rms__")]
    off = 20.0 / np.log(10.0) * (logs[levels] - mean[levels])
    if not levels or not np.isfinite(off).all() or np.ptp(off) >= ALIKE_DB:
        return 0.0
    return float(off[np.abs(off).argmin()])


def _beyond_levels(machine: Machine, healthy: np.ndarray, logs: np.ndarray) -> str:
    """Return whether all channels are `louder` or `quieter` than in all references; empty where they are neither."""
    levels = [k for k, name in enumerate(machine.names) if name.startswith("rms__")]
    if (logs[levels] > healthy[:, levels].max(axis=0)).all():
        return "louder"
    return "quieter" if (logs[levels] < healthy[:, levels].min(axis=0)).all() else ""


def _other_level(level_db: float) -> str:
    unit = " (g and m/s2 lie 20 dB apart)" if abs(abs(level_db) - G_DB) < G_NEAR_DB else ""
    return f"all channels are {level_db:+.0f} dB off; is the unit, sensitivity or gain that of the references{unit}?"


def _moved(machine: Machine, logs: np.ndarray, score: ChangeScore) -> tuple[MovedIndicator, ...]:
    moved = []
    for k in np.argsort(-np.nan_to_num(np.abs(score.deviation)))[:LISTED]:
        indicator, _, channel = machine.names[k].partition("__")
        factor = float(np.exp(logs[k] - score.mean[k]))
        title = column_title(indicator, gear_names(machine.train))
        moved.append(MovedIndicator(indicator, channel, factor, float(score.deviation[k]), title))
    return tuple(moved)


def _reason(score: ChangeScore, moved: tuple[MovedIndicator, ...], used: int) -> str:
    side = "above" if score.changed else "not above"
    first = "" if not score.changed else f"; most: {_names(moved)}"
    return f"its distance {score.score:.3g} from {used} references is {side} the limit {score.limit:.3g}{first}"


def _names(moved: tuple[MovedIndicator, ...]) -> str:
    return "; ".join(f"{m.title} on {m.channel} x {m.factor:.3g}" for m in moved[:3])
