"""Figure and table of docs/understand/bearing_spall.md: spectra of a gearbox of configs/bench.yaml, bearings spalled.

`python docs/scripts/bearing_spall.py`; four records of 6 s, half a minute.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import yaml
from matplotlib.figure import Figure
from scipy.signal import butter, hilbert, sosfiltfilt

from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.dynamics.bearings.ball_bearing import BallBearing
from siggen.record.simulation import simulate

ROOT = Path(__file__).resolve().parents[2]
FIGURE = ROOT / "docs" / "figures" / "bearing_spall.png"
BEARING = BallBearing(9, 7.94e-3, 39.04e-3)
ORDERS = {"outer": BEARING.outer_order, "inner": BEARING.inner_order, "ball": 2.0 * BEARING.spin_order}
WORDS = {"outer": "BPFO", "inner": "BPFI", "ball": "2 BSF"}
SLIP = 0.015
BAND_HZ = (2000.0, 5000.0)
STEPS = 1024
SEEN = 30.0
"""Highest order drawn."""


def records() -> list[Record]:
    """Return a healthy record of the first gearbox, and one with a spall of 2 mm in each element."""
    raw = yaml.safe_load((ROOT / "configs" / "bench.yaml").read_text(encoding="utf-8"))
    spall = {"kind": "bearing_spall", "length_mm": 2.0}
    raw["states"] = [{"name": "healthy"}] + [
        {"name": one, "severity": "moderate", "grows_from": "none", "damage": {**spall, "element": one}}
        for one in ORDERS
    ]
    raw["duration_s"] = 6.0
    return [one for one in simulate(load_config(raw), range(1 + len(ORDERS))) if isinstance(one, Record)]


def spectra(record: Record, fs_hz: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return orders (k,), amplitudes of the signal, and of its squared envelope in the band over its mean."""
    signal = next(iter(record.channels.values())).astype(float)
    grid = angle_grid(record.tacho_s, STEPS)
    band = butter(4, BAND_HZ, "bandpass", fs=fs_hz, output="sos")
    envelope = np.abs(hilbert(sosfiltfilt(band, signal))) ** 2
    found = []
    for values in (signal, envelope / envelope.mean() - 1.0):
        turned = resample_to_angle(values, fs_hz, grid)
        window = np.hanning(turned.size)
        found.append(2.0 * np.abs(np.fft.rfft(turned * window)) / window.sum())
    return np.arange(found[0].size) / grid.revolutions, found[0], found[1]


def at(orders: np.ndarray, lines: np.ndarray, place: float) -> float:
    """Return the largest line where 1 to 2 % of slip may put an order whose slip is 1.5 %."""
    return float(lines[np.abs(orders - place) < 0.007 * place].max())


def main() -> None:
    """Simulate, print the table and draw."""
    made = records()
    fs_hz = 25600.0
    found = {one.labels["state"]: spectra(one, fs_hz) for one in made}
    print("| squared envelope, line over the median of orders 2 to 30 | " + " | ".join(found) + " |")
    print("|---|" + "---|" * len(found))
    for element, order in ORDERS.items():
        row = []
        place = order * (
            1.0 - SLIP if element != "inner" else 1.0 + SLIP * BEARING.cage_order / (1.0 - BEARING.cage_order)
        )
        for orders, _, lines in found.values():
            floor = np.median(lines[(orders > 2.0) & (orders < SEEN)])
            row.append(f"{at(orders, lines, place) / floor:.0f}")
        print(f"| {WORDS[element]} ({order:.2f}) | " + " | ".join(row) + " |")
    figure = Figure(figsize=(11, 9), layout="constrained")
    axes = figure.subplots(len(found), 2, sharex="col", sharey="col")
    for (state, (orders, signal, envelope)), (left, right) in zip(found.items(), axes, strict=True):
        seen = orders < SEEN
        left.semilogy(orders[orders < 130], signal[orders < 130], lw=0.4, color="0.2")
        left.set(ylim=(1e-4, 50.0), ylabel=f"{state}\n[m/s²]")
        right.plot(orders[seen], envelope[seen], lw=0.6, color="0.2")
        if state in ORDERS:
            for h in (1, 2, 3):
                right.axvline(h * ORDERS[state], color="tab:red", lw=0.8, ls="--", zorder=0)
        right.set(ylim=(0, 1.0))
    axes[0, 0].set_title("order spectrum of the channel")
    axes[0, 1].set_title(f"of its squared envelope, {BAND_HZ[0] / 1e3:g} to {BAND_HZ[1] / 1e3:g} kHz")
    for axis in axes[-1]:
        axis.set_xlabel("order of the pinion's shaft")
    figure.savefig(FIGURE, dpi=110)


if __name__ == "__main__":
    main()
