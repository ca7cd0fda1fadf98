"""Draws wear.png and chip.png in docs/figures, prints the table of both pages: `docs/scripts/worn_and_chipped.py [N]`.

Simulates N gearboxes of quickstart (6 by default), each healthy twice and with every damage below.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import siggen
from diagnostics.indicators.record import record_values
from diagnostics.signal.order_domain import angle_grid, resample_to_angle
from siggen.config.yaml_source import read_yaml
from siggen.record.simulation import simulate

FIGURES, STEPS = Path("docs/figures"), 1024
WORN: dict[str, Any] = {
    "wear 20 um": {"kind": "wear", "depth_um": 20.0},
    "wear 60 um": {"kind": "wear", "depth_um": 60.0},
}
CHIPPED: dict[str, Any] = {
    "chip 1.5 mm": {"kind": "chip", "height_mm": 1.5},
    "chip 3 mm": {"kind": "chip", "height_mm": 3.0},
    "chip 3 mm over half the face": {"kind": "chip", "height_mm": 3.0, "face_share": 0.5},
    "corner 3 mm over half the face": {"kind": "chip", "height_mm": 3.0, "face_share": 0.5, "corner": True},
    "broken tooth": {"kind": "chip", "height_mm": "whole"},
}
VALUES = ("rms", "fm0_pinion_h5", "difference_rms_pinion", "fm4_pinion")
Values = dict[str, dict[str, float]]


def config_of(gearboxes: int) -> siggen.Config:
    """Return quickstart with every damage, at its first operating point."""
    raw = read_yaml("configs/quickstart.yaml")
    names = {name: name.replace(" ", "_").replace(".", "_") for name in (*WORN, *CHIPPED)}
    damages = [
        {"name": names[name], "severity": "moderate", "grows_from": "none", "damage": damage}
        for name, damage in {**WORN, **CHIPPED}.items()
    ]
    states = [{"name": "healthy"}, {"name": "again"}, *damages]
    return siggen.load_config(
        {**raw, "specimens": gearboxes, "repeats": 1, "states": states, "operating_points": raw["operating_points"][:1]}
    )


def lines(record: Any, fs_hz: float) -> np.ndarray:
    """Return the amplitudes of the first channel's average over turns of the pinion, by order."""
    signal = next(iter(record.channels.values()))
    average = resample_to_angle(signal, fs_hz, angle_grid(record.tacho_s, STEPS)).reshape(-1, STEPS).mean(axis=0)
    return 2.0 * np.abs(np.fft.rfft(average)) / STEPS


def indicators(record: Any, config: siggen.Config) -> dict[str, float]:
    """Return indicators and mesh lines 1 to 4 of the first channel of a record."""
    name, signal = next(iter(record.channels.items()))
    teeth = config.gears.pinion.teeth, config.gears.gear.teeth
    found = record_values({name: signal}, record.tacho_s, config.fs_hz, teeth).values
    mesh = {f"mesh {h}": found[f"mesh_amplitude_h{h}__{name}"] for h in (1, 2, 3, 4)}
    return {value: found[f"{value}__{name}"] for value in VALUES} | mesh | {
        "without contact": float(record.labels["contact_loss_share"])
    }  # fmt: skip


def drawn(found: dict[str, np.ndarray], teeth: int, path: Path) -> None:
    """Draw order spectra one above the other; mesh harmonics are blue."""
    figure = Figure(figsize=(9, 1.8 * len(found)), layout="constrained")
    largest = max(float(amplitudes[1 : 6 * teeth].max()) for amplitudes in found.values())
    axes = figure.subplots(len(found), 1, sharex=True, sharey=True)
    for axis, (name, amplitudes) in zip(axes, found.items(), strict=True):
        orders = np.arange(1, 6 * teeth)
        is_mesh = orders % teeth == 0
        for chosen, colour in ((~is_mesh, "tab:orange"), (is_mesh, "tab:blue")):
            axis.vlines(orders[chosen], 1e-4, np.maximum(amplitudes[orders[chosen]], 1e-4), color=colour, lw=1.5)
        axis.set(yscale="log", ylim=(1e-4, 2.0 * largest), xlim=(0, 6 * teeth), ylabel=f"{name}\n[m/s²]")
        axis.grid(alpha=0.3)
    axes[-1].set_xlabel("order of the pinion; blue: mesh harmonics, orange: other orders")
    figure.savefig(path, dpi=110)


def table(values: list[Values]) -> None:
    """Print medians over gearboxes of every value over that of healthy; times without contact as they are."""
    columns = list(next(iter(values[0].values())))
    print("| state | " + " | ".join(columns) + " |\n|---|" + "---|" * len(columns))
    for state in values[0]:
        cells = []
        for column in columns:
            own = np.array([one[state][column] for one in values])
            healthy = np.array([one["healthy"][column] for one in values])
            share = column == "without contact"
            cells.append(f"{np.median(own):.2%}" if share else f"{np.median(own / healthy):.3f}")
        print(f"| {state} | " + " | ".join(cells) + " |", flush=True)


def main(gearboxes: int) -> None:
    """Simulate, draw the first gearbox and print the table."""
    config = config_of(gearboxes)
    names = ["healthy", "healthy again", *WORN, *CHIPPED]
    values: list[Values] = []
    for gearbox in range(gearboxes):
        ids = [gearbox * config.records_per_specimen + i for i in range(len(names))]
        records = dict(zip(names, simulate(config, ids), strict=True))
        values.append({name: indicators(record, config) for name, record in records.items()})
        if gearbox == 0:
            spectra = {name: lines(record, config.fs_hz) for name, record in records.items()}
            for shown, file in ((WORN, "wear.png"), (CHIPPED, "chip.png")):
                chosen = {name: spectra[name] for name in ("healthy", *shown)}
                drawn(chosen, config.gears.pinion.teeth, FIGURES / file)
    table(values)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 6)
