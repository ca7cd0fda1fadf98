"""Every indicator a second time, by other means: lines by least squares, moments by scipy, envelopes by scipy.

Nothing here is taken from the package: no transform of an average, no zeroing of orders. Slow, short and plain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy import signal, stats

HARMONICS, SIDEBANDS, RATIO_SIDEBANDS, DEMODULATED, FRAME = 5, 6, 3, 3, 512


def raw_indicators(record: np.ndarray) -> dict[str, float]:
    level = math.sqrt(record.var() + record.mean() ** 2)
    _, _, spectra = signal.stft(
        record, window="hann", nperseg=FRAME, noverlap=FRAME // 2, boundary=None, padded=False, detrend=False
    )
    magnitude = np.abs(spectra)
    bands = [np.mean(band**4) / np.mean(band**2) ** 2 - 2 for band in magnitude[2:-2]]
    return {
        "rms": level,
        "kurtosis": float(stats.kurtosis(record, fisher=False)),
        "crest_factor": max(record.max(), -record.min()) / level,
        "spectral_kurtosis_maximum": float(np.nanmax(bands)),
    }


def plain_average(steps: np.ndarray, per_turn: int, weights: np.ndarray | None = None) -> np.ndarray:
    """Return the (weighted) mean over whole revolutions, revolution by revolution."""
    total, weight = np.zeros(per_turn), 0.0
    for start in range(0, steps.size - per_turn + 1, per_turn):
        turn = slice(start, start + per_turn)
        total = total + (steps[turn] if weights is None else weights[turn] * steps[turn])
        weight += 1.0 if weights is None else weights[turn].mean()
    return total / weight


def fitted(average: np.ndarray, orders: Sequence[int]) -> dict[int, complex]:
    """Return C of sum |C| cos(o angle + arg C) for the orders, fitted together by least squares."""
    angle = 2 * np.pi * np.arange(average.size) / average.size
    waves = np.stack([f(o * angle) for o in orders for f in (np.cos, np.sin)])
    found = np.linalg.lstsq(waves @ waves.T, waves @ average, rcond=1e-9)[0]  # sin of order 0 is no wave
    return {o: complex(found[2 * i], -found[2 * i + 1]) for i, o in enumerate(orders)}


def written_out(lines: dict[int, complex], size: int) -> np.ndarray:
    angle = 2 * np.pi * np.arange(size) / size
    return np.sum([abs(c) * np.cos(o * angle + np.angle(c)) for o, c in lines.items()], axis=0)


def without_fit(average: np.ndarray, teeth: int, sidebands: int) -> np.ndarray:
    """Return the average minus what a fit of shaft orders, mesh lines and so many sidebands explains."""
    top = average.size // 2
    mesh = [o + k for o in range(teeth, top + 1, teeth) for k in range(-sidebands, sidebands + 1) if o + k <= top]
    return average - written_out(fitted(average, [0, 1, 2, *mesh]), average.size)


def shaft_indicators(steps: np.ndarray, name: str, teeth: int, per_tooth: int) -> dict[str, float]:
    size = teeth * per_tooth
    average = plain_average(steps, size)
    residual, difference = without_fit(average, teeth, 0), without_fit(average, teeth, 1)
    lines = fitted(average, [h * teeth for h in range(1, HARMONICS + 1)])
    deviation = difference.std()
    values = {
        "average_rms": math.sqrt(average.var() + average.mean() ** 2),
        "average_kurtosis": stats.kurtosis(average, fisher=False),
        "average_crest_factor": max(average.max(), -average.min()) / np.linalg.norm(average) * math.sqrt(size),
        "residual_rms": residual.std(),
        "difference_rms": deviation,
        f"fm0_h{HARMONICS}": np.ptp(average) / sum(abs(c) for c in lines.values()),
        "fm4": stats.moment(difference, 4) / deviation**4,
        "m6a": stats.moment(difference, 6) / deviation**6,
        "m8a": stats.moment(difference, 8) / deviation**8,
        "energy_ratio": deviation / (average - difference).std(),
        "energy_operator_teager": stats.kurtosis(
            [residual[i] ** 2 - residual[i - 1] * residual[(i + 1) % size] for i in range(size)], fisher=False
        ),
        "energy_operator_lebold": stats.kurtosis(
            [residual[(i + 1) % size] ** 2 - residual[i] ** 2 for i in range(size)], fisher=False
        ),
        "noise_share": plain_noise_share(steps, size),
    }
    weights = signal.windows.hann(steps.size // size * size, sym=False) if name == "gear" else None
    around = plain_average(steps, size, weights)
    found = {**values, **sideband_indicators(around, average.std(), teeth), **modulation_depths(around, teeth)}
    named = {_with_shaft(key, name): float(value) for key, value in found.items()}
    return named | ({f"mesh_amplitude_h{o // teeth}": abs(c) for o, c in lines.items()} if name == "pinion" else {})


def _with_shaft(key: str, name: str) -> str:
    """Put the shaft before `_h1`, `_k2`."""
    words = key.split("_")
    place = next((i for i, w in enumerate(words) if w[0] in "hk" and w[1:].isdigit()), len(words))
    return "_".join([*words[:place], name, *words[place:]])


def plain_noise_share(steps: np.ndarray, size: int) -> float:
    turns = [steps[i : i + size] for i in range(0, steps.size - size + 1, size)]
    between = np.mean([np.var([turn[i] for turn in turns], ddof=1) for i in range(size)])
    return float(between / len(turns) / np.var(np.mean(turns, axis=0)))


def sideband_indicators(average: np.ndarray, spread: float, teeth: int) -> dict[str, float]:
    wanted = [h * teeth + k for h in range(1, HARMONICS + 1) for k in range(-SIDEBANDS, SIDEBANDS + 1)]
    a = {o: abs(c) for o, c in fitted(average, wanted).items()}
    values = {
        "sideband_index_h1": (a[teeth - 1] + a[teeth + 1]) / 2,
        "sideband_level_factor_h1": (a[teeth - 1] + a[teeth + 1]) / spread,
    }
    for h in range(1, HARMONICS + 1):
        z = h * teeth
        six = (a[z - 3], a[z - 2], a[z - 1], a[z + 1], a[z + 2], a[z + 3])
        values[f"sideband_ratio_h{h}_k{RATIO_SIDEBANDS}"] = sum(six) / a[z]
        values[f"sideband_asymmetry_h{h}"] = 20 * math.log10(a[z + 1] / a[z - 1])
        for k in range(1, SIDEBANDS + 1):
            values[f"sideband_h{h}_lower{k}"] = a[z - k] / a[z]
            values[f"sideband_h{h}_upper{k}"] = a[z + k] / a[z]
    mesh = sum(a[h * teeth] ** 2 for h in range(1, HARMONICS + 1))
    for k in range(1, SIDEBANDS + 1):
        both = sum(a[h * teeth - k] ** 2 + a[h * teeth + k] ** 2 for h in range(1, HARMONICS + 1))
        values[f"sideband_power_h{HARMONICS}_k{k}"] = both / mesh
    return values


def band(average: np.ndarray, teeth: int, harmonic: int) -> dict[int, complex]:
    return fitted(average, range(harmonic * teeth - SIDEBANDS, harmonic * teeth + SIDEBANDS + 1))


def modulation_depths(average: np.ndarray, teeth: int) -> dict[str, float]:
    """Return depths from the phasor of each mesh line, its sidebands turning about it."""
    angle = 2 * np.pi * np.arange(average.size) / average.size
    values = {}
    for h in range(1, DEMODULATED + 1):
        phasor = sum(c * np.exp(1j * (o - h * teeth) * angle) for o, c in band(average, teeth, h).items())
        size, phase = np.abs(phasor), np.unwrap(np.angle(phasor))
        values[f"amplitude_modulation_h{h}"] = 2 * abs(np.mean(size * np.exp(-1j * angle))) / size.mean()
        values[f"phase_modulation_h{h}"] = 2 * abs(np.mean(phase * np.exp(-1j * angle)))
    return values


BANDS = [round(75 * 2 ** (k / 2)) for k in range(-6, 7)]
"""Edges [shaft orders]; the band from the k-th to the (k + 2)-th."""


def band_indicators(average: np.ndarray, name: str, teeth: int, carried: float) -> dict[str, float]:
    """Return both indicators of every band, its lines by correlation, its envelope by scipy, pitch by pitch."""
    angle, pitch = 2 * np.pi * np.arange(average.size) / average.size, average.size // teeth
    values = {}
    for low, high in zip(BANDS, BANDS[2:], strict=False):
        orders = [o for o in range(low, high) if o % teeth and o <= carried]
        part = np.zeros(average.size)
        for o in orders:
            part += 2 * np.real(np.mean(average * np.exp(-1j * o * angle)) * np.exp(1j * o * angle))
        known = sum(low <= o <= carried for o in range(low, high)) >= (high - low) / 2
        energy = np.abs(signal.hilbert(part)) ** 2
        most = max(np.take(energy, range(i, i + pitch), mode="wrap").mean() for i in range(average.size))
        ending = f"{name}_o{low}_{high}"
        values[f"band_kurtosis_{ending}"] = stats.kurtosis(part, fisher=False) if known else math.nan
        values[f"band_localised_energy_{ending}"] = most / energy.mean() if known else math.nan
    return values


def cepstral_peaks(steps: np.ndarray, turns: int, teeth: tuple[int, int], highest: int) -> dict[str, float]:
    """Return the largest of three direct cosine sums round the quefrency of each shaft's revolution."""
    amplitude = np.abs(np.fft.rfft(steps * signal.windows.hann(steps.size, sym=False)))
    level = np.log(np.maximum(amplitude, 1e-9 * amplitude.max()))[: highest * turns + 1]
    spacing = teeth[0] * turns
    for line in range(spacing, level.size, spacing):
        last = min(line + 2, level.size - 1)
        right = level[last + 1] if last + 1 < level.size else level[line - 3]
        for i in range(line - 2, last + 1):
            level[i] = level[line - 3] + (right - level[line - 3]) * (i - line + 3) / (last + 1 - line + 3)
    level = level - level.mean()
    index, length = np.arange(level.size), 2 * (level.size - 1)
    counted = np.where((index == 0) | (index == level.size - 1), 1.0, 2.0)

    def cepstrum(quefrency: float) -> float:
        return float(np.sum(counted * level * np.cos(2 * np.pi * (index * quefrency % length) / length)) / length)

    periods = {"pinion": 2 * highest, "gear": 2 * highest * teeth[1] / teeth[0]}
    return {f"cepstral_peak_{name}": max(cepstrum(p + k) for k in (-1, 0, 1)) for name, p in periods.items()}


def dominant(average: np.ndarray, teeth: int) -> int:
    lines = fitted(average, [h * teeth for h in range(1, HARMONICS + 1)])
    return max(lines, key=lambda o: abs(lines[o])) // teeth


def envelope(average: np.ndarray, teeth: int, harmonic: int) -> np.ndarray:
    return np.abs(signal.hilbert(written_out(band(average, teeth, harmonic), average.size)))


def plain_na4(last: np.ndarray, past: Sequence[np.ndarray]) -> float:
    """Return NA4 as its paper sums it: of the last record, over the mean of the past ones."""
    numerator = last.size * np.sum((last - last.mean()) ** 4)
    return float(numerator / (sum(np.sum((r - r.mean()) ** 2) for r in past) / len(past)) ** 2)
