"""Draws docs/figures/planetary.png and prints the table of its page: `python docs/scripts/planetary.py`.

One gearbox of a planetary set (25, 26 and 77 teeth, three planets) in four states, and with pins out of place.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import siggen
from siggen.columns.record import Record
from siggen.record.simulation import simulate

TURNS, STEP = 6, 3
"""Of the carrier in a record; orders that healthy planets share."""
SPALL = {"kind": "spall", "face_length_mm": 20.0, "profile_length_mm": 1.0, "depth_mm": 0.1, "teeth": 1}
BASE: dict[str, Any] = {
    "name": "planets",
    "seed": 3,
    "specimens": 1,
    "fs_hz": 25_600.0,
    "duration_s": 1.0,
    "gears": {
        "module_mm": 2.0,
        "face_width_mm": 20.0,
        "pinion": {"teeth": 25, "bore_radius_mm": 8.0},
        "gear": {"teeth": 26, "bore_radius_mm": 8.0},
    },
    "planetary": {"ring_teeth": 77},
    "dynamics": {
        "model": "8dof",
        "mesh": {"tip_relief_um": 10.0},
        "motor_inertia_kg_m2": 1e-2,
        "load_inertia_kg_m2": 0.2,
    },
    "operating_points": [{"speed_hz": 24.48, "torque_nm": 60.0}],
    "states": [
        {"name": "healthy", "severity": "healthy"},
        *(
            {"name": gear, "severity": "severe", "grows_from": "none", "damage": {**SPALL, "gear": gear}}
            for gear in ("sun", "planet", "ring")
        ),
    ],
    "sensors": [{"name": "ring", "place": "ring", "axes": ["horizontal"], "bits": None}],
}


def spectra() -> dict[str, np.ndarray]:
    """Return the amplitudes of the ring's acceleration by sixths of an order of the carrier, by what is wrong."""
    pins = {**BASE, "states": BASE["states"][:1], "planetary": {"ring_teeth": 77, "pin_error_um": 20.0}}
    found = {}
    for name, raw in ((None, BASE), ("pins 20 µm out of place", pins)):
        config = siggen.load_config(raw)
        for record in simulate(config, list(range(config.records_per_specimen))):
            assert isinstance(record, Record), record
            signal = record.channels["ring_horizontal"].astype(float)
            shown = name or {"healthy": "healthy"}.get(record.labels["state"], f"spall of {record.labels['state']}")
            found[shown] = 2.0 * np.abs(np.fft.rfft(signal)) / signal.size
    return found


def drawn(found: dict[str, np.ndarray]) -> None:
    """Draw the lines around the first harmonic of the mesh; orders of healthy planets are blue."""
    figure = Figure(figsize=(9, 1.8 * len(found)), layout="constrained")
    for axis, (name, amplitudes) in zip(
        figure.subplots(len(found), 1, sharex=True, sharey=True), found.items(), strict=True
    ):
        places = np.arange(65 * TURNS, 90 * TURNS)
        shared = places % (STEP * TURNS) == 0
        for chosen, colour in ((~shared, "tab:orange"), (shared, "tab:blue")):
            axis.vlines(
                places[chosen] / TURNS, 1e-5, np.maximum(amplitudes[places[chosen]], 1e-5), color=colour, lw=1.5
            )
        axis.axvline(77, color="0.7", lw=0.8, zorder=0)
        axis.set(yscale="log", ylim=(1e-5, 30.0), ylabel="[m/s²]", title=name)
        axis.grid(alpha=0.3)
    axis.set_xlabel("order of the carrier; blue: multiples of three planets, grey: mesh frequency")
    figure.savefig(Path("docs/figures/planetary.png"), dpi=110)


def main() -> None:
    """Simulate, draw, print rms and what stands beside multiples of the planets."""
    found = spectra()
    drawn(found)
    print("| ring, horizontal | rms [m/s²] | power beside multiples of three |\n|---|---|---|")
    for name, amplitudes in found.items():
        power = amplitudes[1:] ** 2
        beside = power[np.arange(1, amplitudes.size) % (STEP * TURNS) != 0].sum() / power.sum()
        print(f"| {name} | {np.sqrt(0.5 * power.sum()):.1f} | {10.0 * np.log10(beside):.0f} dB |")


if __name__ == "__main__":
    main()
