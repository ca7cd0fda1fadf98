"""One smooth correction of an angle that turns the envelopes of all lines to constant phase.

Line l, of mesh harmonic h, has the envelope a exp(2 pi j h d(t)) + noise, with a constant a and the correction d(t) in
tooth pitches, which all lines share. Least squares of all lines under a price on the bend of d: that of a random walk
of the speed, with heavy tails, so that a load step passes. A search over d by dynamic programming comes first, since
the squares have a valley per pitch of every harmonic. Source: derived; penalised least squares are standard literature.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from diagnostics.signal.best_path import NOWHERE, path_cells, path_totals

WANDER = 1e-3
"""Relative change of speed within a second that is usual."""

MOST_SNR, LEAST_SNR = 3.0, 6.0
"""Power over noise per sample that one line may count at most, so that none decides alone; and, over the whole
recording, from which on it counts: of noise alone 1 in 400 does."""

SEARCHED_PITCHES, FINEST_STEP = 1.2, 0.02
ROUNDS, PASSES = 6, 3
TAIL = 3.0
"""Degrees of freedom of the bend's distribution, as of Student's t."""


@dataclass(frozen=True, slots=True, eq=False)
class MeshLines:
    """Envelopes (lines, m) at even times (m,) [s], the mesh harmonic of each (lines,), pitches per second."""

    time_s: np.ndarray
    envelopes: np.ndarray
    harmonic: np.ndarray
    pitches_hz: float

    def chosen(self, lines: np.ndarray) -> MeshLines:
        """Return some of the lines (indices or a mask)."""
        return MeshLines(self.time_s, self.envelopes[lines], self.harmonic[lines], self.pitches_hz)

    @property
    def step_s(self) -> float:
        """Time between samples."""
        return float(self.time_s[1] - self.time_s[0])

    def fit(self, correction: np.ndarray) -> _Fit:
        """Return constant gains and weights of all lines under a correction (m,) [pitches]."""
        turned = self.envelopes * np.exp(-2j * np.pi * self.harmonic[:, None] * correction)
        gain = turned.mean(axis=1)
        noise = np.median(np.abs(turned - gain[:, None]) ** 2, axis=1) / np.log(2.0) + 1e-300
        snr = np.abs(gain) ** 2 / noise - 1.0 / self.time_s.size
        snr = np.where(snr * self.time_s.size > LEAST_SNR, np.minimum(snr, MOST_SNR), 0.0)
        weight = snr / (np.abs(gain) ** 2 + 1e-300)
        return _Fit(turned * np.conj(gain)[:, None] * weight[:, None], snr)


@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """Envelopes against their gains, weighted (lines, m): of right phase real and equal to the power over noise."""

    along: np.ndarray
    snr: np.ndarray


def joint_correction(lines: MeshLines, *, scan: bool) -> np.ndarray:
    """Return the correction (m,) [pitches] that best explains all envelopes, about its median.

    `scan`: first try constant errors of speed, for which all lines are sharpest together.
    """
    correction = _constant_error(lines) if scan else np.zeros(lines.time_s.size)
    for _ in range(PASSES):
        correction = _stepped(lines, correction)
        correction = _smoothed(lines, correction)
    return correction - np.median(correction)


def slip_margin(lines: MeshLines) -> float:
    """Return how much better [nats] paths end where they are than a tenth of a pitch or more away."""
    search = _Search(lines, np.zeros(lines.time_s.size))
    if search.fit is None:
        return 0.0
    start = np.where(np.abs(search.grid) < 0.05, search.fit[0], -np.inf)
    totals = search.totals(start)[-1]
    near = np.abs(search.grid) < 0.1
    return float(totals[near].max() - totals[~near].max())


def least_presence(lines: MeshLines, window_s: float) -> float:
    """Return the least share of all lines, over a window, that stands in phase, against its median along the time."""
    from scipy.ndimage import uniform_filter1d

    along = lines.fit(np.zeros(lines.time_s.size)).along.real.sum(axis=0)
    size = max(3, int(window_s / lines.step_s))
    return float(uniform_filter1d(along, size, mode="nearest").min() / (np.median(along) + 1e-300))


def line_strengths(lines: MeshLines) -> np.ndarray:
    """Return what every line tells of the angle: squared harmonic times limited power over noise, (lines,)."""
    return np.asarray(lines.harmonic**2 * lines.fit(np.zeros(lines.time_s.size)).snr)


def _constant_error(lines: MeshLines) -> np.ndarray:
    time_s = lines.time_s - lines.time_s.mean()
    most = min(3.0 / float(lines.time_s[-1]), 0.25 / lines.step_s / float(lines.harmonic.max()))
    errors = most * np.linspace(-1.0, 1.0, 161)
    noise = lines.time_s.size * np.median(np.abs(lines.envelopes) ** 2, axis=1) / np.log(2.0) + 1e-300
    sharp = np.zeros(errors.size)
    for harmonic in np.unique(lines.harmonic):
        rows = lines.harmonic == harmonic
        sums = lines.envelopes[rows] @ np.exp(-2j * np.pi * harmonic * np.outer(time_s, errors))
        sharp += np.log1p(np.abs(sums) ** 2 / noise[rows, None]).sum(axis=0)
    return np.asarray(errors[sharp.argmax()] * time_s)


class _Search:
    """Dynamic programming over corrections near a known one; `fit` (m, grid) is None where no line counts."""

    def __init__(self, lines: MeshLines, correction: np.ndarray) -> None:
        fit = lines.fit(correction)
        used = fit.snr > 0.0
        self.fit: np.ndarray | None = None
        if not used.any():
            return
        finest = max(0.2 / float(lines.harmonic[used].max()), FINEST_STEP)
        self.grid = np.arange(-SEARCHED_PITCHES, SEARCHED_PITCHES + finest, finest)
        self.fit = np.zeros((lines.time_s.size, self.grid.size))
        for harmonic in np.unique(lines.harmonic[used]):
            along = fit.along[used & (lines.harmonic == harmonic)].sum(axis=0)
            turn = 2.0 * np.pi * harmonic * self.grid
            self.fit += 2.0 * (np.outer(along.real, np.cos(turn)) + np.outer(along.imag, np.sin(turn)))
        per_step = lines.pitches_hz * lines.step_s
        reach = int(np.clip(0.005 * per_step / finest, 2, self.grid.size // 2))
        away = np.arange(-reach, reach + 1) * finest / (3e-4 * per_step + 0.01)
        self.price = 1.5 * np.log1p(away**2)

    def totals(self, start: np.ndarray) -> np.ndarray:
        """Return, by time and correction, the most nats that a path which ends there collects, (m, grid)."""
        assert self.fit is not None
        return path_totals(np.vstack([np.maximum(start, NOWHERE), self.fit[1:]]), self.price)

    def path(self, totals: np.ndarray) -> np.ndarray:
        """Return the best path (m,) [pitches] from its end back."""
        cell = int(totals[-1].argmax())
        cells = [cell, *path_cells(totals[-2::-1], self.price, cell)]
        return np.asarray(self.grid[cells[::-1]])


def _stepped(lines: MeshLines, correction: np.ndarray) -> np.ndarray:
    """Return the correction with the steps added that fit all phases best: slips by a part of a pitch go."""
    search = _Search(lines, correction)
    if search.fit is None:
        return correction
    return np.asarray(correction + search.path(search.totals(search.fit[0])))


def _smoothed(lines: MeshLines, correction: np.ndarray) -> np.ndarray:
    """Return the correction of least squares of all phases and of its bend, linearised round after round."""
    bend_power = (WANDER * lines.pitches_hz) ** 2 * lines.step_s**3
    turn = 2.0 * np.pi * lines.harmonic
    for number in range(ROUNDS):
        fit = lines.fit(correction)
        slope = 2.0 * (turn @ fit.along.imag)
        curve = np.full(correction.size, 2.0 * float(turn**2 @ fit.snr) + 1e-9)
        bend = np.diff(correction, 2) ** 2 / bend_power
        stiffness = (TAIL + 1.0) / (TAIL + bend) if number else np.full(correction.size - 2, 0.3)
        correction = _least_squares(curve, curve * correction + slope, stiffness / bend_power)
    return correction


def _least_squares(weight: np.ndarray, right: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Solve (diag(weight) + D' diag(stiffness) D) y = right, with the second differences D."""
    from scipy.linalg import solveh_banded

    bands = np.zeros((3, weight.size))
    bands[0, 2:] = stiffness
    bands[1, 1:-1] -= 2.0 * stiffness
    bands[1, 2:] -= 2.0 * stiffness
    bands[2] = weight
    bands[2, :-2] += stiffness
    bands[2, 1:-1] += 4.0 * stiffness
    bands[2, 2:] += stiffness
    return np.asarray(solveh_banded(bands, right))


def smooth_speed(speed: np.ndarray, stiffness: float) -> np.ndarray:
    """Return a course of speed (frames,) without the steps of its grid."""
    if speed.size < 3:
        return speed
    return _least_squares(np.ones(speed.size), speed, np.full(speed.size - 2, stiffness))
