"""OrderRecord: the spectrum of one channel over turns of the first shaft, its floor, and the energy of mesh lines.

Hann spectrum, scaled so that the sum over the bins of a line is its mean square. The floor is the median over 41 bins
beside the lines of all shafts, over ln 2 (exponential distribution of a bin's power). Source: standard literature;
groups of lines derived.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from diagnostics.calibration.drivetrain import MeshOrder, TrainOrders
from diagnostics.signal.order_domain import angle_grid, resample_to_angle

FLOOR_BINS, LINE_BINS, MASK_BINS = 41, 2, 2.2
MOST_MESH_LINES = 60
PINION_SIDEBANDS = (-4, -3, -2, -1, 1, 2, 3, 4)
GEAR_SIDEBANDS = (-5, -4, -2, -1, 1, 2, 4, 5)
HIGHEST_SHARE = 0.45
"""Of the sampling rate: up to here bearing forces are simulated."""
SAME_ORDER = 1e-3
LEAST_SHARE = 0.2
"""Of a line's bins that counts as line at least, where the floor hides it."""


@dataclass(frozen=True, slots=True)
class OrderRecord:
    """One channel of one recording.

    Attributes
    ----------
    power : (bins,) float64
        Mean square per bin [unit²], one-sided.
    floor : (bins,) float64
        Floor of the power per bin.
    free : (bins,) bool
        Bins beside the lines of all shafts.
    revolutions : int
        Bins per order.
    speed_hz : float
        Mean speed of the first shaft.
    """

    power: np.ndarray
    floor: np.ndarray
    free: np.ndarray
    revolutions: int
    speed_hz: float

    @property
    def bin_hz(self) -> float:
        """Width of a bin."""
        return self.speed_hz / self.revolutions

    @property
    def density(self) -> np.ndarray:
        """One-sided density of the floor, (bins,) [unit/√Hz]."""
        return np.asarray(np.sqrt(self.floor / self.bin_hz))

    def line(self, order: float) -> tuple[float, float]:
        """Return the mean square of a line less the floor's, and its share of these bins; NaN outside the band."""
        centre = round(order * self.revolutions)
        if centre - LINE_BINS < 1 or centre + LINE_BINS >= self.power.size:
            return math.nan, math.nan
        near = slice(centre - LINE_BINS, centre + LINE_BINS + 1)
        total, floor = float(self.power[near].sum()), float(self.floor[near].sum())
        share = max(1.0 - floor / total, LEAST_SHARE) if total > 0.0 else LEAST_SHARE
        return share * total, share


def turns_of(signal: np.ndarray, fs_hz: float, pulses_s: np.ndarray) -> np.ndarray:
    """Return a signal at equal steps of pinion angle, (revolutions, steps), up to its whole band."""
    slowest = 1.0 / float(np.diff(pulses_s).max())
    grid = angle_grid(pulses_s, 2 * math.ceil(0.55 * fs_hz / slowest))
    return resample_to_angle(signal, fs_hz, grid).reshape(grid.revolutions, -1)


def order_record(signal: np.ndarray, fs_hz: float, pulses_s: np.ndarray, drive: TrainOrders) -> OrderRecord:
    """Return the record of a channel (n,) with one pulse [s] per turn of the first shaft."""
    from scipy import fft

    turns = turns_of(signal, fs_hz, pulses_s)
    flat = turns.ravel() - turns.mean()
    hann = np.hanning(flat.size)
    power = 2.0 * np.square(np.abs(fft.rfft(flat * hann))) / (flat.size * float(np.square(hann).sum()))
    speed_hz = (pulses_s.size - 1) / float(pulses_s[-1] - pulses_s[0])
    kept = min(power.size, int(0.5 * fs_hz / speed_hz * turns.shape[0]))
    free = free_bins(kept, turns.shape[0], drive)
    return OrderRecord(power[:kept], _floor(power[:kept], free), free, turns.shape[0], speed_hz)


def free_bins(bins: int, revolutions: int, drive: TrainOrders) -> np.ndarray:
    """Return which bins (bins,) lie beside all orders of all shafts; of slow ones too dense to pass are ignored."""
    order = np.arange(bins) / revolutions
    free = np.abs(order - np.round(order)) * revolutions > MASK_BINS
    for step in (shaft.step for shaft in drive.shafts[1:]):
        if step * revolutions > 4.0 * MASK_BINS:
            free &= np.abs(order - np.round(order / step) * step) * revolutions > MASK_BINS
    free[:3] = False
    return np.asarray(free)


def _floor(power: np.ndarray, free: np.ndarray) -> np.ndarray:
    from scipy.ndimage import median_filter

    places = np.flatnonzero(free)
    middle = median_filter(power[places], FLOOR_BINS, mode="nearest") / math.log(2.0) + 1e-300
    return np.asarray(np.exp(np.interp(np.arange(power.size), places, np.log(middle))))


def line_places(power: np.ndarray, bins: np.ndarray) -> np.ndarray:
    """Return where lines lie whose highest bins are known, (lines,) in bins: 0.02 off at most.

    A parabola through three logarithms.
    """
    low, middle, high = (np.log(np.maximum(power[bins + k], 1e-300)) for k in (-1, 0, 1))
    beside = 0.5 * (low - high) / np.minimum(low - 2.0 * middle + high, -1e-12)
    return np.asarray(bins + np.clip(beside, -0.5, 0.5))


@dataclass(frozen=True, slots=True)
class LineGroup:
    """Orders of lines whose mean energy is taken together: a mesh line, its sidebands of one shaft, low shaft orders.

    `mesh` is the number of the mesh, from 0; `is_line` says whether it is the line itself.
    """

    name: str
    centre: float
    orders: tuple[float, ...]
    mesh: int = 0
    is_line: bool = False


def line_groups(drive: TrainOrders, top_order: float, foreign: tuple[float, ...] = ()) -> tuple[LineGroup, ...]:
    """Return the groups below an order: of every mesh harmonic the line, sidebands of its driving and its driven shaft.

    Below all of them errors of the teeth have lines at orders of the shafts. Lines at `foreign` orders are left out:
    they are of another stage. Two meshes of one idler have one line.
    """
    found = {group.orders: group for group in _low_groups(drive, foreign)}
    for number, mesh in enumerate(drive.meshes):
        for h in range(1, MOST_MESH_LINES + 1):
            if h * mesh.order + max(PINION_SIDEBANDS) * mesh.shafts[0].step + 1.0 > top_order:
                break
            for group in _groups(mesh, number, h, foreign):
                found.setdefault(group.orders, group)
    return tuple(found.values())


def _groups(mesh: MeshOrder, number: int, h: int, foreign: tuple[float, ...]) -> Iterator[LineGroup]:
    """Yield the groups of one harmonic of a mesh."""
    centre, called = h * mesh.order, mesh.called(str(h))
    yield LineGroup(called, centre, (centre,), number, is_line=True)
    for shaft, sidebands in zip(mesh.shafts, (PINION_SIDEBANDS, GEAR_SIDEBANDS), strict=True):
        orders = _own([centre + k * shaft.step for k in sidebands], foreign)
        yield LineGroup(f"{shaft.name} sidebands of {called}", centre, orders, number)


def _low_groups(drive: TrainOrders, foreign: tuple[float, ...]) -> Iterator[LineGroup]:
    """Yield the multiples of the first two shafts from order 1 to the first sidebands, by quarters of an octave."""
    top = min(mesh.order - max(GEAR_SIDEBANDS) * mesh.shafts[0].step for mesh in drive.meshes)
    multiples = {k * shaft.step for shaft in drive.shafts[:2] for k in range(1, math.ceil(max(top, 1.0) / shaft.step))}
    orders = np.array(sorted(multiples))
    edges = 2.0 ** (0.25 * np.arange(math.floor(4.0 * math.log2(max(top, 1.0))) + 1))
    for low, high in itertools.pairwise(edges.tolist()):
        inside = orders[(orders >= low - SAME_ORDER) & (orders < high - SAME_ORDER)].tolist()
        if inside:
            yield LineGroup(f"orders {low:.3g} to {high:.3g}", math.sqrt(low * high), _own(inside, foreign))


def _own(orders: list[float], foreign: tuple[float, ...]) -> tuple[float, ...]:
    """Return the orders that are no foreign ones; all, where nothing would be left."""
    kept = tuple(order for order in orders if all(abs(order - other) > SAME_ORDER for other in foreign))
    return kept or tuple(orders)


def group_levels(record: OrderRecord, groups: tuple[LineGroup, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return mean energy [unit²] of every group and the share of it that is line, both (groups,)."""
    found = [[record.line(order) for order in group.orders] for group in groups]
    energy = np.array([np.mean([line[0] for line in lines]) for lines in found])
    return energy, np.array([np.mean([line[1] for line in lines]) for lines in found])
