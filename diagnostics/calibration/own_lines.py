"""Lines of a channel that are not of the mesh: low orders of shafts, other stages (orders), other machines (tones).

A line stands 10 dB over the floor. It is one of the machine where it returns in at least half of the recordings: at the
same order, or else at the same frequency. At one speed the two cannot be told apart; then it is called an order.
Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnostics.calibration.order_record import LINE_BINS, OrderRecord

OVER_FLOOR, MOST_LINES, SAME_BINS = 10.0, 100, 1.6
SHAFT_ORDERS = (1.0, 2.0, 3.0, 4.0)
SHAFT_SHARE = 0.75
"""Of the energy of a shaft's line that must stand over the floor."""
LEAST_SPREAD = 1.25
"""Ratio in which a line's amplitude is drawn at least."""


@dataclass(frozen=True, slots=True)
class OwnLine:
    """A line of an order, or of a frequency where the order is 0; amplitude [unit] and its ratio between recordings."""

    order: float
    frequency_hz: float
    amplitude: float
    spread: float


def own_lines(records: Sequence[OrderRecord], gear_order: float) -> tuple[OwnLine, ...]:
    """Return the lines that a channel shows beside the mesh, the strongest first."""
    peaks = [_peaks(record) for record in records]
    needed = max(1, math.ceil(0.5 * len(records)))
    found, taken = [], [np.zeros(len(one), dtype=bool) for one in peaks]
    for by_order in (True, False):
        for start, rows in enumerate(peaks):
            for k in range(len(rows)):
                if not taken[start][k]:
                    found += _matched(peaks, taken, (start, k), by_order, needed, records)
    low = (step * order for step in (1.0, gear_order) for order in SHAFT_ORDERS)
    found += [line for order in low if (line := _shaft_line(records, order)) is not None]
    return tuple(sorted(found, key=lambda line: -line.amplitude)[:MOST_LINES])


def _peaks(record: OrderRecord) -> np.ndarray:
    """Return order, frequency and mean square of the lines between those of the shafts, (lines, 3)."""
    from scipy.ndimage import maximum_filter1d

    top = (record.power == maximum_filter1d(record.power, 2 * LINE_BINS + 1)) & record.free
    places = np.flatnonzero(top & (record.power > OVER_FLOOR * record.floor * math.log(2.0)))
    places = places[record.power[places] > OVER_FLOOR * record.floor[places]]
    order = places / record.revolutions
    energy = np.array([record.line(one)[0] for one in order.tolist()])
    known = np.isfinite(energy)
    return np.stack([order[known], order[known] * record.speed_hz, energy[known]], axis=1).reshape(-1, 3)


def _matched(
    peaks: Sequence[np.ndarray],
    taken: Sequence[np.ndarray],
    start: tuple[int, int],
    by_order: bool,
    needed: int,
    records: Sequence[OrderRecord],
) -> list[OwnLine]:
    """Return the line that a peak begins, where enough recordings show it too; marks its peaks as taken."""
    column = 0 if by_order else 1
    place = peaks[start[0]][start[1], column]
    members = []
    for number, (rows, record) in enumerate(zip(peaks, records, strict=True)):
        reach = SAME_BINS / record.revolutions if by_order else SAME_BINS * record.bin_hz
        near = np.flatnonzero((np.abs(rows[:, column] - place) < reach) & ~taken[number])
        if near.size:
            members.append((number, int(near[np.argmax(rows[near, 2])])))
    if len(members) < needed:
        return []
    for number, k in members:
        taken[number][k] = True
    chosen = np.array([peaks[number][k] for number, k in members])
    where = float(chosen[:, column].mean())
    return [_line(where if by_order else 0.0, 0.0 if by_order else where, chosen[:, 2])]


def _shaft_line(records: Sequence[OrderRecord], order: float) -> OwnLine | None:
    found = [record.line(order) for record in records]
    energy = np.array([line for line, share in found if math.isfinite(line) and share > SHAFT_SHARE])
    return _line(order, 0.0, energy) if energy.size >= math.ceil(0.5 * len(records)) else None


def _line(order: float, frequency_hz: float, energy: np.ndarray) -> OwnLine:
    amplitude = np.sqrt(2.0 * energy)
    ratio = float(amplitude.max() / amplitude.min()) if amplitude.size > 1 else LEAST_SPREAD
    return OwnLine(order, frequency_hz, float(np.median(amplitude)), max(math.sqrt(ratio), LEAST_SPREAD))
