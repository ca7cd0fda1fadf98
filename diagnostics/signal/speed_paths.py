"""Courses of speed that short spectra of a recording allow: the best paths through evidence per frame and speed.

Evidence of a speed in a frame: log power over the noise around, summed over the mesh lines and the sidebands of both
shafts that this speed would have. A path may change its speed; small changes cost as those of a random walk, large ones
(load steps) less than that. Source: multi-order path search by dynamic programming is standard literature; the price
and the weights are derived.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from diagnostics.signal.best_path import path_cells, path_totals

FRAME_TURNS = 6.0
"""Turns of the slower shaft in a frame: a Hann window of them parts its sidebands from the mesh lines."""

SHORTEST_FRAME_S, FRAMES_PER_RECORD = 0.4, 6.0
HOPS_PER_FRAME = 4
SHORT_FRAME, LONGEST_SHORT_FRAME_S, SHORT_FRAME_AROUND = 0.35, 0.25, 0.006
"""Frames that follow a load step: their share of a long one, their most, and how far they look from a known path."""

FLOOR_ORDERS = 4.0
"""Width over which the noise is taken, in orders of the slower shaft."""

MESH_WEIGHT, SIDEBAND_WEIGHT, SIDEBANDS = 2.0, 1.0, 2
FARTHEST_PER_HOP, LINEAR_FROM = 0.006, 3.0
"""Largest relative change of speed from frame to frame; deviations beyond which the price rises no more squared."""

WANDERS = (1e-3, 5e-3, 2e-4)
"""Relative changes of speed within a second (standard deviation of a random walk) of usual, loose and stiff paths."""

PATHS = 2
NONE_SAID = 0.6
"""Mean of log(1 + power over noise) where there is no line (exponential power)."""


@dataclass(frozen=True, slots=True, eq=False)
class SpeedPath:
    """A course of speed: (frames,) times [s] and speeds [Hz] of the first shaft."""

    time_s: np.ndarray
    speed_hz: np.ndarray


def line_orders(teeth: tuple[int, int], harmonics: int, sidebands: int = SIDEBANDS) -> tuple[np.ndarray, np.ndarray]:
    """Return the orders of the mesh lines (h,) and of the sidebands of both shafts (s,), in turns of the first one."""
    mesh = teeth[0] * np.arange(1.0, harmonics + 1.0)
    steps = np.array([1.0, teeth[0] / teeth[1]])
    beside = np.outer([k for k in range(-sidebands, sidebands + 1) if k], steps).ravel()
    return mesh, np.unique(np.round((mesh[:, None] + beside).ravel(), 9))


def noise_floor(power: np.ndarray, cells: int) -> np.ndarray:
    """Return the power of the noise around every cell: medians of blocks, between them straight lines.

    Parameters
    ----------
    power : (..., n) float32
        Power by frequency.
    cells : int
        Of a block.
    """
    count = max(1, power.shape[-1] // cells)
    size = min(cells, power.shape[-1])
    blocks = power[..., : count * size].reshape(*power.shape[:-1], count, size)
    medians = np.median(blocks, axis=-1) / np.float32(np.log(2.0))
    if count == 1:
        return np.broadcast_to(medians, power.shape)
    place = np.clip((np.arange(power.shape[-1]) + 0.5) / size - 0.5, 0.0, count - 1.0)
    left = np.minimum(place.astype(np.int64), count - 2)
    share = (place - left).astype(power.dtype)
    return np.asarray(medians[..., left] * (1 - share) + medians[..., left + 1] * share)


def speed_paths(
    signals: np.ndarray, fs_hz: float, teeth: tuple[int, int], limits_hz: tuple[float, float], harmonics: int
) -> Iterator[SpeedPath]:
    """Yield the best courses of speed within limits, under one price after the other.

    Parameters
    ----------
    signals : (channels, n) float32
        The recording.
    fs_hz : float
        Sampling frequency [Hz].
    teeth : (int, int)
        Of the first gear and its partner.
    limits_hz : (float, float)
        Lowest and highest speed of the first shaft [Hz].
    harmonics : int
        Mesh harmonics that are looked at.
    """
    low, high = limits_hz
    frame_s = _frame_s(_slower(low, teeth), signals.shape[1] / fs_hz)
    mesh, beside = line_orders(teeth, harmonics)
    frames = _frames(signals, fs_hz, frame_s, _slower(low, teeth), float(beside[-1] * high))
    step = 0.4 / (frame_s * float(beside[-1]) * high)
    speeds = np.exp(np.arange(np.log(low), np.log(high) + step, step))
    evidence = frames.sums(speeds, mesh, MESH_WEIGHT) + frames.sums(speeds, beside, SIDEBAND_WEIGHT)
    lobe = max(3, int(2.0 / (frame_s * teeth[0] * float(speeds.mean())) / step))
    hop_s = float(frames.time_s[1] - frames.time_s[0]) if frames.time_s.size > 1 else frame_s
    for wander in WANDERS:
        deviation = wander * np.sqrt(hop_s) / step
        for path in _best_paths(evidence, deviation, FARTHEST_PER_HOP / step, lobe, PATHS):
            yield SpeedPath(frames.time_s, speeds[path])


def followed_again(
    signals: np.ndarray, fs_hz: float, teeth: tuple[int, int], path: SpeedPath, harmonics: int
) -> SpeedPath:
    """Return a path followed by its mesh lines alone in frames so short that a load step does not smear in them.

    Parameters
    ----------
    signals, fs_hz, teeth, harmonics :
        As of `speed_paths`.
    path : SpeedPath
        What is followed again, within 0.6 %.
    """
    slower = _slower(float(path.speed_hz.min()), teeth)
    frame_s = min(SHORT_FRAME * _frame_s(slower, signals.shape[1] / fs_hz), LONGEST_SHORT_FRAME_S)
    low, high = (1 + s * SHORT_FRAME_AROUND for s in (-1, 1))
    low, high = low * float(path.speed_hz.min()), high * float(path.speed_hz.max())
    mesh, _ = line_orders(teeth, harmonics)
    frames = _frames(signals, fs_hz, frame_s, slower, float(mesh[-1] + 2.0) * high)
    step = 0.4 / (frame_s * float(mesh[-1]) * high)
    speeds = np.exp(np.arange(np.log(low), np.log(high) + step, step))
    evidence = frames.sums(speeds, mesh, MESH_WEIGHT)
    away = np.abs(np.log(speeds[None, :] / np.interp(frames.time_s, path.time_s, path.speed_hz)[:, None]))
    evidence[away > SHORT_FRAME_AROUND] = -1e3
    lobe = max(3, int(2.0 / (frame_s * teeth[0] * float(speeds.mean())) / step))
    hop_s = frame_s / HOPS_PER_FRAME
    (best,) = _best_paths(evidence, WANDERS[0] * np.sqrt(hop_s) / step, FARTHEST_PER_HOP / step, lobe, 1)
    return SpeedPath(frames.time_s, speeds[best])


def _slower(speed_hz: float, teeth: tuple[int, int]) -> float:
    return speed_hz * min(1.0, teeth[0] / teeth[1])


def _frame_s(slower_hz: float, duration_s: float) -> float:
    return min(max(FRAME_TURNS / slower_hz, SHORTEST_FRAME_S), duration_s / FRAMES_PER_RECORD)


@dataclass(frozen=True, slots=True, eq=False)
class _Frames:
    """Short spectra: times [s] of their middles, log power over noise (frames, cells), width of a cell [Hz]."""

    time_s: np.ndarray
    level: np.ndarray
    cell_hz: float

    def sums(self, speeds_hz: np.ndarray, orders: np.ndarray, weight: float) -> np.ndarray:
        """Return the weighted sum of levels at these orders, (frames, speeds); overlapping frames count half."""
        total = np.zeros((self.level.shape[0], speeds_hz.size), np.float32)
        last = self.level.shape[1] - 1
        for order in orders:
            cells = np.minimum(np.rint(order / self.cell_hz * speeds_hz), last).astype(np.intp)
            total += self.level[:, cells]
        total *= np.float32(0.5 * weight)
        return total


def _frames(signals: np.ndarray, fs_hz: float, frame_s: float, slower_hz: float, highest_hz: float) -> _Frames:
    from scipy import fft

    size = int(frame_s * fs_hz)
    starts = np.arange(0, signals.shape[1] - size + 1, max(1, size // HOPS_PER_FRAME))
    length = fft.next_fast_len(round(1.5 * size), real=True)
    cell_hz = fs_hz / length
    last = min(int(highest_hz / cell_hz) + 2, length // 2)
    window = np.hanning(size).astype(np.float32)
    block = max(16, round(FLOOR_ORDERS * slower_hz / cell_hz))
    level = np.zeros((starts.size, last + 1), np.float32)
    for signal in signals:
        frames = np.lib.stride_tricks.sliding_window_view(signal, size)[starts] * window
        spectrum = fft.rfft(frames, length, axis=1)[:, : last + 1]
        power = np.square(spectrum.real) + np.square(spectrum.imag)
        power /= noise_floor(power, block) + np.float32(1e-12) * power.max() + np.float32(1e-30)
        level += np.log1p(power) - np.float32(NONE_SAID)
    return _Frames((starts + 0.5 * size) / fs_hz, level, cell_hz)


def _best_paths(evidence: np.ndarray, deviation: float, farthest: float, lobe: int, most: int) -> list[np.ndarray]:
    """Return the speed cells (frames,) of the best paths that lie apart in the middle frame.

    `deviation`: usual change per frame, in cells; `lobe`: cells within which two paths are one.
    """
    from scipy.ndimage import maximum_filter1d

    reach = int(max(2, min(farthest, 8 * deviation + 2)))
    steps = np.abs(np.arange(-reach, reach + 1)) / deviation
    price = np.where(steps < LINEAR_FROM, 0.5 * steps**2, LINEAR_FROM * (steps - 0.5 * LINEAR_FROM)).astype(np.float32)
    ahead = path_totals(evidence, price)
    back = path_totals(evidence[::-1], price)[::-1]
    middle = len(evidence) // 2
    through = ahead[middle] + back[middle] - evidence[middle]
    peaks = np.flatnonzero(through == maximum_filter1d(through, 2 * lobe + 1))
    found = []
    for peak in peaks[np.argsort(-through[peaks])][:most].tolist():
        before = list(path_cells(ahead[:middle][::-1], price, peak))[::-1]
        found.append(np.array([*before, peak, *path_cells(back[middle + 1 :], price, peak)], dtype=np.int64))
    return found
