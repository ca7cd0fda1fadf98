"""What a healthy machine adds to its mesh lines: shaft lines, floor, lines above mesh 5, modulation and tails of noise.

The record lies in equal steps of pinion angle. Densities are means of Hann windows of 40 turns, the floor of a band is
their median over 0.693. Noise is what the averages of both shafts leave. Aims: docs/understand/methods.md. Source:
standard literature; lines above mesh 5 and what returns every turn derived.

Level of a channel's noise in ten bands, measured in the half turn of the pinion in which it is weakest.

What the averages of both shafts leave is noise and motion that differs from turn to turn, such as the strokes of a
damaged tooth on one tooth after another of the mating gear. That motion stands near one angle of the pinion. Noise
stands at all angles. So one half turn, the quietest over all bands together, is left open and the rest is faded out.
Source: derived. Limits of what this hides and shows: docs/understand/audit.md, "Noise or motion".
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise

import numpy as np

from diagnostics.signal.spectrum import power
from diagnostics.signal.synchronous_average import asynchronous_part, band_signal
from diagnostics.signal.turn_spectrum import TurnLines, turn_lines

NOISE_BANDS = 10
LOWEST_NOISE_HZ, HIGHEST_NOISE_SHARE = 100.0, 0.4
OPEN_SHARE = 0.5
"""Part of the turn that is left open, a Hann window."""

SECTORS = 16
FEWEST_ORDERS = SECTORS
"""Narrower bands do not fill all sectors and have no say in which half turn is quiet."""

NOISE_LEVELS = tuple(f"noise_band{k}_db" for k in range(NOISE_BANDS))

WINDOW_TURNS, AVERAGED_TURNS, FEWEST_TURNS = 40, 44, 16
WINDOWS_AT_ONCE = 4
"""Transforms side by side take half the time; more of them hold more memory, not less time."""

MESH_LINES = 10
EXPONENTIAL_MEDIAN = 0.693
HIGHEST_HZ = 10_000.0
LINE_OVER_FLOOR, LINE_REACH = 10.0, 80
"""A line stands 10 dB over the floor of 80 bins on either side, two orders."""

NEAR_ORDER = 0.04
REPEATED_ORDERS = (100, 300)
FLOORS = {"floor_10_20hz_db": (10.0, 20.0), "floor_40_160hz_db": (40.0, 160.0), "floor_5_10khz_db": (5e3, 1e4)}
TONALITIES = {"tonality_3500_5000hz_db": (3500.0, 5000.0), "tonality_5_8khz_db": (5e3, 8e3)}
ENVELOPES = {"1_2khz": (1e3, 2e3), "2_4khz": (2e3, 4e3), "4_8khz": (4e3, 8e3)}
DEPTH_BAND_HZ = (2e3, 8e3)

SPECTRAL = (
    *(f"shaft_{k}x_db" for k in (1, 2, 3, 4)),
    *FLOORS,
    *TONALITIES,
    *("floor_slope_db", "lines_above_mesh5_per_khz", "foreign_line_share", "strongest_mesh_rms_m_s2"),
)
CYCLIC = (
    *(f"noise_{what}_{band}" for band in ENVELOPES for what in ("kurtosis", "envelope_cv")),
    *("shaft_depth", "repeated_coherence", "repeated_kurtosis"),
)
BACKGROUND_LEVELS = (*SPECTRAL, *CYCLIC, *NOISE_LEVELS)


def noise_levels(rest: TurnLines, spectrum: np.ndarray, bin_hz: float, fs_hz: float) -> dict[str, float]:
    """Return the median power per Hz in bands of equal ratio, in dB; NaN where the record does not reach.

    Parameters
    ----------
    rest : TurnLines
        What the averages of both shafts leave, in turns of the pinion.
    spectrum : (n // 2 + 1,) complex128
        Its spectrum.
    bin_hz : float
        Mean frequency step of its spectrum [Hz].
    fs_hz : float
        Sampling frequency of the record [Hz], which the bands reach up to.
    """
    edges = (np.geomspace(LOWEST_NOISE_HZ, HIGHEST_NOISE_SHARE * fs_hz, NOISE_BANDS + 1) / bin_hz).astype(int).tolist()
    every = dict(zip(NOISE_LEVELS, pairwise(edges), strict=True))
    bands = {name: (low, high) for name, (low, high) in every.items() if low < high <= spectrum.size}
    steps = len(rest.lines)
    gate = quiet_gate(spectrum, list(bands.values()), rest.turns, steps)
    density = power(rest.spectrum(gate)[: edges[-1]])
    density /= (rest.turns * steps) ** 2 * float(np.square(gate).mean()) * bin_hz
    found = dict.fromkeys(NOISE_LEVELS, math.nan)
    for name, (low, high) in bands.items():
        level = float(np.median(density[low:high]))
        found[name] = 10.0 * math.log10(level) if level > 0.0 else math.nan
    return found


def quiet_gate(spectrum: np.ndarray, bands: list[tuple[int, int]], revolutions: int, steps: int) -> np.ndarray:
    """Return a Hann window over the half turn in which all bands together are weakest, (steps,) float64.

    Every band counts by its power over its own mean, so that a strong band does not outvote the others.
    """
    profile = np.zeros(SECTORS)
    for low, high in bands:
        if high - low < FEWEST_ORDERS * revolutions:
            continue
        energy = power(band_signal(spectrum, low, high))
        # the first sample of every sector of every turn; each has at least one
        first = -(-np.arange(SECTORS * revolutions) * energy.size // (SECTORS * revolutions))
        total = np.add.reduceat(energy, first).reshape(revolutions, SECTORS).sum(axis=0)
        by_angle = total / np.diff(first, append=energy.size).reshape(revolutions, SECTORS).sum(axis=0)
        profile += by_angle / (by_angle.mean() or 1.0)
    width = round(OPEN_SHARE * SECTORS)
    running = np.convolve(np.r_[profile, profile[: width - 1]], np.ones(width), "valid")
    middle = (int(np.argmin(running)) + 0.5 * width) / SECTORS
    apart = (np.arange(steps) / steps - middle + 0.5) % 1.0 - 0.5
    return np.where(np.abs(apart) < 0.5 * OPEN_SHARE, 0.5 + 0.5 * np.cos(2.0 * np.pi * apart / OPEN_SHARE), 0.0)


def background_levels(turns: np.ndarray, shaft_hz: float, teeth: tuple[int, int], fs_hz: float) -> dict[str, float]:
    """Return all levels of one channel by name; NaN where the band or the record does not reach.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        The channel at equal angle steps, one row per pinion revolution.
    shaft_hz : float
        Mean speed of the pinion [Hz].
    teeth : (int, int)
        Teeth of pinion and gear.
    fs_hz : float
        Sampling frequency of the record [Hz], which the bands of the noise reach up to.
    """
    if turns.shape[0] < FEWEST_TURNS or not float(np.ptp(turns)) > 0.0:
        return dict.fromkeys(BACKGROUND_LEVELS, math.nan)
    centred = turns - turns.mean()
    found = spectral_levels(centred, shaft_hz, teeth)
    return found | cyclic_levels(centred, shaft_hz, teeth, fs_hz)


def spectral_levels(turns: np.ndarray, shaft_hz: float, teeth: tuple[int, int]) -> dict[str, float]:
    """Return lines and floors in dB re the strongest of ten mesh lines; parameters as of `background_levels`."""
    width = min(WINDOW_TURNS, turns.shape[0])
    windows = window_densities(turns, width, shaft_hz)
    density, step_hz = windows.mean(axis=0), shaft_hz / width
    hz = np.arange(density.size) * step_hz

    def line(order: float) -> float:
        near = round(order * width)
        return float(density[near - 2 : near + 3].sum() * step_hz)

    mesh = max(line(h * teeth[0]) for h in range(1, MESH_LINES + 1))
    floors = {name: _decibels(_floor(windows, hz, *band), mesh) for name, band in FLOORS.items()}
    lines = line_orders(density, hz, width, teeth[0])
    gear_order = teeth[0] / teeth[1]
    foreign = np.count_nonzero(~(_is_multiple(lines, 1.0) | _is_multiple(lines, gear_order)))
    span_khz = 1e-3 * (min(HIGHEST_HZ, float(hz[-1])) - 5.5 * teeth[0] * shaft_hz)
    return {
        **{f"shaft_{k}x_db": _decibels(line(float(k)), mesh) for k in (1, 2, 3, 4)},
        **floors,
        **{name: _tonality(windows, hz, *band) for name, band in TONALITIES.items()},
        "floor_slope_db": floors["floor_5_10khz_db"] - floors["floor_40_160hz_db"],
        "lines_above_mesh5_per_khz": lines.size / span_khz if span_khz > 0.0 else math.nan,
        "foreign_line_share": foreign / lines.size if lines.size else math.nan,
        "strongest_mesh_rms_m_s2": math.sqrt(mesh),
    }


def window_densities(turns: np.ndarray, width: int, shaft_hz: float) -> np.ndarray:
    """Return one-sided densities per Hz of Hann windows of `width` turns, half overlapping, (windows, orders)."""
    from scipy import fft

    size = width * turns.shape[1]
    hann = _hann(size)
    windows = np.lib.stride_tricks.sliding_window_view(turns.ravel(), size)[:: size // 2]
    found = np.empty((len(windows), size // 2 + 1))
    for first in range(0, len(windows), WINDOWS_AT_ONCE):
        some = slice(first, first + WINDOWS_AT_ONCE)
        found[some] = power(fft.rfft(windows[some] * hann, axis=1))
    found *= 2.0 / (float(np.square(hann).sum()) * turns.shape[1] * shaft_hz)
    return found


@lru_cache(maxsize=4)
def _hann(samples: int) -> np.ndarray:
    return np.hanning(samples)


def line_orders(density: np.ndarray, hz: np.ndarray, width: int, teeth: int) -> np.ndarray:
    """Return the orders of lines more than 10 dB over the floor around them, above mesh 5 and below 10 kHz (lines,)."""
    from scipy.ndimage import maximum_filter1d

    first = round(5.5 * teeth * width)
    last = min(int(np.searchsorted(hz, HIGHEST_HZ)), density.size - LINE_REACH)
    peaks = first + np.flatnonzero((density == maximum_filter1d(density, 9))[first:last])
    if not peaks.size:
        return np.empty(0)
    around = np.lib.stride_tricks.sliding_window_view(density, 2 * LINE_REACH)[peaks - LINE_REACH]
    most = density[peaks] * (EXPONENTIAL_MEDIAN / LINE_OVER_FLOOR)
    # the median lies below a number only if half of all values do: few peaks are left to take it of
    low = np.count_nonzero(around < most[:, None], axis=1) >= LINE_REACH
    return np.asarray(peaks[low][np.median(around[low], axis=1) < most[low]] / width)


def cyclic_levels(turns: np.ndarray, shaft_hz: float, teeth: tuple[int, int], fs_hz: float) -> dict[str, float]:
    """Return what returns every turn, how the rest is modulated, and its level by band; as of `background_levels`."""
    rest = turn_lines(asynchronous_part(turns, teeth).reshape(turns.shape))
    spectrum = rest.spectrum()
    bin_hz = shaft_hz / turns.shape[0]
    found: dict[str, float] = {}
    for name, (low, high) in ENVELOPES.items():
        energy = _band_energy(spectrum, low, high, bin_hz)
        found |= {f"noise_kurtosis_{name}": _kurtosis(energy), f"noise_envelope_cv_{name}": _variation(energy)}
    energy = _band_energy(spectrum, *DEPTH_BAND_HZ, bin_hz)
    depths = [_depth(energy, turns.shape[0] * order) for order in (1.0, teeth[0] / teeth[1])]
    found["shaft_depth"] = max(depths) if all(map(math.isfinite, depths)) else math.nan
    return found | _repeated(turns) | noise_levels(rest, spectrum, bin_hz, fs_hz)


def _band_energy(spectrum: np.ndarray, low_hz: float, high_hz: float, bin_hz: float) -> np.ndarray:
    """Return the squared envelope of a band; empty where the record does not reach its upper end."""
    if high_hz / bin_hz > spectrum.size:
        return np.empty(0)
    return power(band_signal(spectrum, math.ceil(low_hz / bin_hz), math.ceil(high_hz / bin_hz)))


def _kurtosis(energy: np.ndarray) -> float:
    """Return the kurtosis of the real band signal: 3/2 <|a|^4>/<|a|^2>^2, since its phase takes all values."""
    return float(1.5 * np.square(energy).mean() / energy.mean() ** 2) if energy.any() else math.nan


def _variation(energy: np.ndarray) -> float:
    envelope = np.sqrt(energy)
    return float(envelope.std() / envelope.mean()) if envelope.any() else math.nan


def _depth(energy: np.ndarray, cycles: float) -> float:
    """Return the depth of a line of so many cycles over the record in the squared envelope."""
    if not energy.any():
        return math.nan
    # sample a * block + b: the phases of a and b add up, so that 2 sqrt(n) phases do
    block = math.isqrt(energy.size) + 1
    rows = np.zeros(block * block)
    rows[: energy.size] = energy
    turn = 2j * np.pi * cycles / energy.size * np.arange(block)
    columns = np.einsum("ab,bc->ac", rows.reshape(block, block), np.exp(turn).view(np.float64).reshape(block, 2))
    line = complex(np.sum(columns.view(np.complex128)[:, 0] * np.exp(block * turn)))
    return 2.0 * abs(line) / (energy.size * float(energy.mean()))


def _repeated(turns: np.ndarray) -> dict[str, float]:
    """Return how alike the averages of both halves are in orders 100 to 300, and the kurtosis of that average."""
    from scipy import fft

    half = min(AVERAGED_TURNS, turns.shape[0]) // 2
    low, high = REPEATED_ORDERS
    halves = turns[: 2 * half].reshape(2, half, -1).mean(axis=1)
    first, second = fft.rfft(halves, axis=1)[:, low : high + 1]
    size = math.sqrt(float(power(first).sum() * power(second).sum()))
    lines = np.zeros(turns.shape[1] // 2 + 1, dtype=np.complex128)
    lines[low : low + first.size] = first + second
    square = np.square(fft.irfft(lines))
    known = size > 0.0
    return {
        "repeated_coherence": float((first * second.conj()).sum().real) / size if known else math.nan,
        "repeated_kurtosis": float(np.square(square).mean() / square.mean() ** 2) if known else math.nan,
    }


def _floor(windows: np.ndarray, hz: np.ndarray, low: float, high: float) -> float:
    inside = windows[:, slice(*np.searchsorted(hz, (low, high)))]
    if not inside.shape[1] or hz[-1] < high:
        return math.nan
    return float(np.mean(np.median(inside, axis=1))) / EXPONENTIAL_MEDIAN


def _tonality(windows: np.ndarray, hz: np.ndarray, low: float, high: float) -> float:
    """Return mean over median of every window's density: 1.59 dB for noise, whatever the number of windows."""
    inside = windows[:, slice(*np.searchsorted(hz, (low, high)))]
    if not inside.shape[1] or hz[-1] < high:
        return math.nan
    return _decibels(float(np.mean(inside.mean(axis=1) / np.median(inside, axis=1))), 1.0)


def _is_multiple(orders: np.ndarray, step: float) -> np.ndarray:
    return np.asarray(np.abs(orders / step - np.round(orders / step)) * step < NEAR_ORDER)


def _decibels(value: float, reference: float) -> float:
    return 10.0 * math.log10(value / reference) if value > 0.0 and reference > 0.0 else math.nan
