"""What the page shows of one channel of one record, packed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from diagnostics.explore.detail import Detail
from diagnostics.explore.extreme_buckets import drawn_signal, outside
from diagnostics.explore.order_axis import OrderAxis, decibels
from diagnostics.explore.packed import packed_floats, packed_places, packed_steps
from diagnostics.records.recording import Recording
from diagnostics.signal.envelope_spectrum import envelope_spectrum
from diagnostics.signal.order_domain import SAMPLES_PER_TOOTH, AngleGrid, angle_grid, resample_to_angle
from diagnostics.signal.synchronous_average import hann_weights, synchronous_average, whole_revolutions

DECIBEL_STEP = 0.01


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
        return angle_grid(record.tacho_s, int(record.labels["teeth_pinion"]) * SAMPLES_PER_TOOTH), ""
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
    teeth = int(record.labels["teeth_pinion"]), int(record.labels["teeth_gear"])
    amplitude = 4.0 * np.abs(fft.rfft(steps * hann_weights(steps.size))) / steps.size
    envelope = envelope_spectrum(steps, grid.revolutions, teeth[0])
    spectrum = decibels(axes.orders.largest(amplitude, grid.revolutions))
    first = None if start_rad is None else first_gear_tooth(start_rad, teeth)
    wanted = axes.detail.steps_per_tooth
    return {
        "spectrum": packed_steps(spectrum, DECIBEL_STEP),
        "envelope": packed_steps(axes.envelope_orders.largest(envelope, grid.revolutions)),
        "averages": [_average(steps, teeth[0], wanted, 0), _average(steps, teeth[1], wanted, first)],
    }


def first_gear_tooth(start_rad: float, teeth: tuple[int, int]) -> int:
    """Return the gear tooth whose pair enters contact at the first pulse: pair n is gear tooth n mod z2. Derived."""
    return math.ceil(start_rad / (2.0 * math.pi)) * teeth[0] % teeth[1]


def _average(steps: np.ndarray, teeth: int, steps_per_tooth: int, first: int | None) -> dict[str, Any] | None:
    """Return an averaged revolution, exact up to the orders that its fewer steps carry; None for no whole revolution.

    It begins at tooth 0 where `first`, the tooth at the first pulse, is known; `numbered` says so.
    """
    from scipy.signal import resample

    turns = whole_revolutions(steps, teeth, SAMPLES_PER_TOOTH)
    if turns < 1:
        return None
    average = resample(synchronous_average(steps, teeth, SAMPLES_PER_TOOTH).signal, teeth * steps_per_tooth)
    turned = np.roll(average, (first or 0) * steps_per_tooth)
    return {"turns": turns, "numbered": first is not None, **packed_steps(np.asarray(turned))}
