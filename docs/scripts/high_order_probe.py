"""One untrained number against a set: `python docs/scripts/high_order_probe.py [GEARBOXES] [CONFIGURATION]`.

Makes runs/probe_bench (configs/bench.yaml, or the configuration that is named, with the states of STATES alone) where
it is missing, and prints how well one untrained number tells each damage from healthy records of other gearboxes: the
kurtosis of the pinion's synchronous average in shaft orders 100 to 300, without the mesh harmonics. Healthy averages
are nearly Gaussian there (kurtosis 3), so an event of a few degrees stands out.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from scipy.interpolate import make_interp_spline

import siggen

STATES = ("healthy", "healthy_again", "slight", "face_20", "face_40", "face_80", "through_040", "through_060")
HEALTHY = ("healthy", "healthy_again")
ORDERS = (100, 300)
STEPS = 2048
"""Angle steps per revolution: orders up to 1024, above half of any sampling rate here."""
RESAMPLES = 1000


def averaged(signal: np.ndarray, fs_hz: float, tacho_s: np.ndarray) -> np.ndarray:
    """Return one revolution of the pinion, averaged over all whole revolutions between its pulses."""
    turns = len(tacho_s) - 1
    angle = np.arange(turns * STEPS) / STEPS
    times = make_interp_spline(np.arange(turns + 1), tacho_s, k=3)(angle)
    steps = make_interp_spline(np.arange(len(signal)) / fs_hz, signal, k=5)(times)
    return steps.reshape(turns, STEPS).mean(axis=0)


def high_order_kurtosis(average: np.ndarray, teeth: int) -> float:
    """Return the kurtosis of an average in ORDERS without the multiples of the mesh order."""
    lines = np.fft.rfft(average)
    orders = np.arange(len(lines))
    lines[(orders < ORDERS[0]) | (orders > ORDERS[1]) | (orders % teeth == 0)] = 0.0
    residual = np.fft.irfft(lines, STEPS)
    return float(np.mean(residual**4) / np.mean(residual**2) ** 2)


def probes(dataset: Any) -> dict[str, dict[int, float]]:
    """Return state -> gearbox -> kurtosis, the geometric mean over the channels."""
    found: dict[str, dict[int, float]] = {}
    for batch in dataset.records():
        for row in batch.to_pylist():
            tacho_s = np.asarray(row["tacho_s"])
            values = [
                high_order_kurtosis(
                    averaged(np.asarray(row[channel.column]), dataset.fs_hz, tacho_s), row["teeth_pinion"]
                )
                for channel in dataset.channels
            ]
            found.setdefault(row["state"], {})[row["specimen_id"]] = float(np.exp(np.mean(np.log(values))))
    return found


def auc(healthy: np.ndarray, damaged: np.ndarray, chosen: np.ndarray) -> float:
    """Return the share of pairs of different gearboxes in which the damaged one has the larger value."""
    pairs = chosen[:, None] != chosen[None, :]
    above = damaged[chosen][None, :] > healthy[chosen][:, None]
    return float(above[pairs].mean())


def main(gearboxes: int, config: Path) -> None:
    """Print the AUC of every damage with its 95 % interval from resampled gearboxes."""
    folder = Path("runs") / f"probe_{config.stem}"
    if not folder.exists():
        raw = yaml.safe_load(config.read_text(encoding="utf-8"))
        states = [state for state in raw["states"] if state["name"] in STATES]
        siggen.generate(siggen.load_config({**raw, "specimens": gearboxes, "states": states}), folder, workers=1)
    found = probes(siggen.open(folder))
    values = {state: np.array([by_gearbox[k] for k in sorted(by_gearbox)]) for state, by_gearbox in found.items()}
    count = len(values["healthy"])
    draws = np.random.default_rng(0).integers(count, size=(RESAMPLES, count))
    for state in STATES:
        middle = ", ".join(f"{q:.1f}" for q in np.quantile(values[state], (0.1, 0.5, 0.9)))
        text = f"{state}: kurtosis {middle} (10 %, median, 90 %)"
        if state not in HEALTHY:
            value = auc(values["healthy"], values[state], np.arange(count))
            low, high = np.quantile([auc(values["healthy"], values[state], draw) for draw in draws], (0.025, 0.975))
            text += f"; AUC {value:.2f} ({low:.2f} to {high:.2f}), {count} gearboxes"
        print(text)


if __name__ == "__main__":
    main(
        int(sys.argv[1]) if len(sys.argv) > 1 else 24, Path(sys.argv[2] if len(sys.argv) > 2 else "configs/bench.yaml")
    )
