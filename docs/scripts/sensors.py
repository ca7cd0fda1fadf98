"""Figure and numbers of docs/understand/sensors.md: one gearbox by sensors on its shafts, healthy and with a spall.

`python docs/scripts/sensors.py [--png FILE]`; two minutes. The gearbox is quickstart's, at 35 Hz and 40 N m.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.config import Config
from siggen.record.simulation import simulate

SPEED_HZ, TORQUE_NM = 35.0, 40.0
DISC = {"kind": "encoder", "pulses_per_turn": 1800}
SENSORS = [
    {**DISC, "name": "first", "place": "pinion"},
    {**DISC, "name": "second", "place": "gear"},
    {"kind": "transmission_error", "name": "error", "pinion_encoder": "first", "gear_encoder": "second"},
    {"kind": "coupling_torque", "name": "flange", "range_nm": 200},
    {"kind": "bearing_force", "name": "washer", "range_n": 10_000, "axes": ["vertical"]},
    {"kind": "motor_current", "name": "clamp", "rated_torque_nm": 60, "floor_a": 0.001},
]
SPALL = {"kind": "spall", "gear": "pinion", "teeth": 1, "face_length_mm": 20, "profile_length_mm": 2.0, "depth_mm": 0.2}
SHOWN = {
    "error_line_of_action": "transmission error [um]",
    "first_rotation": "speed of the pinion [rad/s]",
    "flange_rotation": "torque of the motor [N m]",
    "clamp_phase_a": "current of a phase [A]",
}
HIGHEST_ORDER = 40
LEAST_SHARE = 3e-5
"""Of the axis; what is below is noise of every sensor."""


def configuration() -> Config:
    """Return the gearbox, healthy and with a spall."""
    return load_config(
        {
            "extends": "quickstart", "name": "sensors", "specimens": 1, "duration_s": 1.6,
            "operating_points": [{"speed_hz": SPEED_HZ, "torque_nm": TORQUE_NM}],
            "states": [{"name": "healthy"}, {"name": "spall", "severity": "severe", "damage": SPALL}],
            "sensors": SENSORS,
        }
    )  # fmt: skip


def made(config: Config) -> list[Record]:
    """Return both records."""
    found = [one for one in simulate(config, [0, 1]) if isinstance(one, Record)]
    assert len(found) == 2
    return found


def lines(signal: np.ndarray, fs_hz: float, speed_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Return orders of the pinion and amplitudes in the unit of the signal, by a Hann window."""
    values = signal.astype(np.float64)
    spectrum = 4.0 * np.abs(np.fft.rfft((values - values.mean()) * np.hanning(values.size))) / values.size
    return np.fft.rfftfreq(values.size, 1.0 / fs_hz) / speed_hz, spectrum


def turns_hz(record: Record) -> float:
    """Return the speed of the pinion that its encoder counted."""
    return float(record.channels["first_rotation"].mean() / (2.0 * np.pi))


def table(config: Config, records: list[Record]) -> str:
    """Return mean and standard deviation of every channel as Markdown."""
    rows = ["| channel | mean, healthy | standard deviation, healthy | with the spall |", "|---|---|---|---|"]
    for name in config.channels:
        healthy, damaged = (record.channels[name].astype(np.float64) for record in records)
        rows.append(f"| `{name}` | {healthy.mean():.4g} | {healthy.std():.3g} | {damaged.std():.3g} |")
    return "\n".join(rows)


def draw(config: Config, records: list[Record], file: Path) -> None:
    """Draw order spectra of both states."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(len(SHOWN), 1, figsize=(7.5, 8.4), layout="constrained", sharex=True)
    for axis, (channel, title) in zip(axes, SHOWN.items(), strict=True):
        for record, colour, label in zip(records[::-1], ("tab:red", "tab:blue"), ("spall", "healthy"), strict=True):
            orders, amplitudes = lines(record.channels[channel], config.fs_hz, turns_hz(record))
            near = (orders > 0.2) & (orders <= HIGHEST_ORDER)
            axis.semilogy(orders[near], amplitudes[near], color=colour, linewidth=0.8, label=label)
        axis.set_ylim(bottom=LEAST_SHARE * axis.get_ylim()[1])
        axis.set_ylabel(title, fontsize=8)
        axis.grid(alpha=0.3)
    axes[0].legend(loc="upper right", fontsize=8)
    axes[-1].set_xlabel("order of the pinion (mesh: 18)")
    figure.savefig(file, dpi=130)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--png", type=Path)
    chosen = parser.parse_args()
    own = configuration()
    both = made(own)
    print(table(own, both))
    if chosen.png is not None:
        draw(own, both, chosen.png)
