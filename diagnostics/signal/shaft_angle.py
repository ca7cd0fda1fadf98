"""The angle of a shaft without a tacho: one smooth curve through all mesh lines of all channels, or none.

Courses of speed (see `speed_paths`) are starts; from each the phases of all mesh lines together give an angle (see
`joint_phase`); lines of both shafts judge it (see `line_rivals`). It is given only if two disjoint halves of the mesh
lines agree all along and no other curve, speed or teeth explain the lines as well. The angle is right to a tenth of a
tooth pitch or it is not given; where the mesh turns, no phase is known, so the origin is free. Source: derived; limits
by docs/scripts/speed_machines.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.signal.joint_phase import (
    MeshLines,
    joint_correction,
    least_presence,
    line_strengths,
    slip_margin,
    smooth_speed,
)
from diagnostics.signal.line_envelopes import LineEnvelopes
from diagnostics.signal.line_rivals import OrderLevels, Rival, fit_nats, order_levels, rivals
from diagnostics.signal.speed_paths import SpeedPath, followed_again, speed_paths
from siggen.errors import UsageError

AGREEMENT = 0.1
"""Tooth pitches by which the two halves may differ anywhere."""

LEAST_FIT, LEAST_AHEAD, MOST_BEHIND, MOST_BEHIND_GEAR = 15.0, 5.0, 10.0, 15.0
"""Nats: of all lines; ahead of other speeds and curves; behind other teeth and speeds outside, behind other gears."""

LEAST_PRESENCE, LEAST_SLIP, PRESENCE_S = 0.35, 6.0, 0.6
"""Share of the lines in phase at any time, over so many seconds; nats against paths that end elsewhere."""

MOST_HARMONICS = 10
FEWEST_TURNS = 20
USED_BAND = 0.42
"""Share of the sampling frequency up to which mesh lines are used."""

LOWEST_RATE = 2.8
"""Samples per period of the highest line that are kept."""

STILL = 1e-9
"""Spread of a channel over its largest value below which it holds rounding alone."""

BLOW = 6.0
"""Robust standard deviations beyond which samples are clipped: blows and spikes say little of phases."""

NARROWEST_HZ, WIDEST_HZ, BELOW_SIDEBAND, FIRST_SHARE = 1.0, 8.0, 0.45, 0.01
"""Half the band about a mesh line: share of the slower shaft's rate, within limits; in the first passes at least this
share of the mesh frequency."""

PASSES, CURVE_POINTS = 3, 2001
LEAST_WHOLE = 0.15
"""Presence as which one that is less counts when curves are compared: lines that vanish for a while are seen before."""

SAME_SPEED = 2e-3
"""Relative difference of mean speeds within which another curve puts the angle in doubt, not the speed."""

KNOWN_CURVE = 1e-4
"""Relative difference of speed below which a start was tried already."""


@dataclass(frozen=True, slots=True, eq=False)
class Halves:
    """Corrections (m,) [pitches] that two disjoint halves of the lines ask for, over times (m,) [s]."""

    time_s: np.ndarray
    first: np.ndarray
    second: np.ndarray

    @property
    def apart(self) -> float:
        """Largest difference anywhere [pitches]; infinite where one half has no line."""
        if not self.time_s.size:
            return float("inf")
        difference = self.first - self.second
        return float(np.abs(difference - np.median(difference)).max())


@dataclass(frozen=True, slots=True, eq=False)
class ShaftAngle:
    """An angle by mesh lines, or a speed alone, and what speaks for it.

    Attributes
    ----------
    given : bool
        Whether the angle is given; else it is the speed only.
    time_s, turns : (k,) float64
        Turns of the first shaft over the recording [s]; of a speed only, right to some pitches.
    teeth : (int, int)
    halves : Halves
    nats : float
        What all lines say, over noise.
    slip_nats : float
        How much better this curve fits than any that ends a tenth of a pitch away or more.
    presence : float
        Least share of the lines that stands in phase at any time.
    mesh_lines : int
        Mesh lines that were used, channels times harmonics.
    others : mapping of str to Rival
        The nearest other explanation of every kind.
    levels : OrderLevels
        Lines over this angle.
    doubt : str
        Why the angle is not given; empty where it is.
    """

    given: bool
    time_s: np.ndarray
    turns: np.ndarray
    teeth: tuple[int, int]
    halves: Halves
    nats: float
    slip_nats: float
    presence: float
    mesh_lines: int
    others: Mapping[str, Rival]
    levels: OrderLevels
    doubt: str = ""

    @property
    def outcome(self) -> str:
        """What is given: `angle` or `speed only`."""
        return "angle" if self.given else "speed only"

    @property
    def speed_hz(self) -> float:
        """Mean speed of the first shaft [Hz]."""
        return float((self.turns[-1] - self.turns[0]) / (self.time_s[-1] - self.time_s[0]))

    @property
    def pulses_s(self) -> np.ndarray:
        """Times of whole turns [s], (turns,)."""
        whole = np.arange(np.ceil(self.turns[0]), np.floor(self.turns[-1]) + 1.0)
        return np.asarray(np.interp(whole, self.turns, self.time_s))

    @property
    def words(self) -> str:
        """Outcome, agreement of the halves, evidence."""
        lead = f"{self.mesh_lines} mesh lines, halves within {self.halves.apart:.2g} pitch, {self.nats:.0f} nats"
        return lead if self.given else f"{lead}; speed only: {self.doubt}"


def shaft_angle(
    channels: Mapping[str, np.ndarray], fs_hz: float, teeth: tuple[int, int], limits_hz: tuple[float, float]
) -> ShaftAngle:
    """Return the angle of the first shaft of a mesh, or its speed only.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Vibration by channel, in any unit.
    fs_hz : float
        Sampling frequency [Hz].
    teeth : (int, int)
        Of the gear on the shaft and of its partner.
    limits_hz : (float, float)
        Lowest and highest speed of the shaft [Hz].

    Raises
    ------
    UsageError
        If neither is certain, naming what was seen: no lines of these teeth, another speed or teeth that explain them
        as well, a range that misses the speed; a channel without vibration, a recording of fewer than 20 turns, a range
        that is none, a mesh above the band.
    """
    checked_limits(limits_hz)
    signals, rate_hz = _prepared(channels, fs_hz, teeth, limits_hz)
    tried = _tried(signals, rate_hz, teeth, limits_hz)
    best = max(tried, key=lambda one: one.worth)
    found = best.angle
    others = rivals(found.levels, teeth, best.harmonics, limits_hz, found.speed_hz)
    apart = [one for one in tried if np.ptp(one.angle.turns - found.turns) * teeth[0] > 2.0 * AGREEMENT]
    if apart:
        second = max(apart, key=lambda one: one.worth)
        share = found.nats / max(best.worth, 1e-9)
        behind, hz = found.nats - share * second.worth, second.angle.speed_hz
        kind = "curve" if abs(hz / found.speed_hz - 1.0) < SAME_SPEED else "speed"
        if kind not in others or behind < others[kind].behind:
            others[kind] = Rival(f"another course of {hz:.4g} Hz", behind)
    return _judged(replace(found, others=others), limits_hz, fs_hz)


def checked_limits(limits_hz: tuple[float, float]) -> None:
    """Refuse a range that is none.

    Raises
    ------
    UsageError
        If it is empty or not positive.
    """
    low, high = limits_hz
    if not 0.0 < low < high < np.inf:
        raise UsageError(f"speed range: received {low:g} to {high:g} Hz; allowed is 0 < low < high")


def _judged(found: ShaftAngle, limits_hz: tuple[float, float], fs_hz: float) -> ShaftAngle:
    """Return what is given of an angle.

    Raises
    ------
    UsageError
        If not even its speed is.
    """
    low, high = limits_hz
    rate = f"the sampling rate ({fs_hz:g} Hz as said)"
    stated, speed = f"{found.teeth[0]}/{found.teeth[1]} teeth", f"{found.speed_hz:.4g} Hz"
    if found.nats < LEAST_FIT:
        raise UsageError(
            f"no lines of {stated} stand above the noise within {low:g} to {high:g} Hz of the first shaft (best "
            f"{speed}, {found.nats:.0f} nats; allowed is {LEAST_FIT:g}). Check range, teeth and {rate}, give a "
            "longer recording or a tacho."
        )
    outside = found.others.get("outside")
    if outside and -outside.behind > MOST_BEHIND:
        raise UsageError(
            f"the lines fit {outside.name} of the first shaft best, {-outside.behind:.0f} nats ahead of {speed}, "
            f"outside of {low:g} to {high:g} Hz. Check range, teeth and {rate}, or give a tacho."
        )
    for kind, most in (("mesh", MOST_BEHIND), ("pinion", MOST_BEHIND), ("gear", MOST_BEHIND_GEAR)):
        other = found.others.get(kind)
        if other and -other.behind > most:
            raise UsageError(
                f"the lines fit {other.name} teeth better than {stated}, by {-other.behind:.0f} nats at {speed}. Check "
                f"teeth, range and {rate}."
            )
    nearest = found.others.get("speed")
    if nearest and nearest.behind < LEAST_AHEAD:
        raise UsageError(
            f"{speed} and {nearest.name} are not told apart ({nearest.behind:.1f} nats between them; allowed is "
            f"{LEAST_AHEAD:g}). Give a narrower range of the speed, a longer recording or a tacho."
        )
    doubt = _doubt(found)
    return replace(found, given=not doubt, doubt=doubt)


def _doubt(found: ShaftAngle) -> str:
    if found.halves.apart > AGREEMENT:
        return f"halves of the mesh lines differ by {found.halves.apart:.2g} tooth pitches; allowed is {AGREEMENT:g}"
    if found.presence < LEAST_PRESENCE:
        return f"the mesh lines vanish for a while: {max(found.presence, 0.0):.0%} of them are in phase"
    if found.slip_nats < LEAST_SLIP:
        return f"a curve that slips fits nearly as well ({found.slip_nats:.1f} nats; allowed is {LEAST_SLIP:g})"
    curve = found.others.get("curve")
    if curve and curve.behind < LEAST_AHEAD:
        return f"another curve of that speed fits as well ({curve.behind:.1f} nats between; allowed is {LEAST_AHEAD:g})"
    return ""


def _prepared(
    channels: Mapping[str, np.ndarray], fs_hz: float, teeth: tuple[int, int], limits_hz: tuple[float, float]
) -> tuple[np.ndarray, float]:
    """Return the channels (channels, n) float32 about their trend, of unit level, at the rate that the lines need."""
    from scipy import fft

    low, high = limits_hz
    mesh_hz = teeth[0] * low
    if mesh_hz > USED_BAND * fs_hz:
        raise UsageError(
            f"mesh frequency: received {mesh_hz:.4g} Hz at {low:g} Hz of {teeth[0]} teeth, sampled at {fs_hz:g} Hz; "
            f"allowed is {USED_BAND:g} of that. Record at a higher rate, or give a tacho."
        )
    samples = min(signal.size for signal in channels.values())
    if samples / fs_hz * high < FEWEST_TURNS:
        raise UsageError(
            f"{samples / fs_hz:.3g} s hold {samples / fs_hz * high:.3g} turns of the first shaft at {high:g} Hz; "
            f"allowed are {FEWEST_TURNS} or more. Record longer, or give a tacho."
        )
    top_hz = min((MOST_HARMONICS * teeth[0] + 5.0) * high, 0.5 * fs_hz)
    kept = min(1.0, LOWEST_RATE * top_hz / fs_hz)
    prepared = []
    for name, signal in channels.items():
        level = _about_trend(np.asarray(signal[:samples], dtype=np.float64))
        spread = float(np.median(np.abs(level))) / 0.6745
        if not spread > STILL * float(np.abs(signal).max()):
            raise UsageError(f"channel {name}: no vibration; every second sample or more is the same")
        np.clip(level, -BLOW * spread, BLOW * spread, out=level)
        if kept < 0.9:
            spectrum = fft.rfft(np.concatenate([level, np.zeros(fft.next_fast_len(samples, real=True) - samples)]))
            length = 2 * int(np.ceil(0.5 * kept * 2 * (spectrum.size - 1)))
            level = fft.irfft(spectrum[: length // 2 + 1], length)
        prepared.append((level / level.std()).astype(np.float32))
    whole = fft.next_fast_len(samples, real=True)
    whole -= whole % 2
    rate_hz = fs_hz * (prepared[0].size / whole if kept < 0.9 else 1.0)
    return np.array(prepared)[:, : int(samples / fs_hz * rate_hz)], rate_hz


def _about_trend(signal: np.ndarray) -> np.ndarray:
    """Return a signal without mean and straight line: an offset or a drift would leak into the lines."""
    place = np.linspace(-1.0, 1.0, signal.size)
    return np.asarray(signal - signal.mean() - (signal @ place) / (place @ place) * place)


@dataclass(frozen=True, slots=True, eq=False)
class _Tried:
    """An angle to which a start led, its harmonics, and what it is worth: what it explains, less where it breaks."""

    angle: ShaftAngle
    harmonics: int

    @property
    def worth(self) -> float:
        angle = self.angle
        whole = min(max(angle.presence, LEAST_WHOLE), 0.6) / 0.6 * (1.0 if angle.halves.apart < AGREEMENT else 0.5)
        return angle.nats * whole

    @property
    def clear(self) -> bool:
        angle = self.angle
        return angle.presence > 0.5 and angle.slip_nats > 10.0 and angle.halves.apart < 0.5 * AGREEMENT


def _tried(signals: np.ndarray, fs_hz: float, teeth: tuple[int, int], limits_hz: tuple[float, float]) -> list[_Tried]:
    """Return the distinct angles that starts lead to; two clear ones that are the same end the search."""
    widest = _harmonics(fs_hz, teeth, limits_hz[1])
    starts = speed_paths(signals, fs_hz, teeth, limits_hz, widest)
    envelopes = LineEnvelopes(signals, fs_hz)
    time_s = np.linspace(0.0, (signals.shape[1] - 1) / fs_hz, CURVE_POINTS)
    speeds: list[np.ndarray] = []
    tried: list[_Tried] = []
    for path, stiffness in _starts(signals, fs_hz, teeth, starts):
        speed = np.interp(time_s, path.time_s, smooth_speed(path.speed_hz, stiffness))
        if any(np.abs(speed / known - 1.0).max() < KNOWN_CURVE for known in speeds):
            continue
        speeds.append(speed)
        turns = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time_s))])
        harmonics = _harmonics(fs_hz, teeth, float(speed.max()))
        one = _refined(signals, fs_hz, envelopes, time_s, turns, teeth, harmonics, tried)
        again = [other for other in tried if _same(one, other)]
        if again and one.clear and any(other.clear for other in again):
            break
        tried.append(one)
    return tried


def _starts(
    signals: np.ndarray, fs_hz: float, teeth: tuple[int, int], paths: Iterator[SpeedPath]
) -> Iterator[tuple[SpeedPath, float]]:
    for path in paths:
        yield path, 1.0
        # short frames follow load steps, but do not part narrow sidebands: both are tried
        yield followed_again(signals, fs_hz, teeth, path, _harmonics(fs_hz, teeth, float(path.speed_hz.max()))), 4.0


def _same(one: _Tried, other: _Tried) -> bool:
    return bool(np.ptp(one.angle.turns - other.angle.turns) * one.angle.teeth[0] < AGREEMENT)


def _harmonics(fs_hz: float, teeth: tuple[int, int], speed_hz: float) -> int:
    return max(1, int(min(MOST_HARMONICS, USED_BAND * fs_hz / (teeth[0] * speed_hz))))


def _refined(
    signals: np.ndarray,
    fs_hz: float,
    envelopes: LineEnvelopes,
    time_s: np.ndarray,
    turns: np.ndarray,
    teeth: tuple[int, int],
    harmonics: int,
    known: list[_Tried],
) -> _Tried:
    """Return the angle by the phases of all mesh lines, from a start, and how well it holds."""
    mean_hz = float((turns[-1] - turns[0]) / (time_s[-1] - time_s[0]))
    beside_hz = BELOW_SIDEBAND * mean_hz * min(1.0, teeth[0] / teeth[1])
    narrow = float(np.clip(beside_hz, NARROWEST_HZ, WIDEST_HZ))
    wide = float(np.clip(max(beside_hz, FIRST_SHARE * mean_hz * teeth[0]), NARROWEST_HZ, WIDEST_HZ))
    orders = teeth[0] * np.arange(1.0, harmonics + 1.0)

    def lines(half_hz: float) -> MeshLines:
        at_s, values = envelopes.around(time_s, turns, orders, half_hz)
        harmonic = np.tile(np.arange(1.0, harmonics + 1.0), len(values))
        return MeshLines(at_s, values.reshape(harmonic.size, -1), harmonic, mean_hz * teeth[0])

    for number in range(PASSES):
        last = lines(wide if number < PASSES - 1 else narrow)
        correction = joint_correction(last, scan=number == 0)
        turns = turns + np.interp(time_s, last.time_s, correction) / teeth[0]
    final = lines(narrow)
    halves, used = _halves(final)
    margin = slip_margin(lines(wide))
    presence = least_presence(final, PRESENCE_S) if used else 0.0
    angle = ShaftAngle(
        False, time_s, turns, teeth, halves, 0.0, margin, presence, used, {}, OrderLevels(np.zeros(1), np.zeros(1), 1)
    )
    one = _Tried(angle, harmonics)
    for other in known:
        if _same(one, other):  # the same curve has the same lines
            return _Tried(replace(angle, levels=other.angle.levels, nats=other.angle.nats), harmonics)
    levels = order_levels(signals, fs_hz, time_s, turns, (harmonics + 0.5) * teeth[0] + 5.0)
    nats = float(fit_nats(levels, teeth, harmonics, np.ones(1))[0])
    return _Tried(replace(angle, levels=levels, nats=nats), harmonics)


def _halves(lines: MeshLines) -> tuple[Halves, int]:
    """Return what two disjoint halves of the lines, of equal strength, each ask for, and how many lines count."""
    strength = line_strengths(lines)
    sides, sums = np.zeros(strength.size, dtype=np.int64), [0.0, 0.0]
    for line in np.argsort(-strength):
        side = int(sums[1] < sums[0])
        sides[line], sums[side] = side, sums[side] + strength[line]
    used = strength > 0.0
    if min(np.count_nonzero(used & (sides == side)) for side in (0, 1)) < 1:
        return Halves(np.empty(0), np.empty(0), np.empty(0)), int(used.sum())
    first, second = (joint_correction(lines.chosen(used & (sides == side)), scan=False) for side in (0, 1))
    return Halves(lines.time_s, first, second), int(used.sum())
