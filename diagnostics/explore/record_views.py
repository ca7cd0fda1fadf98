"""What the page shows of one channel of one record, packed.

Fewer points of a long signal by minimum and maximum of buckets, so that no impulse is lost. Source: standard.

One axis of pinion orders for all records of a page, so that spectra can be subtracted point by point.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from diagnostics.explore.detail import Detail
from diagnostics.explore.packed import packed_floats, packed_places, packed_steps
from diagnostics.indicators.mesh_signals import mesh_signals
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.gear_train import meshes_of
from diagnostics.records.recording import Recording
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, AngleGrid, angle_grid, resample_to_angle
from diagnostics.signal.spectrum import envelope_spectrum
from diagnostics.signal.synchronous_average import hann_weights, synchronous_average, whole_revolutions

MESH_HARMONICS = 8.5
FLOOR = 1e-9

DECIBEL_STEP = 0.01


@dataclass(frozen=True, slots=True)
class Drawn:
    """Points of a signal to draw: sample numbers (n,), ascending, and values (n,)."""

    sample: np.ndarray
    value: np.ndarray


def extreme_points(signal: np.ndarray, buckets: int) -> Drawn:
    """Return the smallest and the largest sample of every bucket, at their own places.

    Parameters
    ----------
    signal : (n,) float
    buckets : int
        Number of equal stretches; a signal of at most twice as many samples comes back whole.
    """
    samples = signal.size
    if samples <= 2 * buckets:
        return Drawn(np.arange(samples), np.asarray(signal))
    edges = np.linspace(0, samples, buckets + 1).astype(np.int64)
    found = [
        low + place
        for low, high in pairwise(edges)
        for place in sorted((int(signal[low:high].argmin()), int(signal[low:high].argmax())))
    ]
    sample = np.unique(found)  # a bucket that does not vary has one extreme
    return Drawn(sample, np.asarray(signal)[sample])


def drawn_signal(signal: np.ndarray, buckets: int, fine: tuple[int, int]) -> Drawn:
    """Return extremes of a signal with every sample of one stretch.

    Parameters
    ----------
    signal : (n,) float
    buckets : int
        As of `extreme_points`.
    fine : (int, int)
        First sample of the stretch, and the one after its last.
    """
    sample = np.union1d(outside(extreme_points(signal, buckets).sample, fine), np.arange(*fine))
    return Drawn(sample, np.asarray(signal)[sample])


def outside(sample: np.ndarray, fine: tuple[int, int]) -> np.ndarray:
    """Return the sample numbers that do not lie in a stretch."""
    return np.asarray(sample[(sample < fine[0]) | (sample >= fine[1])])


@dataclass(frozen=True, slots=True)
class OrderAxis:
    """Points at orders 0, step, 2 step ...; each stands for the orders nearest to it."""

    step: float
    points: int

    def largest(self, amplitude: np.ndarray, revolutions: int) -> np.ndarray:
        """Return the largest amplitude about every point (points,); the nearest one where none lies there.

        Parameters
        ----------
        amplitude : (bins,) float64
            At orders 0, 1/revolutions ...; NaN beyond its end.
        revolutions : int
        """
        place = np.round(np.arange(amplitude.size) / (revolutions * self.step)).astype(np.int64)
        found = np.full(self.points, -np.inf)
        inside = place < self.points
        np.maximum.at(found, place[inside], amplitude[inside])
        empty = np.flatnonzero(np.isneginf(found))
        nearest = np.round(empty * self.step * revolutions).astype(np.int64)
        found[empty] = np.where(nearest < amplitude.size, amplitude[np.minimum(nearest, amplitude.size - 1)], np.nan)
        return found


def order_axis(highest_order: float, revolutions: int, points: int) -> OrderAxis:
    """Return the axis up to an order: as fine as the longest record resolves, or as the points allow."""
    step = max(1.0 / max(revolutions, 1), highest_order / max(points - 1, 1))
    return OrderAxis(step, int(highest_order / step) + 1)


def highest_order(teeth: int, fs_hz: float, slowest_hz: float) -> float:
    """Return the last pinion order shown: 8.5 mesh harmonics, or the end of the band of the slowest record."""
    return min(MESH_HARMONICS * teeth, SAMPLES_PER_TOOTH * teeth / 2, fs_hz / 2.0 / slowest_hz)


def decibels(amplitude: np.ndarray) -> np.ndarray:
    """Return levels over one unit of the channel; what is below 1e-9 of it counts as that."""
    return np.asarray(20.0 * np.log10(np.maximum(amplitude, FLOOR)))


@dataclass(frozen=True, slots=True)
class PageAxes:
    """What all records of a page share: points, orders of spectra and of envelope spectra."""

    detail: Detail
    orders: OrderAxis
    envelope_orders: OrderAxis


def record_views(record: Recording, axes: PageAxes, start_rad: float | None) -> dict[str, Any]:
    """Return the views of a record: pulse times, and by channel what can be shown; `missing` says what cannot.

    Parameters
    ----------
    record : Recording
    axes : PageAxes
    start_rad : float, optional
        Pinion angle at the first sample over the hunting period, 0 where the pair of teeth 0 enters contact; without
        it the gear's teeth cannot be told apart.
    """
    grid, missing = _grid(record)
    return {
        "pulses": packed_floats(np.asarray(record.tacho_s)[np.isfinite(record.tacho_s)]),
        "missing": missing,
        "channels": {name: _channel(signal, record, grid, axes, start_rad) for name, signal in record.channels.items()},
    }


def _grid(record: Recording) -> tuple[AngleGrid | None, str]:
    try:
        return angle_grid(record.tacho_s, record.teeth[0] * SAMPLES_PER_TOOTH), ""
    except ValueError as error:
        return None, f"No orders, averages or envelope: {error}."


def _channel(
    signal: np.ndarray, record: Recording, grid: AngleGrid | None, axes: PageAxes, start_rad: float | None
) -> dict[str, Any]:
    finite = np.isfinite(signal)
    clean = np.where(finite, signal, 0.0)
    found: dict[str, Any] = {
        "wave": packed_wave(clean, axes.detail, _fine(record, axes.detail, clean.size)),
        "undefined": int(signal.size - np.count_nonzero(finite)),
    }
    return found if grid is None else found | _of_angle(clean, record, grid, axes, start_rad)


def packed_wave(signal: np.ndarray, detail: Detail, fine: tuple[int, int]) -> dict[str, Any]:
    """Return a signal (n,) packed: places of its extremes, the stretch that is kept whole, values of both in order."""
    drawn = drawn_signal(signal, detail.buckets, fine)
    return {"sample": packed_places(outside(drawn.sample, fine)), "fine": fine, **packed_steps(drawn.value)}


def _fine(record: Recording, detail: Detail, samples: int) -> tuple[int, int]:
    """Return the stretch that is kept whole: from the first pulse on, all of it where there is room."""
    if detail.fine_samples >= samples:
        return 0, samples
    first = int(np.ceil(record.tacho_s[0] * record.fs_hz)) if len(record.tacho_s) else 0
    first = min(max(first, 0), samples - detail.fine_samples)
    return first, first + detail.fine_samples


def _of_angle(
    signal: np.ndarray, record: Recording, grid: AngleGrid, axes: PageAxes, start_rad: float | None
) -> dict[str, Any]:
    from scipy import fft

    steps = resample_to_angle(signal, record.fs_hz, grid)
    teeth = record.teeth
    amplitude = 4.0 * np.abs(fft.rfft(steps * hann_weights(steps.size))) / steps.size
    envelope = envelope_spectrum(steps, grid.revolutions, teeth[0])
    spectrum = decibels(axes.orders.largest(amplitude, grid.revolutions))
    first = None if start_rad is None else first_gear_tooth(start_rad, teeth)
    wanted = axes.detail.steps_per_tooth
    return {
        "spectrum": packed_steps(spectrum, DECIBEL_STEP),
        "envelope": packed_steps(axes.envelope_orders.largest(envelope, grid.revolutions)),
        "averages": _of_members(signal, record, wanted)
        or [_average(steps, teeth[0], wanted, 0), _average(steps, teeth[1], wanted, first)],
    }


def _of_members(signal: np.ndarray, record: Recording, steps_per_tooth: int) -> list[dict[str, Any] | None]:
    """Return the averages of sun, planet and ring against the carrier; none of a gearbox that is no planetary set."""
    train = meshes_of(record.train)
    if train[0].planets is None:
        return []
    settings = IndicatorSettings()
    (set_of_planets,) = mesh_signals({"": signal}, np.asarray(record.tacho_s), record.fs_hz, train, settings)
    own = set_of_planets.channels[""]
    return [
        _packed_average(own.shaft(shaft.name).average, shaft.teeth, shaft.revolutions, steps_per_tooth, None)
        if shaft.revolutions
        else None
        for shaft in set_of_planets.shafts
    ]


def first_gear_tooth(start_rad: float, teeth: tuple[int, int]) -> int:
    """Return the gear tooth whose pair enters contact at the first pulse: pair n is gear tooth n mod z2. Derived."""
    return math.ceil(start_rad / (2.0 * math.pi)) * teeth[0] % teeth[1]


def _average(steps: np.ndarray, teeth: int, steps_per_tooth: int, first: int | None) -> dict[str, Any] | None:
    """Return an averaged revolution, exact up to the orders that its fewer steps carry; None for no whole revolution.

    It begins at tooth 0 where `first`, the tooth at the first pulse, is known; `numbered` says so.
    """
    turns = whole_revolutions(steps, teeth, SAMPLES_PER_TOOTH)
    if turns < 1:
        return None
    average = synchronous_average(steps, teeth, SAMPLES_PER_TOOTH).signal
    return _packed_average(average, teeth, turns, steps_per_tooth, first)


def _packed_average(
    average: np.ndarray, teeth: int, turns: int, steps_per_tooth: int, first: int | None
) -> dict[str, Any]:
    from scipy.signal import resample

    turned = np.roll(resample(average, teeth * steps_per_tooth), (first or 0) * steps_per_tooth)
    return {"turns": turns, "numbered": first is not None, **packed_steps(np.asarray(turned))}
