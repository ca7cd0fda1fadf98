"""Table and figure of docs/understand/methods.md: healthy levels of quickstart against speed.

`python docs/scripts/levels_by_speed.py [GEARBOXES] [--png FILE]`; 24 gearboxes at 5, 10, 20 and 40 Hz and 40 N m, as
they are and without their background, take four minutes.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.signal import welch

import siggen

SPEEDS_HZ = (5.0, 10.0, 20.0, 40.0)
TORQUE_NM = 40.0
NOISE_HZ = (5000.0, 10_000.0)
WITHOUT = ["background=null"]


class Levels(NamedTuple):
    """Of one channel at all speeds (speeds,): rms and strongest line [m/s² rms], noise [m/s²/√Hz], kurtosis."""

    rms: np.ndarray
    line: np.ndarray
    noise: np.ndarray
    kurtosis: np.ndarray

    @property
    def exponent(self) -> float:
        """Of the rms over speed."""
        return float(np.polyfit(np.log(SPEEDS_HZ), np.log(self.rms), 1)[0])

    @property
    def noise_db_per_decade(self) -> float:
        """Of the noise's density over speed."""
        return 20.0 * float(np.polyfit(np.log10(SPEEDS_HZ), np.log10(self.noise), 1)[0])


def records(gearboxes: int, changes: list[str]) -> Iterator[tuple[float, int, siggen.Record]]:
    """Yield speed, gearbox and its healthy record."""
    for speed_hz in SPEEDS_HZ:
        point = [f"operating_points.0.speed_hz={speed_hz}", f"operating_points.0.torque_nm={TORQUE_NM}"]
        config = siggen.load_config("configs/quickstart.yaml", [*point, "duration_s=1.2", *changes])
        for gearbox in range(gearboxes):
            yield speed_hz, gearbox, siggen.run(siggen.draw(config, gearbox))


def channel_levels(signal: np.ndarray, fs_hz: float) -> tuple[float, float, float, float]:
    """Return rms, strongest line, density of noise and kurtosis of a channel."""
    x = signal.astype(float) - signal.mean()
    window = np.hanning(x.size)
    spectrum = np.sqrt(2.0) * np.abs(np.fft.rfft(x * window)) / window.sum()
    frequency, power = welch(x, fs_hz, nperseg=8192)
    inside = (frequency > NOISE_HZ[0]) & (frequency < NOISE_HZ[1])
    return x.std(), spectrum.max(), float(np.sqrt(np.median(power[inside]) / np.log(2.0))), np.mean(x**4) / x.var() ** 2


def measured(gearboxes: int, changes: list[str]) -> dict[tuple[int, str], Levels]:
    """Return the levels of every gearbox and channel."""
    found: dict[tuple[int, str], list[tuple[float, ...]]] = {}
    for _, gearbox, record in records(gearboxes, changes):
        for name, signal in record.channels.items():
            found.setdefault((gearbox, name), []).append(channel_levels(signal, 51_200.0))
    return {key: Levels(*np.array(rows).T) for key, rows in found.items()}


def spread(values: list[float]) -> str:
    """Return the median and where 80 % lie."""
    low, middle, high = np.percentile(values, (10, 50, 90))
    return f"{middle:.3g} [{low:.3g}, {high:.3g}]"


def table(found: dict[tuple[int, str], Levels]) -> Iterator[str]:
    """Yield rows: quantity | median [10 %, 90 %]."""
    levels = list(found.values())
    gearboxes = sorted({gearbox for gearbox, _ in found})
    exponents = [np.median([one.exponent for (g, _), one in found.items() if g == gearbox]) for gearbox in gearboxes]
    inside = sum(0.9 <= exponent <= 2.0 for exponent in exponents)
    yield f"exponent of rms over speed, median of a gearbox's sensors | {spread(exponents)}"
    yield f"of these 0.9 to 2 | {inside} of {len(gearboxes)}"
    for k, speed_hz in enumerate(SPEEDS_HZ):
        yield f"rms at {speed_hz:g} Hz [m/s2] | {spread([one.rms[k] for one in levels])}"
    yield f"strongest line at 5 Hz [m/s2] | {spread([one.line[0] for one in levels])}"
    yield f"strongest line at 20 and 40 Hz [m/s2] | {spread([line for one in levels for line in one.line[2:]])}"
    yield f"noise 5-10 kHz at 40 Hz [m/s2/sqrt(Hz)] | {spread([one.noise[-1] for one in levels])}"
    yield f"noise 5-10 kHz over speed [dB per tenfold] | {spread([one.noise_db_per_decade for one in levels])}"
    yield f"kurtosis at 20 and 40 Hz | {spread([value for one in levels for value in one.kurtosis[2:]])}"


def draw(whole: dict[tuple[int, str], Levels], path: Path) -> None:
    """Draw rms and noise over speed, a line for each channel."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (_, name), one in whole.items():
        colour = "C0" if name.startswith("lid") else "C1"
        left.loglog(SPEEDS_HZ, one.rms, color=colour, lw=0.8, alpha=0.6)
        right.loglog(SPEEDS_HZ, one.noise, color=colour, lw=0.8, alpha=0.6)
    speeds = np.array(SPEEDS_HZ)
    left.loglog(speeds, 0.3 * speeds, "k:", lw=1.0, label="in proportion to speed")
    right.loglog([], [], color="C0", label="lid, vertical")
    right.loglog([], [], color="C1", label="gear's end, horizontal")
    for panel, word in ((left, "rms [m/s²]"), (right, "noise, 5 to 10 kHz [m/s²/√Hz]")):
        panel.set_xlabel("speed of the pinion [Hz]")
        panel.set_ylabel(word)
        panel.minorticks_off()
        panel.set_xticks(SPEEDS_HZ, [f"{speed:g}" for speed in SPEEDS_HZ])
        panel.grid(alpha=0.3)
        panel.legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print both tables, and draw the figure if it is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("gearboxes", nargs="?", type=int, default=24)
    parser.add_argument("--png", type=Path)
    asked = parser.parse_args()
    whole = measured(asked.gearboxes, [])
    for title, found in (("as it is", whole), ("without background", measured(asked.gearboxes, WITHOUT))):
        print(f"== {title}")
        print("\n".join(table(found)))
    if asked.png:
        draw(whole, asked.png)


if __name__ == "__main__":
    main()
