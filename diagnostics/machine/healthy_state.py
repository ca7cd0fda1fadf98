"""From healthy recordings to a Machine: common rate and length of pieces, one row of indicators per recording.

A recording may be odd, unlike the others: of another unit, sensor place, machine or load. Two recordings are as far
apart as their levels in third octaves are (rms over bands, of the channel that differs most). Recordings hang together
that no more than a limit parts, directly or over others; what is not in the largest such group is odd. Source: derived;
the limits stand on docs/start/check_a_machine.md.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import log
from pathlib import Path

import numpy as np

from diagnostics.base.progress import Advance
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.machine.comparable import SPEED_RATIO, comparable, slip_loads
from diagnostics.machine.machine import Machine
from diagnostics.machine.recording_indicators import check_mesh_lines
from diagnostics.prediction.record_pieces import RecordPieces, at_rate, record_pieces
from diagnostics.recordings.level_alike import check_levels_alike
from diagnostics.recordings.measured_recording import MeasuredRecording, read_recording
from diagnostics.recordings.shaft_pulses import ShaftPulses, shaft_pulses
from diagnostics.recordings.taken import RecordingFacts, Source, TakenRecording, take
from diagnostics.statistics.change_score import FEWEST
from siggen.columns.drivetrain import GearTrain
from siggen.errors import UsageError, counted

NEAR_DB, FAR_DB = 6.0, 15.0
"""Between recordings at one speed, and at different ones: modes then move lines of a healthy machine by up to 12 dB."""
SPREADS = 2.0
"""Limit over the median distance to the nearest other recording: machines that repeat badly have a wider one."""
LOWEST_HZ, USED_BAND = 20.0, 1.0 / 2.56
"""Lowest band, and the share of the sampling rate that recorders pass whole."""
FEWEST_NEAR = 3
"""References at one speed that tell which of them is odd."""
FEWEST_BINS = 3
"""Of the spectrum in a band."""
SILENCE = 1e-30
LISTED = 5


@dataclass(frozen=True, slots=True)
class OddReference:
    """Which reference, its channel that differs most, and how far the nearest of the others is [dB]."""

    index: int
    channel: str
    distance_db: float


def third_octave_levels(recording: MeasuredRecording, most_hz: float, seconds: float) -> np.ndarray:
    """Return levels (channels, bands) [dB re 1 m/s^2] of the first seconds, up to a frequency; NaN in narrow bands."""
    size = round(seconds * recording.fs_hz)
    signals = np.stack([signal[:size] for signal in recording.channels.values()])
    weights = np.hanning(signals.shape[1])
    centred = signals - signals.mean(axis=1, keepdims=True)
    power = 2.0 * np.abs(np.fft.rfft(centred * weights)) ** 2 / (signals.shape[1] * (weights**2).sum())
    frequency_hz = np.fft.rfftfreq(signals.shape[1], 1.0 / recording.fs_hz)
    edges_hz = LOWEST_HZ * 2.0 ** (np.arange(1 + int(3.0 * np.log2(most_hz / LOWEST_HZ))) / 3.0)
    levels = np.full((len(signals), edges_hz.size - 1), np.nan)
    for k, (low, high) in enumerate(pairwise(edges_hz)):
        inside = (frequency_hz >= low) & (frequency_hz < high)
        if np.count_nonzero(inside) >= FEWEST_BINS:
            levels[:, k] = 10.0 * np.log10(power[:, inside].sum(axis=1) + SILENCE)
    return levels


def odd_references(levels: np.ndarray, speed_hz: np.ndarray, channels: Sequence[str]) -> tuple[OddReference, ...]:
    """Return the references that are unlike the others, in their order.

    Parameters
    ----------
    levels : (references, channels, bands) float64
        Of `third_octave_levels`.
    speed_hz : (references,) float64
    channels : sequence of str
    """
    by_channel = np.sqrt(np.nanmean((levels[:, None] - levels[None]) ** 2, axis=3))
    distance = by_channel.max(axis=2)
    near = np.abs(np.log(speed_hz[:, None] / speed_hz)) <= log(SPEED_RATIO)
    typical = float(np.median((distance + np.diag(np.full(len(distance), np.inf))).min(axis=1)))
    linked = distance <= np.maximum(np.where(near, NEAR_DB, FAR_DB), SPREADS * typical)
    odd = _outside(linked)
    for k, beside in enumerate(near):  # at its own speed a reference has the narrower limit
        if np.count_nonzero(beside) >= FEWEST_NEAR:
            odd[k] |= _outside(linked[np.ix_(beside, beside)])[np.count_nonzero(beside[:k])]
    return tuple(_odd(int(k), np.flatnonzero(~odd), by_channel, channels) for k in np.flatnonzero(odd))


def odd_sentences(odd: Sequence[OddReference], references: Sequence[str]) -> list[str]:
    """Return one sentence per odd reference, and how many more there are."""
    sentences = [
        f"reference {one.index + 1} of {len(references)}, {references[one.index]}, is unlike the others: third octaves "
        f"of {one.channel} are {one.distance_db:.0f} dB off the nearest one. Is it of this machine, sensor place, unit "
        "and load? If not, leave it out of `baseline`."
        for one in odd[:LISTED]
    ]
    return sentences + ([f"{len(odd) - LISTED} more references are unlike the others."] if len(odd) > LISTED else [])


def _outside(linked: np.ndarray) -> np.ndarray:
    """Return which nodes of a symmetric graph (n, n) lie outside of its largest connected part."""
    from scipy.sparse.csgraph import connected_components

    _, part = connected_components(linked, directed=False)
    return np.asarray(part != np.bincount(part).argmax())


def _odd(k: int, others: np.ndarray, by_channel: np.ndarray, channels: Sequence[str]) -> OddReference:
    nearest = others[by_channel[k, others].max(axis=1).argmin()]
    worst = int(by_channel[k, nearest].argmax())
    return OddReference(k, channels[worst], float(by_channel[k, nearest, worst]))


LONGEST_PIECE_S = 10.0
LEAST_SLIP, MOST_SLIP = 0.001, 0.05
FEWEST_TURNS = 10
"""Of the first shaft in a piece; averages of fewer leave the noise in."""


def healthy_state(
    sources: Sequence[Source],
    channels: tuple[str, ...],
    facts: RecordingFacts,
    train: GearTrain,
    speed_range_hz: tuple[float, float] | None,
    loads: Sequence[float] | None,
    false_alarms: float,
    advance: Advance,
) -> tuple[Machine, dict[str, str]]:
    """Return a machine from its healthy recordings, and why others cannot be used, by their names.

    Parameters
    ----------
    sources : sequence of (Path, int or None)
        Files and rows, four at least.
    channels, facts, train, speed_range_hz, false_alarms : see `Machine`
    loads : sequence of float or None
        One per recording, one for all, or none; None: the fall of speed tells them.
    advance : callable
        Told of every recording that is done.

    Raises
    ------
    UsageError
        If there are too few that can be used, or one comes twice; names the files.
    """
    if loads is not None and len(loads) not in {0, 1, len(sources)}:
        raise UsageError(f"--load: received {len(loads)} numbers; allowed: one, or one per recording ({len(sources)})")
    refused: dict[str, str] = {}
    read: dict[int, MeasuredRecording] = {}
    called = [f"{path.name}:{row}" if row is not None else path.name for path, row in sources]
    for k, (path, row) in enumerate(sources):
        try:
            read[k] = read_recording(path, channels, replace(facts, row=row))
        except UsageError as error:
            refused[called[k]] = str(error).removeprefix(f"{path}: ")
    _enough(len(read), refused)
    _refuse_twice(tuple(read.values()))
    check_levels_alike(tuple(read.values()))
    fs_hz = min(recording.fs_hz for recording in read.values())
    duration_s = min(LONGEST_PIECE_S, *(recording.duration_s for recording in read.values()))
    rows: dict[int, tuple[RecordPieces, ShaftPulses]] = {}
    for k, recording in read.items():
        try:
            pieces, pulses = pieces_of(recording, fs_hz, train, speed_range_hz, duration_s)
            check_mesh_lines(recording, pulses, train)
            rows[k] = pieces, pulses
        except UsageError as error:
            refused[called[k]] = str(error).removeprefix(f"{recording.path}: ")
        advance()
    _enough(len(rows), refused)
    kept = list(rows)
    names = rows[kept[0]][0].names
    values = np.stack([pieces.medians(names) for pieces, _ in rows.values()])
    speeds = np.array([pulses.speed_hz for _, pulses in rows.values()])
    load = _slips(speeds) if loads is None else np.broadcast_to(np.asarray(loads or np.nan, float), len(sources))[kept]
    levels = np.stack([third_octave_levels(read[k], USED_BAND * fs_hz, duration_s) for k in kept])
    references = tuple(called[k] for k in kept)
    doubts = odd_sentences(odd_references(levels, speeds, channels), references)
    angles = tuple(pulses.origin for _, pulses in rows.values())
    machine = Machine(
        train, channels, facts, speed_range_hz, fs_hz, duration_s, false_alarms, names, values, references, speeds,
        load, loads is None, tuple(doubts), angles,
    )  # fmt: skip
    return machine, refused


def first_readable(sources: Sequence[Source], facts: RecordingFacts) -> TakenRecording:
    """Return what is taken of the first file that can be read.

    Raises
    ------
    UsageError
        If none can; names the first one.
    """
    refused = []
    for path, row in sources:
        try:
            return take(path, replace(facts, row=row), say=False)
        except UsageError as error:
            refused.append(error)
    raise refused[0]


def _enough(usable: int, refused: Mapping[str, str]) -> None:
    if usable < FEWEST:
        count = f"{counted(usable, 'healthy recording')}; {FEWEST} are needed, 19 for a rate of false alarms of 5 %"
        raise UsageError("\n".join([*(f"{name}: {reason}" for name, reason in refused.items()), count]))


def thin_sentence(machine: Machine) -> str:
    """Return at how many references `check` will not judge, since fewer than four lie near; empty where all are met."""
    thin = [
        f"{name} ({speed:.4g} Hz)"
        for name, speed, load in zip(machine.references, machine.speed_hz, machine.load, strict=True)
        if (beside := comparable(machine, speed, None if np.isnan(load) else load)) is None
        or np.count_nonzero(beside.used) < FEWEST
    ]
    if not thin:
        return ""
    return f"fewer than {FEWEST} references, itself among them, at the speed and load of {', '.join(thin)}: record more"


def pieces_of(
    recording: MeasuredRecording,
    fs_hz: float,
    train: GearTrain,
    speed_range_hz: tuple[float, float] | None,
    duration_s: float,
) -> tuple[RecordPieces, ShaftPulses]:
    """Return the indicators of a recording's pieces at the machine's rate, and the pulses of its first shaft.

    Raises
    ------
    UsageError
        If it was sampled too slowly, no angle is certain, or a piece holds too few turns.
    """
    if recording.fs_hz < fs_hz * (1.0 - 1e-6):
        raise UsageError(
            f"{recording.path}: sampled at {recording.fs_hz:g} Hz, the references at {fs_hz:g} Hz; allowed: no less"
        )
    slow = at_rate(recording, fs_hz)
    pulses = shaft_pulses(slow, train, speed_range_hz)
    if duration_s * pulses.speed_hz < FEWEST_TURNS:
        raise UsageError(
            f"{recording.path}: pieces of {duration_s:.3g} s, as long as the shortest recording, hold "
            f"{duration_s * pulses.speed_hz:.1f} turns of the first shaft; allowed: at least {FEWEST_TURNS}. Use "
            "longer recordings, or leave the shortest out"
        )
    return record_pieces(slow, pulses, train, duration_s, IndicatorSettings()), pulses


def _slips(speed_hz: np.ndarray) -> np.ndarray:
    """Return loads read from the speeds of an induction motor's machine, 0 to 1.

    Raises
    ------
    UsageError
        If the speeds differ by less than a mains frequency wanders, or by more than slip does.
    """
    fall = 1.0 - float(speed_hz.min() / speed_hz.max())
    if not LEAST_SLIP <= fall <= MOST_SLIP:
        raise UsageError(
            f"--load slip: speeds of the references differ by {100 * fall:.2g} %; allowed: {100 * LEAST_SLIP:g} to "
            f"{100 * MOST_SLIP:g} %, as between no load and full load. Give loads as numbers, or none"
        )
    return slip_loads(speed_hz, float(speed_hz.max()), float(speed_hz.min()))


def _refuse_twice(read: Sequence[MeasuredRecording]) -> None:
    """Refuse a recording that comes twice: references that repeat each other have no spread."""
    seen: dict[bytes, Path] = {}
    for recording in read:
        start = next(iter(recording.channels.values()))[:4096].tobytes()
        if start in seen:
            raise UsageError(f"{recording.path}: has the same samples as {seen[start]}; give every recording once")
        seen[start] = recording.path
