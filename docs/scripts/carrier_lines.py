"""Numbers of docs/understand/planetary.md: lines beside the mesh, a turn of the carrier away, seen from the ring.

`python docs/scripts/carrier_lines.py [GEARBOXES]`: sun 31, three planets of 31, ring 95; healthy. Amplitudes of the
orders 93 to 97 of the carrier over that of 95, the mesh, median over both axes of the ring and 4 gearboxes.
"""

from __future__ import annotations

import sys

import numpy as np

import siggen

TEETH, ORDERS = {"sun": 31, "planet": 31, "ring": 95}, (93, 94, 95, 96, 97)
EVEN = "manufacture=null"
CASES = {
    "perfect planets": [EVEN, "planetary.pin_error_um=0"],
    "pins 5 to 20 um out of place": [EVEN, "planetary.pin_error_um=[5, 20]"],
    "pins 60 um out of place": [EVEN, "planetary.pin_error_um=60"],
    "errors of teeth": ["planetary.pin_error_um=0"],
    "as the preset": [],
}


def lines(signal: np.ndarray, fs_hz: float, carrier_hz: float) -> np.ndarray:
    """Return the amplitudes (orders,) over whole turns of the carrier."""
    turns = int(signal.size * carrier_hz / fs_hz)
    part = signal[: round(turns * fs_hz / carrier_hz)].astype(float)
    spectrum = np.abs(np.fft.rfft(part * np.hanning(part.size)))
    return np.array([spectrum[order * turns - 1 : order * turns + 2].max() for order in ORDERS])


def ratios(gearboxes: int, changes: list[str]) -> np.ndarray:
    """Return the medians (orders,) of amplitudes over that of the mesh."""
    base = [
        f"gears.pinion.teeth={TEETH['sun']}", f"gears.gear.teeth={TEETH['planet']}",
        f"planetary.ring_teeth={TEETH['ring']}", "operating_points.0.speed_hz=26", "operating_points.0.torque_nm=60",
    ]  # fmt: skip
    steady = ["variation.speed={}", "variation.torque={}", "duration_s=2.5"]
    design = siggen.load_config("configs/planetary.yaml", [*base, *steady, *changes])
    found = []
    for number in range(gearboxes):
        record = siggen.run(siggen.draw(design, number))
        ring = {name: signal for name, signal in record.channels.items() if name.startswith("ring")}
        amplitudes = [lines(signal, design.fs_hz, record.labels["carrier_hz"]) for signal in ring.values()]
        found += [one / one[ORDERS.index(TEETH["ring"])] for one in amplitudes]
    return np.median(found, axis=0)


def main(gearboxes: int) -> None:
    """Print the table."""
    print("|", " | ".join(["", *map(str, ORDERS)]), "|")
    print("|---" * (1 + len(ORDERS)) + "|")
    for name, changes in CASES.items():
        print(f"| {name} |", " | ".join(f"{value:.2g}" for value in ratios(gearboxes, changes)), "|", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4)
