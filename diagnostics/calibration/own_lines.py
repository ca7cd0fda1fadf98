"""Lines of a channel that are not of the gears: low orders of shafts, other stages (orders), other machines (tones).

Errors of the teeth make lines at every order of any shaft, which the simulation has too. So of these orders only the
lowest are kept: they are of shafts, unbalance and couplings first of all. Every mesh has sidebands of every shaft too.
Multiples of a shaft that turns too rarely to tell them apart count beside its mesh lines alone.

A line stands 10 dB over the floor. It is one of the machine where it returns in at least half of the recordings: at the
same order, or else at the same frequency. At one speed the two cannot be told apart; then it is called an order.
Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.calibration.drivetrain import TrainOrders
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS
from diagnostics.calibration.order_record import LINE_BINS, OrderRecord, line_places

OVER_FLOOR, MOST_LINES, SAME_BINS = 10.0, 300, 1.6
SHAFT_ORDERS = 4
"""Multiples of a shaft's speed up to which its lines are kept; those above are the errors of the teeth."""
SIDEBANDS = 5
DENSE_BINS = 4.0 * SAME_BINS
"""Between multiples of a shaft; nearer ones leave no place for other lines."""
ON_SHAFT_BINS = 0.15
LEAST_SPREAD, UNKNOWN_SPREAD = 1.25, 2.0
"""Ratio in which a line's amplitude is drawn at least; the second where too few recordings tell it."""


@dataclass(frozen=True, slots=True)
class OwnLine:
    """A line of an order, or of a frequency where the order is 0; amplitude [unit] and its ratio between recordings."""

    order: float
    frequency_hz: float
    amplitude: float
    spread: float


def own_lines(records: Sequence[OrderRecord], drive: TrainOrders) -> tuple[OwnLine, ...]:
    """Return the lines that a channel shows beside those of the gears, the strongest first."""
    peaks = [_peaks(record, drive) for record in records]
    needed = max(1, math.ceil(0.5 * len(records)))
    found, taken = [], [np.zeros(len(one), dtype=bool) for one in peaks]
    for by_order in (True, False):
        for start, rows in enumerate(peaks):
            for k in range(len(rows)):
                if not taken[start][k]:
                    found += _matched(peaks, taken, (start, k), by_order, needed, records)
    found = [_on_shaft(line, records[0].revolutions, drive) for line in found]
    return tuple(sorted(found, key=lambda line: -line.amplitude)[:MOST_LINES])


def _peaks(record: OrderRecord, drive: TrainOrders) -> np.ndarray:
    """Return order, frequency and mean square of the lines that are not of the gears, (lines, 3)."""
    from scipy.ndimage import maximum_filter1d

    top = record.power == maximum_filter1d(record.power, 2 * LINE_BINS + 1)
    top[: 2 * LINE_BINS] = False
    places = np.flatnonzero(top & (record.power > OVER_FLOOR * record.floor * math.log(2.0)))
    places = places[record.power[places] > OVER_FLOOR * record.floor[places]]
    places = places[(places > LINE_BINS) & (places + LINE_BINS < record.power.size)]
    order = line_places(record.power, places) / record.revolutions
    order = order[~_of_teeth(order, record.revolutions, drive)]
    energy = np.array([record.line(one)[0] for one in order.tolist()])
    known = np.isfinite(energy)
    return np.stack([order[known], order[known] * record.speed_hz, energy[known]], axis=1).reshape(-1, 3)


def _of_teeth(order: np.ndarray, revolutions: int, drive: TrainOrders) -> np.ndarray:
    """Return which orders (lines,) are not told from a shaft's multiple, and from no low one: errors of the teeth."""
    told, low = SAME_BINS / revolutions, np.zeros(order.size, dtype=bool)
    of_teeth = low.copy()
    for step in (shaft.step for shaft in drive.shafts):
        number = np.round(order / step)
        on = np.abs(order - number * step) < told
        low |= on & (number <= SHAFT_ORDERS)
        if step * revolutions > DENSE_BINS:
            of_teeth |= on
        for mesh in drive.meshes:
            beside = order - np.round(order / mesh.order) * mesh.order
            sideband = np.round(beside / step)
            of_teeth |= (np.abs(sideband) <= SIDEBANDS) & (np.abs(beside - sideband * step) < told)
    return np.asarray(of_teeth & ~low)


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
    least = LEAST_SPREAD if len(records) >= FEWEST_RECORDINGS else UNKNOWN_SPREAD
    return [_line(where if by_order else 0.0, 0.0 if by_order else where, chosen[:, 2], least)]


def _on_shaft(line: OwnLine, revolutions: int, drive: TrainOrders) -> OwnLine:
    """Return a line whose order is a shaft's within what is seen as exactly that: averages shall hold it."""
    for step in (shaft.step for shaft in drive.shafts):
        nearest = round(line.order / step) * step
        if line.order and nearest and abs(line.order - nearest) * revolutions < ON_SHAFT_BINS:
            return replace(line, order=nearest)
    return line


def _line(order: float, frequency_hz: float, energy: np.ndarray, least: float) -> OwnLine:
    amplitude = np.sqrt(2.0 * energy)
    ratio = float(amplitude.max() / amplitude.min())
    return OwnLine(order, frequency_hz, float(np.median(amplitude)), max(math.sqrt(ratio), least))
