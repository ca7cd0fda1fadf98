"""Figures of docs/understand/paper_a.md: spectra of the states of configs/paper_a.yaml, energy of their sidebands."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from siggen.checks.loading import load_config
from siggen.sets.drawn import simulated

FIGURES = Path(__file__).resolve().parents[1] / "figures"
SHAFT_HZ, TEETH = 30, 18


def line_amplitudes(signal: np.ndarray, fs_hz: float) -> np.ndarray:
    """Return single-sided amplitudes at the shaft orders 0, 1, 2, ...; 10 s put every 30 Hz line on a bin."""
    amplitudes = 2.0 * np.abs(np.fft.rfft(signal)) / signal.size
    bins_per_order = SHAFT_HZ * signal.size / fs_hz
    return amplitudes[:: round(bins_per_order)]


def energies(lines: np.ndarray) -> dict[str, float]:
    """Return the root of the sum of squared line amplitudes round the mesh harmonics and over all orders below 200."""
    bands = {f"around {h} x mesh": [h * TEETH + k for k in range(-8, 9) if k] for h in (1, 2, 3)}
    bands["all orders < 200 but mesh"] = [order for order in range(1, 200) if order % TEETH]
    return {name: float(np.sqrt((lines[orders] ** 2).sum())) for name, orders in bands.items()}


def spectra(*overrides: str) -> dict[str, np.ndarray]:
    """Return the amplitudes [m/s²] of the vertical acceleration of the pinion at shaft orders, by state."""
    config = load_config("configs/paper_a.yaml", overrides)
    records = simulated(config, range(config.records_per_specimen))
    channel = "bearing_vertical"
    return {r.labels["state"]: line_amplitudes(r.channels[channel].astype(float), config.fs_hz) for r in records}


def print_mesh(title: str, lines: dict[str, np.ndarray]) -> None:
    """Print acceleration and displacement of the mesh lines, and the strongest line of either."""
    print(f"\n| {title} | 1 to 5 x mesh [m/s²] | [nm] | strongest line [m/s²], [nm] | all lines, rms [m/s²] |")
    print("|---" * 5 + "|")
    for state, amplitudes in lines.items():
        hertz = SHAFT_HZ * np.arange(amplitudes.size)
        moved = np.append(0.0, 1e9 * amplitudes[1:] / (2.0 * np.pi * hertz[1:]) ** 2)
        cells = [", ".join(f"{values[h * TEETH]:.4g}" for h in range(1, 6)) for values in (amplitudes, moved)]
        strongest = [f"{values[1:].max():.4g} at {hertz[1 + values[1:].argmax()]} Hz" for values in (amplitudes, moved)]
        rms = np.sqrt(0.5 * (amplitudes[1:] ** 2).sum())
        print(f"| {state} | {cells[0]} | {cells[1]} | {', '.join(strongest)} | {rms:.3g} |")


def main() -> None:
    """Simulate the four states, print their lines and draw the spectra."""
    lines = spectra()
    table = {state: energies(amplitudes) for state, amplitudes in lines.items()}
    print("| [m/s²] | " + " | ".join(table) + " |")
    print("|---|" + "---|" * len(table))
    for band in next(iter(table.values())):
        print(f"| {band} | " + " | ".join(f"{values[band]:.2g}" for values in table.values()) + " |")
    print_mesh("one pitted tooth", lines)
    print_mesh(
        "18 pitted teeth",
        spectra(*(f"states.{name}.damage.teeth={TEETH}" for name in ("slight", "moderate", "severe")), "duration_s=2"),
    )
    figure = Figure(figsize=(9, 8), layout="constrained")
    axes = figure.subplots(len(lines), 1, sharex=True, sharey=True)
    for axis, (state, amplitudes) in zip(axes, lines.items(), strict=True):
        orders = np.arange(17, 67)
        is_mesh = orders % TEETH == 0
        shown = np.maximum(amplitudes[orders], 1e-6)
        axis.vlines(SHAFT_HZ * orders[~is_mesh], 1e-6, shown[~is_mesh], color="tab:orange", lw=1.5)
        axis.vlines(SHAFT_HZ * orders[is_mesh], 1e-6, shown[is_mesh], color="tab:blue", lw=2)
        axis.set(yscale="log", ylim=(1e-6, 1e2), xlim=(490, 2000), ylabel=f"{state}\namplitude [m/s²]")
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel(
        "frequency [Hz]; blue: mesh harmonics (n x 540 Hz), orange: other lines of the 30 Hz input shaft"
    )
    figure.savefig(FIGURES / "paper_a_spectra.png", dpi=110)


if __name__ == "__main__":
    main()
