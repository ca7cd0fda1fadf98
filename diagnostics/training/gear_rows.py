"""Averages of one turn of every gear of a record, and the rows that a network takes of them.

The rows of a gear are equal steps of its own angle, so that one network sees all gears of all gearboxes alike, whatever
their teeth. Nothing of a level is in them: sensors of unknown gain can be asked. Alone a gear has its average, and its
residual behind the inverse of its path. Beside a healthy record of the same gearbox it has the change of the residual
besides, in parts of the healthy one: as it is, and behind the inverse of the healthy record's path.

Source: `diagnostics.signal.innovations`, synchronous averaging (McFadden 1987); the rest derived.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from diagnostics.records.gear_train import Gearing, meshes_of, train_of
from diagnostics.signal.innovations import innovations, residual_lines
from diagnostics.signal.order_domain import angle_grid, resample_to_angle, shaft_grid
from siggen.errors import UsageError

STEPS = 1024
"""Angle steps of a turn; it holds orders up to 511."""
ROWS = 4
"""Residual behind the inverse of its path, average, change, change behind the inverse of the healthy path."""
ALONE = 2
"""How many of them stand without a healthy record; the others are zero there."""
BAND = 0.4
"""Part of the sampling rate up to which lines are kept: above it is no vibration, and whitening would raise it."""
TINY = 1e-30


@dataclass(frozen=True, slots=True)
class GearLines:
    """Averages of one turn of every gear, as lines.

    Attributes
    ----------
    lines : (records, channels, gears, orders) complex64
        Amplitude and phase at orders 0, 1, 2 ... of the gear's own shaft; zero where it turned less than once,
        and above the band.
    teeth : (records, gears) int
        Of every gear, in order of power.
    """

    lines: np.ndarray
    teeth: np.ndarray

    def chosen(self, places: np.ndarray) -> GearLines:
        """Return some of the records."""
        return replace(self, lines=self.lines[places], teeth=self.teeth[places])


def gear_lines(
    channels: Mapping[str, np.ndarray], tacho_s: np.ndarray, fs_hz: float, gears: Gearing
) -> tuple[np.ndarray, np.ndarray]:
    """Return the averages of one record.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Signals by channel name.
    tacho_s : (k,) float64
        Pulse times, one per turn of the first shaft.
    fs_hz : float
        Sampling frequency [Hz].
    gears : GearTrain or (int, int)
        The gearbox with its teeth, or the teeth of one pair.

    Returns
    -------
    (channels, gears, orders) complex64
        Lines, as of `GearLines`.
    (gears,) int
        Teeth.

    Raises
    ------
    UsageError
        If the gearbox is a planetary set, whose members meet each other otherwise, or there are too few pulses.
    """
    turns: dict[str, tuple[int, Fraction]] = {}
    for mesh in meshes_of(train_of(gears)):
        if mesh.planets is not None:
            raise UsageError("gears: received a planetary set; allowed: gears on shafts that stand")
        own = mesh.turns, mesh.turns * mesh.teeth[0] / mesh.teeth[1]
        turns |= {name: (z, turn) for name, z, turn in zip(mesh.names.gears, mesh.teeth, own, strict=True)}
    if len(tacho_s) < 2:
        raise UsageError(f"tacho_s: received {len(tacho_s)} pulses; allowed: 2 or more")
    found = np.zeros((len(channels), len(turns), STEPS // 2), dtype=np.complex64)
    for place, (_, turn) in enumerate(turns.values()):
        grid = angle_grid(tacho_s, STEPS) if turn == 1 else shaft_grid(tacho_s, STEPS, turn)
        if grid is not None:
            kept = min(STEPS // 2, int(BAND * fs_hz * float(np.diff(tacho_s).min() / turn)))
            for row, signal in zip(found, channels.values(), strict=True):
                wave = resample_to_angle(signal, fs_hz, grid).reshape(grid.revolutions, STEPS).mean(axis=0)
                row[place, :kept] = np.fft.rfft(wave)[:kept] * (2.0 / STEPS)
    return found, np.array([z for z, _ in turns.values()])


def gear_rows(records: GearLines, healthy: np.ndarray | None = None) -> np.ndarray:
    """Return what a network takes, (records, channels, gears, 4, 1024) float16.

    Parameters
    ----------
    records : GearLines
    healthy : (records, channels, gears, orders) complex64, optional
        Lines of a healthy record of the same gearbox, NaN where there is none; without it only two rows are not zero.
    """
    found = np.zeros((*records.lines.shape[:3], ROWS, STEPS), dtype=np.float16)
    for gear, teeth in enumerate(records.teeth.T):
        lines = records.lines[:, :, gear].astype(np.complex128)
        residual = residual_lines(lines, teeth)
        lines[:, :, 0] = 0.0
        found[:, :, gear, 0] = _unit(_wave(innovations(residual, teeth)))
        found[:, :, gear, 1] = _unit(_wave(lines))
        if healthy is None:
            continue
        known = np.isfinite(healthy[:, 0, gear, 0])
        own = residual_lines(healthy[known, :, gear].astype(np.complex128), teeth[known])
        if gear:  # pulses tell the teeth of the first one
            own = _turned(own, residual[known], teeth[known])
        change = residual[known] - own
        for row, (part, whole) in enumerate(
            ((change, own), (innovations(change, teeth[known], own), innovations(own, teeth[known]))), ALONE
        ):
            found[known, :, gear, row] = _compressed(_wave(part) / _size(_wave(whole)))
    return found


def _turned(healthy: np.ndarray, lines: np.ndarray, teeth: np.ndarray) -> np.ndarray:
    """Return healthy lines (records, channels, orders) turned by whole teeth to where they are most like the others.

    Pulses tell which tooth of the first shaft is where; a driven gear begins every record with another one.
    """
    order = np.arange(lines.shape[-1])
    found = np.empty_like(healthy)
    for row, count in enumerate(teeth.tolist()):
        folded = np.zeros(count, dtype=np.complex128)  # orders that whole teeth turn alike
        np.add.at(folded, order % count, (lines[row] * healthy[row].conj()).sum(axis=0))
        tooth = int(np.fft.ifft(folded).real.argmax())
        found[row] = healthy[row] * np.exp(-2j * np.pi * order * tooth / count)
    return found


def _wave(lines: np.ndarray) -> np.ndarray:
    """Return one turn of lines, (..., orders) to (..., steps)."""
    from scipy import fft

    return np.asarray(fft.irfft(lines * (STEPS / 2.0), n=STEPS, axis=-1))


def _size(wave: np.ndarray) -> np.ndarray:
    """Return the rms, (..., 1)."""
    return np.asarray(np.sqrt(np.square(wave).mean(axis=-1, keepdims=True)) + TINY)


def _unit(wave: np.ndarray) -> np.ndarray:
    return np.asarray(wave / _size(wave))


def _compressed(wave: np.ndarray) -> np.ndarray:
    """Return what changes spread over decades as: linear where small, logarithm where larger than the healthy rms."""
    return np.asarray(np.arcsinh(wave))
