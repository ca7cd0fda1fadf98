"""The pinion speed of a recording without a tacho, and how sure it is.

Curves: in every part of the range the mesh ridge gives a speed over time (see `tacholess_angle`). Whatever line it
followed belongs to a shaft of the machine, so that all lines are sharp over its angle, though it may be a sideband or
a line of another stage. Evidence: over each of these angles all speeds of the range are tried (see `line_evidence`).
Certainty: what the best speed has of the weight of all that were tried, with noise alone and with speeds outside of
the range that are known to be taken for it. Source: derived; SCALE is chosen so that
few lines are not taken for certain.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.signal.line_evidence import MESH_MOST, LineEvidence, line_evidence
from diagnostics.signal.tacholess_angle import mesh_ridge, tacholess_pulses
from siggen.errors import UsageError

PART_RATIO, NARROW_RATIO = 1.6, 1.05
"""High over low of a part; below two, so that it holds one mesh harmonic only. Narrow ones where wide ones do not
decide: lines of two stages hardly ever lie that near."""

MESH_HARMONICS = 10
SEARCHED_S, SEARCHED_TURNS, LONGEST_SEARCHED_S = 3.0, 60, 12.0
"""The beginning of a recording that is searched; of the gear a fifth of these turns."""

MULTIPLES = (1 / 3, 0.5, 2 / 3, 0.75, 4 / 3, 1.5, 2.0, 3.0)
"""Speeds over the true one at which many of its lines are lines too."""

FEWEST_TURNS = 4
FOLLOWED, FOLLOWED_AROUND = 3, 0.007
"""Speeds whose own mesh lines are followed after that, and how far to either side, of the speed."""

LISTED = 12
"""Speeds of every curve that are looked at closely."""

SAME_SPEED = 1e-3
"""Speeds nearer than this are one; the phase of a mesh line tells them apart afterwards."""

LOBE_CELLS = 2.0
"""Half the width of a line: speeds at which the first mesh line lies in it are one; its phase tells them apart."""

SLIPPED = 0.008
"""Relative error of the speed that a slip of a few teeth leaves."""

STRETCHED = 1.1
"""A followed line is a mesh line of the pinion unless its lines are sharper by this over a stretched angle: its phase
is exact to a hundredth of a pitch, while cells of the spectrum tell the speed to half a pitch over the recording."""

SCALE = 20.0
"""A likelihood ratio e^L counts as (1 + L / SCALE)^SCALE: as it is while it is small; where thousands of lines speak,
which are neither independent nor exponential, by the share of them that a rival has too."""

OUTSIDE = 0.01
"""Weight of a speed outside of the stated range."""


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """Pulse times [s] of some shaft of the machine in a channel, and the evidence over its angle."""

    channel: str
    pulses_s: np.ndarray
    lines: LineEvidence


@dataclass(frozen=True, slots=True, eq=False)
class Tried:
    """A speed [Hz] that was tried, what speaks for it, and the curve over whose angle."""

    speed_hz: float
    evidence: float
    curve: Curve


@dataclass(frozen=True, slots=True, eq=False)
class SpeedFound:
    """The surest speed [Hz] in the range, its certainty (0 to 1) and evidence, the next speeds with their certainty."""

    speed_hz: float
    certainty: float
    evidence: float
    rivals: tuple[tuple[float, float], ...]
    curve: Curve


def speed_search(
    channels: Mapping[str, np.ndarray],
    fs_hz: float,
    teeth: tuple[int, int],
    speed_range_hz: tuple[float, float],
    part_ratio: float = PART_RATIO,
) -> SpeedFound:
    """Return the surest pinion speed in a range.

    Parameters
    ----------
    channels : mapping of str to (n,) float64
        Signals by channel.
    fs_hz : float
        Sampling frequency [Hz].
    teeth : (int, int)
        Of pinion and gear.
    speed_range_hz : (float, float)
        Lowest and highest speed of the pinion [Hz].
    part_ratio : float
        High over low of the parts in which mesh lines are followed.

    Raises
    ------
    UsageError
        If the recording is too short or sampled too slowly for a part of the range.
    """
    seconds = _searched_s(teeth, speed_range_hz[0])
    searched = {name: signal[: round(seconds * fs_hz)] for name, signal in channels.items()}
    highest_hz = min(MESH_HARMONICS * teeth[0] * speed_range_hz[1], 0.42 * fs_hz)
    sight = _Sight(searched, fs_hz, teeth, highest_hz)
    tried = [
        one
        for curve in _ridges(sight, range_parts(speed_range_hz, part_ratio))
        for one in _tried(curve, speed_range_hz)
    ]
    if not tried:
        raise UsageError(f"{FEWEST_TURNS} turns of the first shaft or fewer were found; record longer, or give a tacho")
    for one in _distinct(tried)[:FOLLOWED]:
        tried += [again for curve in _followed(sight, one) for again in _tried(curve, speed_range_hz)]
    sharp = _sharpest(tried)
    return weighed([*sharp, *_outside(max(sharp, key=_evidence), speed_range_hz)], speed_range_hz)


def weighed(tried: Sequence[Tried], speed_range_hz: tuple[float, float]) -> SpeedFound:
    """Return the speed in the range that most speaks for, its certainty and its rivals."""
    lines = max(tried, key=_evidence).curve.lines
    distinct = _distinct(tried, max(SAME_SPEED, LOBE_CELLS / (lines.revolutions * lines.teeth[0])))
    best = next(one for one in distinct if _inside(one, speed_range_hz))
    low, high = speed_range_hz
    chance = 2.0 * np.log(max(np.log(high / low) / best.curve.lines.step, 1.0))
    weight = np.array([_weight(one.evidence, best.evidence) for one in distinct])
    weight *= [1.0 if _inside(one, speed_range_hz) else OUTSIDE for one in distinct]
    own = float(best.curve.lines.at(np.array([best.speed_hz]), MESH_MOST)[0])
    share = weight / (weight.sum() + _weight(float(chance), own))
    rivals = [(one.speed_hz, float(s)) for one, s in zip(distinct, share, strict=True) if one is not best]
    first = tuple(sorted(rivals, key=lambda rival: -rival[1])[:3])
    return SpeedFound(best.speed_hz, float(share[distinct.index(best)]), best.evidence, first, best.curve)


def _sharpest(tried: Sequence[Tried]) -> list[Tried]:
    """Return what was tried, near the best speed only over the curve over which its mesh lines are sharpest.

    A curve that slipped by a tooth, as where a sideband led for a moment, is off by a little, and what the slip smears
    passes for lines of the gear.
    """
    best = max(tried, key=_evidence)
    near = [one for one in tried if abs(one.speed_hz / best.speed_hz - 1.0) < SLIPPED]
    curve = max(near, key=_sharpness).curve
    return [one for one in tried if one.curve is curve or one not in near]


def pulses_of(channels: Mapping[str, np.ndarray], fs_hz: float, found: SpeedFound) -> tuple[str, np.ndarray]:
    """Return channel and pulse times [s] of the pinion over the whole recording, at the speed that was found.

    Mesh lines are followed again around that speed, in every channel; what the search followed stands beside them if
    it reached the end, and the angle over which most lines are sharp is taken.
    """
    lines = found.curve.lines
    sight = _Sight(dict(channels), fs_hz, lines.teeth, lines.highest_hz)
    duration_s = next(iter(channels.values())).size / fs_hz
    curves = [*_followed(sight, Tried(found.speed_hz, found.evidence, found.curve))]
    if found.curve.pulses_s[-1] > duration_s - 2.0 / lines.speed_hz:
        curves.append(found.curve)
    near = (1.0 - SAME_SPEED) * found.speed_hz, (1.0 + SAME_SPEED) * found.speed_hz
    tried = [one for curve in curves for one in _tried(curve, near)]
    own = [Tried(curve.lines.speed_hz, 0.0, curve) for curve in curves if near[0] < curve.lines.speed_hz < near[1]]
    best = max([*tried, *own], key=lambda one: (STRETCHED if one in own else 1.0) * _sharpness(one))
    return best.curve.channel, _turned(best.curve.pulses_s, best.speed_hz / best.curve.lines.speed_hz)


def range_parts(speed_range_hz: tuple[float, float], ratio: float = PART_RATIO) -> list[tuple[float, float]]:
    """Return overlapping parts of a range, each of this ratio of high to low, and an overlap of at most 10 %.

    Raises
    ------
    UsageError
        If the range is empty or not positive.
    """
    low, high = speed_range_hz
    if not 0.0 < low < high < np.inf:
        raise UsageError(f"speed range: received {low:g} to {high:g} Hz; allowed is 0 < low < high")
    count = int(np.ceil(np.log(high / low) / np.log(ratio)))
    edges = low * (high / low) ** (np.arange(count + 1) / count)
    edges[-1] = high
    overlap = min(1.1, ratio)
    return [(float(a), min(high, float(b) * overlap)) for a, b in itertools.pairwise(edges)]


@dataclass(frozen=True, slots=True)
class _Sight:
    """What is looked at: channels, rate [Hz], teeth, and up to which frequency."""

    signals: dict[str, np.ndarray]
    fs_hz: float
    teeth: tuple[int, int]
    highest_hz: float

    def curve(self, channel: str, limits: tuple[float, float]) -> Curve | None:
        """Return the phase of a mesh line of a channel between two speeds; None where it is too short."""
        # In so narrow a range the lines' own skirts are the median that clarity counts from.
        signal = self.signals[channel]
        pulses = tacholess_pulses(signal, self.fs_hz, self.teeth[0], limits)
        if pulses.size <= FEWEST_TURNS:
            return None
        lines = line_evidence(tuple(self.signals.values()), pulses, self.fs_hz, self.teeth, self.highest_hz)
        return Curve(channel, pulses, lines)


def _searched_s(teeth: tuple[int, int], slowest_hz: float) -> float:
    """Return how much of the beginning is searched [s]."""
    turns_s = SEARCHED_TURNS * max(1.0, 0.2 * teeth[1] / teeth[0]) / slowest_hz
    return min(max(SEARCHED_S, turns_s), LONGEST_SEARCHED_S)


def _ridges(sight: _Sight, parts: Sequence[tuple[float, float]]) -> Iterator[Curve]:
    """Yield what the clearest channel's mesh ridge of every part of the range leads to."""
    for part in parts:
        ridges = {name: mesh_ridge(signal, sight.fs_hz, sight.teeth[0], part) for name, signal in sight.signals.items()}
        name = max(ridges, key=lambda one: ridges[one].clarity)
        curve = sight.curve(name, _limits(ridges[name].speed_hz, 0.02))
        if curve is not None:
            yield curve


def _followed(sight: _Sight, one: Tried) -> Iterator[Curve]:
    """Yield what mesh lines lead to when they are followed around a speed, in every channel."""
    pulses = _turned(one.curve.pulses_s, one.speed_hz / one.curve.lines.speed_hz)
    for name in sight.signals:
        curve = sight.curve(name, _limits(1.0 / np.diff(pulses), FOLLOWED_AROUND))
        if curve is not None:
            yield curve


def _limits(speeds_hz: np.ndarray, margin: float) -> tuple[float, float]:
    mean = float(speeds_hz.mean())
    return float(speeds_hz.min()) - margin * mean, float(speeds_hz.max()) + margin * mean


def _tried(curve: Curve, speed_range_hz: tuple[float, float]) -> Iterator[Tried]:
    """Yield the speeds in the range that, over the angle of a curve, most speaks for."""
    from scipy.ndimage import maximum_filter1d

    low, high = speed_range_hz
    grid = np.minimum(np.exp(np.arange(np.log(low), np.log(high) + curve.lines.step, curve.lines.step)), high)
    evidence = curve.lines.at(grid)
    around = 2 * int(SAME_SPEED / curve.lines.step) + 1
    highest = np.flatnonzero(evidence == maximum_filter1d(evidence, around))
    for place in highest[np.argsort(-evidence[highest])][:LISTED]:
        yield Tried(float(grid[place]), float(evidence[place]), curve)


def _outside(best: Tried, speed_range_hz: tuple[float, float]) -> Iterator[Tried]:
    """Yield the speeds outside of the range at which many lines of the best one are lines too."""
    lines = best.curve.lines
    gears = lines.teeth[1] / lines.teeth[0], lines.teeth[0] / lines.teeth[1]
    for speed in (best.speed_hz * times for times in (*MULTIPLES, *gears)):
        near = speed * np.exp(lines.step * np.arange(-4, 5))
        evidence = lines.at(near)
        one = Tried(float(near[evidence.argmax()]), float(evidence.max()), best.curve)
        if not _inside(one, speed_range_hz):
            yield one


def _distinct(tried: Sequence[Tried], apart: float = SAME_SPEED) -> list[Tried]:
    """Return those that most speaks for first, and each speed once."""
    distinct: list[Tried] = []
    for one in sorted(tried, key=lambda one: -one.evidence):
        if all(abs(one.speed_hz / known.speed_hz - 1.0) > apart for known in distinct):
            distinct.append(one)
    return distinct


def _sharpness(one: Tried) -> float:
    return one.curve.lines.sharpness(one.speed_hz)


def _evidence(one: Tried) -> float:
    return one.evidence


def _weight(evidence: float, best: float) -> float:
    return float(((1.0 + max(evidence, 0.0) / SCALE) / (1.0 + max(best, 0.0) / SCALE)) ** SCALE)


def _inside(one: Tried, speed_range_hz: tuple[float, float]) -> bool:
    low, high = speed_range_hz
    return (1.0 - SAME_SPEED) * low <= one.speed_hz <= (1.0 + SAME_SPEED) * high


def _turned(pulses_s: np.ndarray, ratio: float) -> np.ndarray:
    """Return the pulse times of a shaft that turns `ratio` times as fast."""
    turns = np.arange(pulses_s.size) * ratio
    return np.asarray(np.interp(np.arange(np.floor(turns[-1]) + 1.0), turns, pulses_s))
