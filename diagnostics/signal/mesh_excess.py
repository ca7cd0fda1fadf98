"""How far mesh lines stand above noise in short spectra, and whether they belong to another speed than the one found.

Lines at all multiples of a mesh frequency are lines of its half as well, and every second one of its double: the range
of speed has to tell which is meant. Where the lines contradict the range plainly, that is said; a wrong range is not
always found, and now and then the right one is doubted: with the right range, lines of 4 of 96 records of
configs/quickstart.yaml pass a limit in the first channel, of 1 in the clearest one. Source: derived.
"""

from __future__ import annotations

import numpy as np

NOISE_EXCESS = 1.0
"""Logarithm of amplitude over its median that noise reaches (Rayleigh: 1 in 160 samples); less says nothing."""

STRONGEST = 3
"""Lines of a kind whose mean excess is compared."""

CLEAR = 0.5
MISSING = 0.15
"""Lines between those shared with a faster shaft count as missing below this share of the second of these."""

HALVES = 0.6
THIRDS = 2.0
"""Excess of lines half-way or at thirds between the mesh lines, over that of the mesh lines, from which they are the
mesh lines themselves; strong sidebands of a few records reach the first."""


def frame_excess(frame: np.ndarray, fs_hz: float, frequency_hz: np.ndarray) -> np.ndarray:
    """Return the excess of log amplitude over the median of each row of frequencies, and over its noise.

    Parameters
    ----------
    frame : (n,) float64
        Piece of the record; weighted by a Hann window here.
    fs_hz : float
        Sampling frequency [Hz].
    frequency_hz : (lines, candidates) float64
        One row per line, one column per speed that it could have.

    Returns
    -------
    (lines, candidates) float64
        Zero where a line does not stand out.
    """
    from scipy import fft

    padded = fft.next_fast_len(4 * frame.size, real=True)
    spectrum = np.abs(fft.rfft(frame * np.hanning(frame.size), padded))
    bins = np.rint(frequency_hz * padded / fs_hz).astype(np.int64)
    level = np.log(spectrum[bins] + 1e-12 * spectrum.max() + 1e-300)
    excess = level - np.median(level, axis=1, keepdims=True)
    return np.asarray(np.maximum(excess - NOISE_EXCESS, 0.0))


def line_excess(
    frames: list[np.ndarray], fs_hz: float, mesh_hz: np.ndarray, chosen: np.ndarray, multiples: np.ndarray
) -> np.ndarray:
    """Return the mean excess of lines at multiples of the mesh frequency that was found, (lines,).

    Parameters
    ----------
    frames : list of (n,) float64
        Pieces of the record.
    fs_hz : float
        Sampling frequency [Hz].
    mesh_hz : (candidates,) float64
        Mesh frequencies in the range.
    chosen : (frames,) int
        Candidate found in each piece.
    multiples : (lines,) float64
        Of the mesh frequency; halves and thirds too.
    """
    frequency = np.outer(multiples, mesh_hz)
    mean: np.ndarray = np.mean(
        [frame_excess(frame, fs_hz, frequency)[:, k] for frame, k in zip(frames, chosen, strict=True)], axis=0
    )
    return mean


def other_speed(
    frames: list[np.ndarray], fs_hz: float, mesh_hz: np.ndarray, chosen: np.ndarray, harmonics: tuple[int, ...]
) -> str:
    """Return what the lines say against the mesh frequency that was found, or an empty text.

    Parameters
    ----------
    frames, fs_hz, mesh_hz, chosen
        As of `line_excess`.
    harmonics : tuple of int
        Mesh harmonics within the band.
    """
    order = np.asarray(harmonics, dtype=np.float64)

    def strength(multiples: np.ndarray) -> float:
        return float(np.sort(line_excess(frames, fs_hz, mesh_hz, chosen, multiples))[-STRONGEST:].mean())

    own = line_excess(frames, fs_hz, mesh_hz, chosen, order)
    for times in (2, 3):
        between, shared = own[order % times > 0], np.sort(own[order % times == 0])
        if shared.size > 1 and between.size and shared[-2] > CLEAR and between.max() < MISSING * shared[-2]:
            return f"only every {times}. mesh line is there, as if the shaft ran {times} times as fast"
    level = float(np.sort(own)[-STRONGEST:].mean())
    if strength(order - 0.5) > HALVES * level:
        return "lines stand half-way between the mesh lines, as if the shaft ran at half that speed"
    if strength(np.concatenate([order - 1 / 3, order - 2 / 3])) > THIRDS * level:
        return "stronger lines stand at thirds between the mesh lines"
    return ""
