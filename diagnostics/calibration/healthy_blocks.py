"""HealthyBlocks: healthy recordings as blocks that are left out one by one, each whole.

Pieces of a recording have wider lines over a higher floor per line, so levels of weak lines would rise with the number
of pieces.

A number with its interval from leaving recordings out one by one.

Source: standard literature (jackknife); limits by Student's t with as many degrees of freedom as recordings less one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from diagnostics.recordings.level_alike import check_levels_alike, level_note
from diagnostics.recordings.measured_recording import MeasuredRecording, read_recording
from diagnostics.recordings.shaft_pulses import shaft_pulses
from diagnostics.recordings.taken import RecordingFacts, Source
from diagnostics.records.gear_train import train_of
from diagnostics.statistics.evaluation import UNDEFINED, Interval
from siggen.errors import UsageError

CONFIDENCE = 0.9
FEWEST_RECORDINGS = 3
"""Fewer give no interval: two have one difference, which is small by chance too often to tell a spread."""

FEWEST_TURNS = 10


def jackknife(values: np.ndarray) -> Interval:
    """Return the mean of recordings (n,) with limits that hold it with a confidence of 90 %.

    From fewer than three recordings the limits are undefined.
    """
    from scipy.special import stdtrit

    known = np.asarray(values, dtype=np.float64)
    known = known[np.isfinite(known)]
    if not known.size:
        return UNDEFINED
    whole = float(known.mean())
    if known.size < FEWEST_RECORDINGS:
        return Interval(whole, math.nan, math.nan)
    without = np.array([np.delete(known, k).mean() for k in range(known.size)])
    error = math.sqrt((known.size - 1) / known.size * float(np.square(without - without.mean()).sum()))
    reach = float(stdtrit(known.size - 1, 0.5 + 0.5 * CONFIDENCE)) * error
    return Interval(whole, whole - reach, whole + reach)


@dataclass(frozen=True, slots=True)
class HealthyBlock:
    """One recording: name, channels (n,) [m/s²], rate, pulse times [s] of the first shaft and where they come from."""

    name: str
    channels: Mapping[str, np.ndarray]
    fs_hz: float
    pulses_s: np.ndarray
    origin: str = "tacho"

    @property
    def speed_hz(self) -> float:
        """Mean speed of the first shaft."""
        return float((self.pulses_s.size - 1) / (self.pulses_s[-1] - self.pulses_s[0]))


@dataclass(frozen=True, slots=True)
class HealthyBlocks:
    """All blocks, and the channels' names."""

    blocks: tuple[HealthyBlock, ...]
    channels: tuple[str, ...]
    fs_hz: float


def healthy_blocks(
    sources: Sequence[Source],
    channels: tuple[str, ...],
    facts: RecordingFacts,
    teeth: tuple[int, int],
    speed_range_hz: tuple[float, float] | None,
) -> HealthyBlocks:
    """Return the blocks of healthy recordings.

    Raises
    ------
    UsageError
        If a file cannot be read or used: unreadable, clipped, not finite, too short, without speed, of another rate or
        of an implausible level; names the file.
    """
    read = [read_recording(path, channels, replace(facts, row=row)) for path, row in sources]
    _check_alike(read)
    found = []
    for recording, (path, row) in zip(read, sources, strict=True):
        turning = shaft_pulses(recording, train_of(teeth), speed_range_hz)
        pulses = turning.times_s
        if pulses.size <= FEWEST_TURNS:
            raise UsageError(
                f"{path}: {pulses.size - 1} whole turns of the first shaft; allowed: at least {FEWEST_TURNS}. Record "
                "longer"
            )
        name = path.name if row is None else f"{path.name}:{row}"
        found.append(HealthyBlock(name, recording.channels, recording.fs_hz, pulses, turning.origin))
    return HealthyBlocks(tuple(found), channels, read[0].fs_hz)


def held_out_blocks(
    sources: Sequence[Source],
    fitted: HealthyBlocks,
    facts: RecordingFacts,
    teeth: tuple[int, int],
    speed_range_hz: tuple[float, float] | None,
) -> HealthyBlocks | None:
    """Return the blocks of recordings that judge a fit, None without any.

    Raises
    ------
    UsageError
        As `healthy_blocks`; also if a recording is one of the fitted ones, under whatever name.
    """
    if not sources:
        return None
    found = healthy_blocks(sources, fitted.channels, facts, teeth, speed_range_hz)
    for one, other in product(found.blocks, fitted.blocks):
        if _same_samples(one.channels, other.channels):
            raise UsageError(
                f"--held-out {one.name}: has the same samples as {other.name}, which is fitted; "
                "allowed: recordings that are not fitted"
            )
    return found


def _same_samples(one: Mapping[str, np.ndarray], other: Mapping[str, np.ndarray]) -> bool:
    return any(np.array_equal(a, b) for a, b in zip(one.values(), other.values(), strict=True))


def _check_alike(read: Sequence[MeasuredRecording]) -> None:
    first = read[0]
    for one in read[1:]:
        if abs(one.fs_hz / first.fs_hz - 1.0) > 1e-6:
            raise UsageError(
                f"{one.path}: sampled at {one.fs_hz:g} Hz, {first.path} at {first.fs_hz:g} Hz; allowed: one rate"
            )
    for one, other in combinations(read, 2):
        if _same_samples(one.channels, other.channels):
            raise UsageError(f"{other.path}: has the same samples as {one.path}; give every recording once")
    for one in read:
        if note := level_note(one):
            raise UsageError(f"{one.path}: {note}")
    check_levels_alike(read)
