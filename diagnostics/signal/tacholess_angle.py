"""Pulse times of a shaft without a tacho: a mesh line is followed in a given range of speed, then its phase is read.

First a ridge: the speed over time whose mesh harmonics hold most amplitude, as the best path through short spectra
(dynamic programming), so that neither a drift of several per cent nor a sideband above the mesh line for a moment lets
it jump. Then the phase: the record times exp(-j mesh angle) is low-passed below the first sideband of either shaft, and
what phase is left corrects the angle. Source: two-step tacholess order tracking is standard literature; details
derived.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.spectrum import power
from siggen.errors import UsageError

FRAME_REVOLUTIONS = 4.0
"""Revolutions per short spectrum: a Hann window of four keeps the sidebands one order away apart from the mesh line."""

HOPS_PER_FRAME = 8
MOST_VALUES = 200_000
"""Values that are computed at once: frames times lines times candidates."""

LARGEST_CHANGE_PER_HOP = 0.01
PHASE_BANDWIDTH_ORDERS = 0.1
"""Standard deviation of the Gaussian low-pass of the phase; a sideband 0.38 orders away (18/47 teeth) is left with
7e-4 of its amplitude."""

PASSES = 3
NOISE_EXCESS = 1.0
"""Logarithm of amplitude over its median that noise reaches (Rayleigh: 1 in 160 samples); less says nothing."""

HARMONICS = tuple(range(1, 11))
"""Structural resonances decide which mesh harmonics are strong; often it is none of the first three."""


@dataclass(frozen=True, slots=True)
class MeshRidge:
    """Speed of the shaft over time, as a mesh line shows it: (frames,) times [s], (frames,) speeds [Hz], clarity.

    Attributes
    ----------
    time_s, speed_hz : (frames,) float64
        Middle of each short spectrum and the speed found there.
    clarity : float
        Mean over frames and harmonics of how far the lines stand above noise, as natural logarithm of amplitude; white
        noise alone gives 0.01 to 0.02.
    """

    time_s: np.ndarray
    speed_hz: np.ndarray
    clarity: float


def mesh_ridge(
    signal: np.ndarray,
    fs_hz: float,
    teeth: int,
    speed_range_hz: tuple[float, float],
    harmonics: tuple[int, ...] = HARMONICS,
) -> MeshRidge:
    """Return the speed whose mesh harmonics are strongest, frame by frame.

    Parameters
    ----------
    signal : (n,) float
        The record.
    fs_hz : float
        Sampling frequency [Hz].
    teeth : int
        Teeth on the shaft.
    speed_range_hz : (float, float)
        Slowest and fastest speed to consider; narrower than one to two, else a harmonic may pass for the first one.
    harmonics : tuple of int
        Mesh harmonics whose log amplitudes are added; those above the band are left out.

    Raises
    ------
    UsageError
        If the range is empty, the record is shorter than one frame of four revolutions, or no harmonic is in the band.
    """
    _check_speed_range(speed_range_hz)
    low, high = speed_range_hz
    size = round(FRAME_REVOLUTIONS / low * fs_hz)
    if signal.size < size:
        raise UsageError(
            f"received {signal.size / fs_hz:.3g} s; following the mesh line from {low:g} Hz on needs "
            f"{FRAME_REVOLUTIONS / low:.3g} s. Use a longer record, raise the low end of the range, or give a tacho."
        )
    used = tuple(h for h in harmonics if h * teeth * high < 0.5 * fs_hz)
    if not used:
        raise UsageError(
            f"mesh frequency of {teeth * high:g} Hz lies above half the sampling rate of {fs_hz:g} Hz: no mesh line to "
            "follow. Give a tacho or a faster record."
        )
    speeds = np.arange(low, high, 0.25 * fs_hz / size / teeth / max(used))
    starts = np.arange(0, signal.size - size + 1, size // HOPS_PER_FRAME)
    lines_hz = teeth * np.outer(used, speeds)
    frames = np.lib.stride_tricks.sliding_window_view(signal, size)[starts]
    at_once = max(1, MOST_VALUES // lines_hz.size)
    pieces = (frames[k : k + at_once] for k in range(0, starts.size, at_once))
    score = np.concatenate([_frame_excess(piece, fs_hz, lines_hz).sum(axis=1) for piece in pieces])
    reach = max(1, round(LARGEST_CHANGE_PER_HOP * 0.5 * (low + high) / (speeds[1] - speeds[0])))
    path = _best_path(score, reach)
    clarity = float(score[np.arange(starts.size), path].mean() / len(used))
    return MeshRidge((starts + 0.5 * size) / fs_hz, speeds[path], clarity)


def _frame_excess(frames: np.ndarray, fs_hz: float, frequency_hz: np.ndarray) -> np.ndarray:
    """Return the excess of log amplitude over the median of each row of frequencies, and over its noise.

    Parameters
    ----------
    frames : (frames, n) float64
        Pieces of the record; weighted by a Hann window here.
    fs_hz : float
        Sampling frequency [Hz].
    frequency_hz : (lines, candidates) float64
        One row per line, one column per speed that it could have.

    Returns
    -------
    (frames, lines, candidates) float64
        Zero where a line does not stand out.
    """
    from scipy import fft

    size = frames.shape[1]
    padded = fft.next_fast_len(4 * size, real=True)
    amplitude = np.sqrt(power(fft.rfft(frames * np.hanning(size), padded, axis=1)))
    bins = np.rint(frequency_hz * padded / fs_hz).astype(np.int64)
    level = np.log(amplitude[:, bins] + (1e-12 * amplitude.max(axis=1) + 1e-300)[:, None, None])
    excess = level - np.median(level, axis=2, keepdims=True)
    return np.asarray(np.maximum(excess - NOISE_EXCESS, 0.0))


def _check_speed_range(speed_range_hz: tuple[float, float]) -> None:
    """Check that a range of speed holds one mesh harmonic only.

    Raises
    ------
    UsageError
        If it is empty or reaches from a speed to twice that speed.
    """
    low, high = speed_range_hz
    if not 0.0 < low < high < 2.0 * low:
        raise UsageError(
            f"speed range: received {low:g} to {high:g} Hz; allowed is 0 < low < high < 2 low, so that no other mesh "
            "harmonic lies in it. Give the range the shaft can have run in."
        )


def _best_path(score: np.ndarray, reach: int) -> np.ndarray:
    """Return the candidate of each frame on the path of largest sum that moves at most `reach` per frame."""
    frames, candidates = score.shape
    came_from = np.zeros((frames, candidates), dtype=np.int64)
    padded = np.full(candidates + 2 * reach, -np.inf)
    total, windows = padded[reach:-reach], np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    total[:] = score[0]
    for frame in range(1, frames):
        came_from[frame] = np.arange(candidates) + windows.argmax(axis=1) - reach
        total[:] = score[frame] + total[came_from[frame]]
    path = np.empty(frames, dtype=np.int64)
    path[-1] = total.argmax()
    for frame in range(frames - 1, 0, -1):
        path[frame - 1] = came_from[frame, path[frame]]
    return path


def tacholess_pulses(
    signal: np.ndarray,
    fs_hz: float,
    teeth: int,
    speed_range_hz: tuple[float, float],
    harmonics: tuple[int, ...] = HARMONICS,
) -> np.ndarray:
    """Return once-per-revolution pulse times of the shaft, from the mesh lines alone.

    The pulse's place on the shaft is arbitrary, so averages are shifted against those by a tacho; indicators are not.
    Drift of 4 % over the record, or up and down at 1 Hz, is followed within 0.03 of a tooth pitch at noise as strong as
    the signal (tested); speed that swings by that much within ten revolutions is not. The range has to be right, and
    there must be mesh lines: `diagnostics.signal.mesh_pulses` finds the speed, and says how certain it is.

    Parameters
    ----------
    signal, fs_hz, teeth, speed_range_hz, harmonics :
        As of `mesh_ridge`.

    Returns
    -------
    (k,) float64
        Times [s], increasing, within the record.

    Raises
    ------
    UsageError
        As `mesh_ridge`.
    """
    ridge = mesh_ridge(signal, fs_hz, teeth, speed_range_hz, harmonics)
    time_s = np.arange(signal.size) / fs_hz
    turns = np.cumsum(np.interp(time_s, ridge.time_s, _smoothed(ridge.speed_hz))) / fs_hz
    centred = np.asarray(signal, dtype=np.float64) - np.mean(signal)
    bandwidth_hz = PHASE_BANDWIDTH_ORDERS * float(ridge.speed_hz.min())
    used = [h for h in harmonics if h * teeth * float(ridge.speed_hz.max()) < 0.5 * fs_hz]
    level = [np.abs(_carrier(centred, turns, h * teeth, fs_hz, bandwidth_hz)).mean() for h in used]
    chosen = used[int(np.argmax(level))]
    for _ in range(PASSES):
        carrier = _carrier(centred, turns, chosen * teeth, fs_hz, bandwidth_hz)
        turns = turns + np.unwrap(np.angle(carrier)) / (2.0 * np.pi * chosen * teeth)
    whole = np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1)
    return np.interp(whole, turns, time_s)


def _smoothed(speed_hz: np.ndarray) -> np.ndarray:
    """Return the speed as local parabolas over two frames: what overlapping frames tell apart is only their noise."""
    from scipy.signal import savgol_filter

    width = min(2 * HOPS_PER_FRAME + 1, speed_hz.size - 1 + speed_hz.size % 2)
    return np.asarray(savgol_filter(speed_hz, width, min(2, width - 1)))


def _carrier(signal: np.ndarray, turns: np.ndarray, order: int, fs_hz: float, bandwidth_hz: float) -> np.ndarray:
    """Return the slowly varying complex amplitude of one order, (n,)."""
    from scipy import fft

    edge = round(0.5 * fs_hz / bandwidth_hz)
    length = fft.next_fast_len(signal.size + edge)
    spectrum = fft.fft(signal * np.exp(-2j * np.pi * order * turns), length)
    frequency = fft.fftfreq(length, 1.0 / fs_hz)
    return np.asarray(fft.ifft(spectrum * np.exp(-0.5 * (frequency / bandwidth_hz) ** 2))[: signal.size])
