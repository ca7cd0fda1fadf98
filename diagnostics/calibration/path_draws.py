"""Transfer paths that a channel may have: magnitudes that turn simulated lines into measured ones, of minimum phase.

Only the product of path and source is seen, and in one channel all bearing forces act as one combination w F. So w is
drawn, and so are the gearboxes of the library and the recordings that a path is fitted to: the family of paths holds
what is not known. Magnitude: the cepstrally liftered floor, plus a Gaussian kernel over log2 f applied to what lines
leave beside it. Source: derived; the minimum phase by folding the cepstrum is standard literature.

A sentence where fitted paths are far from what a housing of the rig's mass can be: a unit is wrong, or a torque.

How many paths a family may have: a set's configuration holds them all, and it may have 4 MiB.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

BAND_HZ = (300.0, 5000.0)
USUAL_DB = 10.0
"""Of paths over 1/mass: 16 simulated machines of 10 to 50 kg had 0 to 24 dB, since housings ring."""
MOST_DB = 30.0

CURVE_BYTES = 5_467
"""Of 1,025 numbers as float32 in base64; a path has its frequencies and two of these for every bearing force."""
MOST_BYTES = 2_800_000

KERNEL_OCTAVES, WIDE_OCTAVES, WIDE_SHARE = 0.12, 1.0, 1e-3
LEAST_WIDTH_STEPS = 3.2
"""Of the kernel, in steps of the grid: what is narrower rings longer than the step holds."""
LIFTER, CEPSTRUM_POINTS = 240, 4096
"""240 of 8190 at 25.6 kHz: 9 ms, so that resonances 50 Hz wide are kept; lines do not show them."""
HIGH_PASS_HZ = 10.0
BENCH_CENTRE_MM, BENCH_HOUSING_KG = 97.5, (8.0, 55.0)


def housing_mass_kg(config: Mapping[str, Any]) -> Any:
    """Return the mass of a rigid housing, or the range of boxes of plates round the gears, as in a configuration.

    Boxes of 8 to 55 kg stand round gears 97.5 mm apart, of 8 mm of iron to 25 mm of steel; they grow as its cube. None
    for machines of several meshes on the ground.
    """
    if (given := (config.get("housing") or {}).get("mass_kg")) is not None:
        return given
    if "gears" not in config:
        return None
    gears = config["gears"]
    teeth = gears["pinion"]["teeth"] + gears["gear"]["teeth"]
    centre_mm = gears.get("centre_distance_mm") or 0.5 * number_limits(gears["module_mm"])[1] * teeth
    size = (number_limits(centre_mm)[1] / BENCH_CENTRE_MM) ** 3
    return [BENCH_HOUSING_KG[0] * size, BENCH_HOUSING_KG[1] * size]


def path_level_doubt(mass_kg: Any, grid_hz: np.ndarray, accelerance: np.ndarray) -> str:
    """Return what is implausible in the level of paths, or an empty text.

    Parameters
    ----------
    mass_kg : float, list or mapping
        Of the housing, as in a configuration.
    grid_hz : (k,) float64
    accelerance : (paths, k) complex128
        m/s² per N.
    """
    low, high = number_limits(mass_kg)
    inside = (grid_hz >= BAND_HZ[0]) & (grid_hz <= BAND_HZ[1])
    found_db = float(np.median(20.0 * np.log10(np.abs(accelerance[:, inside]))))
    level_db = found_db + 10.0 * np.log10(low * high) - USUAL_DB
    if abs(level_db) < MOST_DB:
        return ""
    mass = f"{low:g} kg" if low == high else f"{low:g} to {high:g} kg"
    return (
        f"doubtful: for the rig's forces the recordings are about {abs(level_db):.0f} dB too "
        f"{'high' if level_db > 0.0 else 'low'} at a housing of {mass}; are unit and sensitivity of the rig file "
        f"those of the "
        "files, and torque and module those of the machine?"
    )


def number_limits(number: Any) -> tuple[float, float]:
    """Return the bounds of a number of a configuration, which may be drawn."""
    if isinstance(number, dict):
        number = number.get("within") or next(iter(number.values()))
    return float(np.min(number)), float(np.max(number))


def family_size(wanted: int, sensors: int, forces: int) -> int:
    """Return the wanted number of paths, or what fits for so many sensors and bearing forces."""
    return max(1, min(wanted, MOST_BYTES // (CURVE_BYTES * (1 + 2 * forces) * sensors)))


@dataclass(frozen=True, slots=True)
class ChannelLines:
    """What one channel shows, over its recordings.

    Attributes
    ----------
    frequency_hz, energy_db : (recordings, groups) float64
        Where the groups lie, and their mean energy [dB re 1 unit²]; where the floor hides a line, a fifth of what its
        bins hold: a path must not lift it above the floor.
    floor_db : (recordings, CEPSTRUM_POINTS) float64
        Floor [dB] at equal steps from 0 to half the sampling rate.
    """

    frequency_hz: np.ndarray
    energy_db: np.ndarray
    floor_db: np.ndarray


@dataclass(frozen=True, slots=True)
class PathDraw:
    """One possible path: accelerance [unit/N] (frequencies,) of w F, and the direction w (forces,) of unit length."""

    accelerance: np.ndarray
    direction: np.ndarray


def liftered(floor_db: np.ndarray) -> np.ndarray:
    """Return the smooth course of a floor (points,): its cepstrum below the lifter."""
    cepstrum = np.fft.irfft(floor_db, 2 * (floor_db.size - 1))
    cepstrum[LIFTER : cepstrum.size - LIFTER + 1] = 0.0
    return np.asarray(np.fft.rfft(cepstrum).real)


def path_level_db(
    lines_hz: np.ndarray, level_db: np.ndarray, smooth_db: np.ndarray, grid_hz: np.ndarray, fs_hz: float
) -> np.ndarray:
    """Return the level of a path (k,) [dB re 1 unit/N] on a grid.

    Parameters
    ----------
    lines_hz, level_db : (m,) float64
        Lines and measured over simulated energy at them.
    smooth_db : (points,) float64
        Liftered floor from 0 to half of `fs_hz`.
    grid_hz : (k,) float64
    fs_hz : float
    """
    points_hz = np.linspace(0.0, 0.5 * fs_hz, smooth_db.size)
    beside = level_db - np.interp(lines_hz, points_hz, smooth_db)
    safe = np.maximum(grid_hz, 1.0)
    octaves = np.log2(safe[:, None] / lines_hz)
    width = np.maximum(KERNEL_OCTAVES, np.log2(1.0 + LEAST_WIDTH_STEPS * grid_hz[1] / safe))[:, None]
    weight = np.exp(-0.5 * (octaves / width) ** 2) + WIDE_SHARE * np.exp(-0.5 * (octaves / WIDE_OCTAVES) ** 2) + 1e-12
    moved = (weight @ beside) / weight.sum(axis=1)
    return np.asarray(np.interp(grid_hz, points_hz, smooth_db) + moved)


def minimum_phase(level_db: np.ndarray) -> np.ndarray:
    """Return the response (k,) of minimum phase with this level (k,) at equal steps from 0 to half the rate."""
    logarithm = level_db * (np.log(10.0) / 20.0)
    size = 2 * (level_db.size - 1)
    cepstrum = np.fft.irfft(logarithm, size)
    cepstrum[1 : size // 2] *= 2.0
    cepstrum[size // 2 + 1 :] = 0.0
    return np.asarray(np.exp(np.fft.rfft(cepstrum)))


def high_passed(response: np.ndarray, grid_hz: np.ndarray) -> np.ndarray:
    """Return a response that falls as f² below HIGH_PASS_HZ, as that of anything on feet does."""
    s = 1j * grid_hz / HIGH_PASS_HZ
    return np.asarray(response * s**2 / (s**2 + np.sqrt(2.0) * s + 1.0))


def unlike_db(lines: ChannelLines, simulated_db: np.ndarray, recordings: np.ndarray) -> np.ndarray:
    """Return the rms (n,) [dB] of what no smooth path turns levels (n, groups) into those of the recordings."""
    energy = lines.energy_db[recordings].mean(axis=0)
    known = np.isfinite(energy)
    octaves = np.log2(lines.frequency_hz[recordings].mean(axis=0)[known])
    level = (energy - simulated_db)[:, known].T
    weight = np.exp(-0.5 * ((octaves[:, None] - octaves) / KERNEL_OCTAVES) ** 2)
    rest = level - weight @ level / weight.sum(axis=1)[:, None]
    return np.asarray(np.sqrt(np.mean(rest**2, axis=0)))


def drawn_path(
    lines: ChannelLines, simulated_db: np.ndarray, recordings: np.ndarray, grid_hz: np.ndarray, fs_hz: float
) -> np.ndarray:
    """Return the accelerance (k,) that turns simulated levels (groups,) into those of the chosen recordings."""
    frequency, energy = lines.frequency_hz[recordings], lines.energy_db[recordings]
    level = energy - simulated_db
    known = np.isfinite(level)
    smooth = liftered(lines.floor_db[recordings].mean(axis=0))
    fitted = path_level_db(frequency[known], level[known], smooth, grid_hz, fs_hz)
    return high_passed(minimum_phase(fitted), grid_hz)
