"""Averages of one turn of every gear of a record, and the rows that a network takes of them.

The rows of a gear are equal steps of its own angle, so that one network sees all gears of all gearboxes alike, whatever
their teeth. Nothing of a level is in them: sensors of unknown gain can be asked. Alone a gear has its average, and its
residual behind the inverse of its path. Beside healthy records of the same gearbox it has the change of the residual
besides: over its noise, which the scatter from turn to turn tells, and behind the inverse of the healthy path.

Source: `diagnostics.signal.innovations`, synchronous averaging (McFadden 1987); the rest derived.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from diagnostics.records.gear_train import Gearing, meshes_of, train_of
from diagnostics.signal.innovations import innovations, residual_lines
from diagnostics.signal.order_domain import angle_grid, resample_to_angle, shaft_grid
from siggen.errors import UsageError

STEPS = 1024
"""Angle steps of a turn; it holds orders up to 511."""
ROWS = 4
"""Residual behind the inverse of its path, average, change over its noise, change behind the healthy path's inverse."""
ALONE = 2
"""How many of them stand without a healthy record; the others are zero there."""
BAND = 0.4
"""Part of the sampling rate up to which lines are kept: above it is no vibration, and whitening would raise it."""
TINY = 1e-30
ACCELERATION = "acceleration"
"""Quantity of the channels that are taken."""


@dataclass(frozen=True, slots=True)
class GearLines:
    """Averages of one turn of every gear, as lines.

    Attributes
    ----------
    lines : (records, channels, gears, orders) complex64
        Amplitude and phase at orders 0, 1, 2 ... of the gear's own shaft; zero where it turned less than once,
        and above the band.
    noise : (records, channels, gears, orders) float32
        Standard deviation of the lines, from the scatter of the turns; zero where it turned less than twice.
    teeth : (records, gears) int
        Of every gear, in order of power.
    """

    lines: np.ndarray
    noise: np.ndarray
    teeth: np.ndarray

    def chosen(self, places: np.ndarray | slice) -> GearLines:
        """Return some of the records."""
        return GearLines(*(getattr(self, name)[places] for name in PARTS))


PARTS = ("lines", "noise", "teeth")


def joined(records: Sequence[GearLines]) -> GearLines:
    """Return the records of several as one."""
    return GearLines(*(np.concatenate([getattr(record, name) for record in records]) for name in PARTS))


def gear_lines(channels: Mapping[str, np.ndarray], tacho_s: np.ndarray, fs_hz: float, gears: Gearing) -> GearLines:
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
    lines = np.zeros((len(channels), len(turns), STEPS // 2), dtype=np.complex64)
    noise = np.zeros(lines.shape, dtype=np.float32)
    for place, (_, turn) in enumerate(turns.values()):
        grid = angle_grid(tacho_s, STEPS) if turn == 1 else shaft_grid(tacho_s, STEPS, turn)
        if grid is not None:
            kept = min(STEPS // 2, int(BAND * fs_hz * float(np.diff(tacho_s).min() / turn)))
            for channel, signal in enumerate(channels.values()):
                waves = resample_to_angle(signal, fs_hz, grid).reshape(grid.revolutions, STEPS)
                each = np.fft.rfft(waves)[:, :kept] * (2.0 / STEPS)
                mean = each.mean(axis=0)
                lines[channel, place, :kept] = mean
                if grid.revolutions > 1:
                    scatter = np.square(np.abs(each - mean)).sum(axis=0) / (grid.revolutions - 1)
                    noise[channel, place, :kept] = np.sqrt(scatter / grid.revolutions)
    return GearLines(lines[None], noise[None], np.array([[z for z, _ in turns.values()]]))


def gear_rows(
    records: GearLines, healthy: GearLines | None = None, references: Sequence[np.ndarray] | np.ndarray | None = None
) -> np.ndarray:
    """Return what a network takes, (records, channels, gears, 4, 1024) float16.

    Parameters
    ----------
    records : GearLines
    healthy : GearLines, optional
        Records among which healthy ones of the same gearboxes are; without them only two rows are not zero.
    references : sequence of (k,) int, optional
        Of each record the places in `healthy` of those that it is compared with, k = 0 where there are none; default:
        all of them.
    """
    found = np.zeros((*records.lines.shape[:3], ROWS, STEPS), dtype=np.float16)
    if healthy is not None and references is None:
        references = [np.arange(len(healthy.lines))] * len(records.lines)
    for gear, teeth in enumerate(records.teeth.T):
        lines = records.lines[:, :, gear].astype(np.complex128)
        residual = residual_lines(lines, teeth)
        lines[:, :, 0] = 0.0
        found[:, :, gear, 0] = _unit(_wave(innovations(residual, teeth)))
        found[:, :, gear, 1] = _unit(_wave(lines))
        if healthy is None:
            continue
        for record, known in enumerate(() if references is None else references):
            if known.size:
                found[record, :, gear, ALONE:] = _changed(records, residual[record], record, healthy, known, gear)
    return found


def _changed(
    records: GearLines, residual: np.ndarray, record: int, healthy: GearLines, known: np.ndarray, gear: int
) -> np.ndarray:
    """Return the rows of change of a gear of a record, (channels, 2, steps)."""
    teeth = records.teeth[record, gear]
    own = residual_lines(healthy.lines[known, :, gear].astype(np.complex128), np.full(known.size, teeth))
    if gear:  # pulses tell the teeth of the first one
        own = np.stack([_turned(one, residual, int(teeth)) for one in own])
    mean = own.mean(axis=0)
    scatter = np.square(healthy.noise[known, :, gear]).mean(axis=0) / known.size
    noise = np.sqrt(np.square(records.noise[record, :, gear]) + scatter)
    change, known_noise = residual - mean, noise > 0.0
    over = np.divide(change, noise, out=np.zeros_like(change), where=known_noise)
    lines = np.maximum((known_noise & (mean != 0.0)).sum(axis=-1, keepdims=True), 1)  # half of each is in the wave
    behind, whole = (innovations(part[None], teeth[None], mean[None])[0] for part in (change, mean))
    return _compressed(np.stack([_wave(over) / np.sqrt(lines), _wave(behind) / _size(_wave(whole))], axis=1))


def _turned(healthy: np.ndarray, lines: np.ndarray, teeth: int) -> np.ndarray:
    """Return healthy lines (channels, orders) turned by whole teeth to where they are most like the others.

    Pulses tell which tooth of the first shaft is where; a driven gear begins every record with another one.
    """
    order = np.arange(lines.shape[-1])
    folded = np.zeros(teeth, dtype=np.complex128)  # orders that whole teeth turn alike
    np.add.at(folded, order % teeth, (lines * healthy.conj()).sum(axis=0))
    tooth = int(np.fft.ifft(folded).real.argmax())
    return np.asarray(healthy * np.exp(-2j * np.pi * order * tooth / teeth))


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
