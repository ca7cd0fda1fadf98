"""Table of docs/understand/background.md: healthy channels of bench and background beside what real machines show.

`python docs/scripts/background.py [gearboxes]`; 8 gearboxes take a minute. Signals are resampled in angle and seen in
Hann windows of 40 turns; the floor is the median over 0.693, the residual what the averages of both shafts leave.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import coherence, hilbert, resample_poly

from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.record.simulation import simulate

CONFIGS = ("configs/bench.yaml", "configs/background.yaml")
CHANGES = ["duration_s=3.0"]
PER_TURN, WINDOW_TURNS, AVERAGED_TURNS = 1024, 40, 44
AIMS = {
    "1x [dB re strongest mesh line]": "-45 to -20",
    "2x to 4x, median [dB]": "-50 to -28",
    "floor 10-20 Hz [dB/Hz]": "-80 to -35",
    "floor 40-160 Hz [dB/Hz]": "-58 to -40",
    "floor 5-10 kHz [dB/Hz]": "-65 to -45",
    "mean over median 3.5-5 kHz [dB]": "3 to 14",
    "lines above mesh 5 [1/kHz]": "1.5 to 8",
    "of these at no multiple of a shaft": "at least 0.25",
    "coherence of halves, orders 100-300": "0.4 to 0.95",
    "kurtosis of that average": "2.3 to 2.9",
    "residual kurtosis 4-8 kHz": "3.1 to 4.5",
    "shaft depth 2-8 kHz": "0.08 to 0.5",
    "residual envelope CV 4-8 kHz": "0.53 to 0.66",
    "coherence of channels > 2.5 kHz": "0.05 to 0.3",
    "velocity at 1x [mm/s rms]": "0.05 to 1.5",
    "floor 40-160 Hz [mm/s2/sqrt(Hz)]": "measured: 3 to 7",
    "floor 5-10 kHz [mm/s2/sqrt(Hz)]": "measured: 3 to 4",
    "strongest mesh line [m/s2 rms]": "-",
}
Numbers = dict[str, float]


class InAngle:
    """One channel at equal angles: (turns, PER_TURN), mean removed."""

    def __init__(self, record: Record, channel: str, fs_hz: float) -> None:
        signal, tacho = record.channels[channel].astype(float), record.tacho_s
        fine = resample_poly(signal - signal.mean(), 4, 1)
        turns = tacho.size - 1
        times = np.interp(np.arange(turns * PER_TURN) / PER_TURN, np.arange(tacho.size), tacho)
        self.signal = CubicSpline(np.arange(fine.size) / (4.0 * fs_hz), fine)(times)
        self.turns, self.shaft_hz = turns, float(record.labels["pinion_shaft_hz"])  # type: ignore[arg-type]
        self.teeth = int(record.labels["teeth_pinion"])  # type: ignore[call-overload]
        self.gear_order = self.teeth / int(record.labels["teeth_gear"])  # type: ignore[call-overload]

    @property
    def rows(self) -> np.ndarray:
        """The turns of the pinion, one a row."""
        return self.signal.reshape(self.turns, PER_TURN)

    def windows(self) -> np.ndarray:
        """Densities (windows, orders) per Hz."""
        size = WINDOW_TURNS * PER_TURN
        starts = range(0, self.signal.size - size + 1, size // 2)
        hann = np.hanning(size)
        found = [np.abs(np.fft.rfft(self.signal[s : s + size] * hann)) ** 2 for s in starts]
        return np.array(found) * 2.0 / ((hann**2).sum() * PER_TURN * self.shaft_hz)

    def residual(self) -> np.ndarray:
        """Return the signal less the averages of both shafts."""
        rest = self.signal - np.tile(self.rows.mean(axis=0), self.turns)
        place = np.arange(rest.size) * self.gear_order / PER_TURN
        bins = np.floor(place % 1.0 * 2048).astype(int)
        mean = np.bincount(bins, rest, 2048) / np.maximum(np.bincount(bins, minlength=2048), 1)
        return rest - mean[bins]

    def band(self, signal: np.ndarray, low_hz: float, high_hz: float) -> np.ndarray:
        """Return a signal without what lies outside of the band."""
        spectrum = np.fft.rfft(signal)
        hz = np.arange(spectrum.size) * self.shaft_hz * PER_TURN / signal.size
        return np.fft.irfft(np.where((hz >= low_hz) & (hz < high_hz), spectrum, 0.0), signal.size)


def spectral(one: InAngle) -> Numbers:
    """Return lines and floors."""
    windows = one.windows()
    density, step_hz = windows.mean(axis=0), one.shaft_hz / WINDOW_TURNS
    hz = np.arange(density.size) * step_hz

    def power(order: float) -> float:
        near = round(order * WINDOW_TURNS)
        return float(density[near - 2 : near + 3].sum() * step_hz)

    mesh = max(power(h * one.teeth) for h in range(1, 11))

    def decibels(value: float) -> float:
        return 10.0 * float(np.log10(value / mesh))

    def floor(low: float, high: float) -> float:
        inside = (hz >= low) & (hz < high)
        return decibels(float(np.mean([np.median(w[inside]) for w in windows])) / 0.693)

    inside = (hz >= 3500.0) & (hz < 5000.0)
    lines = list(peaks(density, hz, one))
    foreign = [
        order for order in lines if not any(abs(order / s - round(order / s)) * s < 0.04 for s in (1.0, one.gear_order))
    ]
    span_khz = 1e-3 * (10_000.0 - 5.5 * one.teeth * one.shaft_hz)
    return {
        "1x [dB re strongest mesh line]": decibels(power(1.0)),
        "2x to 4x, median [dB]": float(np.median([decibels(power(k)) for k in (2.0, 3.0, 4.0)])),
        "floor 10-20 Hz [dB/Hz]": floor(10.0, 20.0),
        "floor 40-160 Hz [dB/Hz]": floor(40.0, 160.0),
        "floor 5-10 kHz [dB/Hz]": floor(5000.0, 10_000.0),
        "mean over median 3.5-5 kHz [dB]": 10.0 * float(np.log10(density[inside].mean() / np.median(density[inside]))),
        "lines above mesh 5 [1/kHz]": len(lines) / span_khz,
        "of these at no multiple of a shaft": len(foreign) / len(lines) if lines else np.nan,
        "floor 40-160 Hz [mm/s2/sqrt(Hz)]": 1e3 * float(np.sqrt(mesh * 10.0 ** (0.1 * floor(40.0, 160.0)))),
        "floor 5-10 kHz [mm/s2/sqrt(Hz)]": 1e3 * float(np.sqrt(mesh * 10.0 ** (0.1 * floor(5000.0, 10_000.0)))),
        "strongest mesh line [m/s2 rms]": float(np.sqrt(mesh)),
        "velocity at 1x [mm/s rms]": 1e3 * float(np.sqrt(power(1.0))) / (2.0 * np.pi * one.shaft_hz),
    }


def peaks(density: np.ndarray, hz: np.ndarray, one: InAngle) -> Iterator[float]:
    """Yield the orders of lines more than 10 dB over the floor around them, above mesh 5 and below 10 kHz."""
    reach = 2 * WINDOW_TURNS
    first = int(5.5 * one.teeth * WINDOW_TURNS)
    for k in range(first, int(np.searchsorted(hz, 10_000.0))):
        if (
            density[k] == density[k - 4 : k + 5].max()
            and density[k] > 10.0 * np.median(density[k - reach : k + reach]) / 0.693
        ):
            yield k / WINDOW_TURNS


def cyclic(one: InAngle) -> Numbers:
    """Return what returns every turn, and how the rest is modulated."""
    halves = one.rows[:AVERAGED_TURNS].reshape(2, -1, PER_TURN).mean(axis=1)
    a, b = np.fft.rfft(halves, axis=1)[:, 100:301]
    average = np.zeros(PER_TURN // 2 + 1, dtype=complex)
    average[100:301] = a + b
    repeated = np.fft.irfft(average)
    rest = one.residual()
    high = one.band(rest, 4000.0, 8000.0)
    envelope = np.abs(hilbert(high))
    power = np.abs(hilbert(one.band(rest, 2000.0, 8000.0))) ** 2
    angle = 2.0 * np.pi * np.arange(power.size) / PER_TURN
    depths = [2.0 * abs((power * np.exp(-1j * order * angle)).mean()) / power.mean() for order in (1.0, one.gear_order)]
    return {
        "coherence of halves, orders 100-300": float(
            (a * b.conj()).sum().real / np.sqrt((abs(a) ** 2).sum() * (abs(b) ** 2).sum())
        ),
        "kurtosis of that average": float((repeated**4).mean() / (repeated**2).mean() ** 2),
        "residual kurtosis 4-8 kHz": float((high**4).mean() / (high**2).mean() ** 2),
        "shaft depth 2-8 kHz": max(depths),
        "residual envelope CV 4-8 kHz": float(envelope.std() / envelope.mean()),
    }


def channels(config_file: str, gearboxes: int) -> dict[str, list[float]]:
    """Return name -> one number per healthy channel."""
    config = load_config(config_file, [*CHANGES, f"specimens={gearboxes}"])
    found: dict[str, list[float]] = {name: [] for name in AIMS}
    for specimen in range(gearboxes):
        record = simulate(config, [specimen * config.records_per_specimen])[0]
        if not isinstance(record, Record):
            print(f"gearbox {specimen}: {record.status}, {record.reason}", file=sys.stderr)
            continue
        seen = [InAngle(record, name, config.fs_hz) for name in config.channels]
        for one in seen:
            for name, value in {**spectral(one), **cyclic(one)}.items():
                found[name].append(value)
        rest = [one.residual() for one in seen]
        rate_hz = PER_TURN * seen[0].shaft_hz
        hz, together = coherence(*rest, fs=rate_hz, nperseg=round(0.02 * rate_hz))
        found["coherence of channels > 2.5 kHz"].append(float(np.median(together[(hz > 2500.0) & (hz < 10_000.0)])))
        print(f"{config_file}: gearbox {specimen + 1} of {gearboxes}", file=sys.stderr)
    return found


def text(values: list[float]) -> str:
    """Return the median and the range from 10 to 90 %."""
    low, middle, high = np.nanpercentile(values, [10.0, 50.0, 90.0])
    return f"{middle:.3g} [{low:.3g}, {high:.3g}]"


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    tables = [channels(file, count) for file in CONFIGS]
    print("| quantity | aim of the median | bench | background |\n|---|---|---|---|")
    for name, aim in AIMS.items():
        print(f"| {name} | {aim} | {' | '.join(text(table[name]) for table in tables)} |")
