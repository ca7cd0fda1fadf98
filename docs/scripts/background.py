"""Table of docs/understand/background.md: healthy channels of bench, bare and as it is, beside what real machines show.

`python docs/scripts/background.py [gearboxes]`; 8 gearboxes take a minute. The numbers are those of the audit
(diagnostics/indicators/background_levels.py); the coherence of channels needs two channels at once.
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.signal import coherence

from diagnostics.indicators.background_levels import background_levels
from diagnostics.signal.order_domain import AngleGrid, angle_grid, resample_to_angle
from diagnostics.signal.synchronous_average import asynchronous_part
from siggen.checks.loading import load_config
from siggen.columns.record import Record
from siggen.record.simulation import simulate

CONFIG = "configs/bench.yaml"
WITHOUT = ["background=null", "manufacture.flank_waves=off"]
CHANGES = ["duration_s=3.0"]
STEPS = 1024
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
LEVELS = {
    "1x [dB re strongest mesh line]": "shaft_1x_db",
    "floor 10-20 Hz [dB/Hz]": "floor_10_20hz_db",
    "floor 40-160 Hz [dB/Hz]": "floor_40_160hz_db",
    "floor 5-10 kHz [dB/Hz]": "floor_5_10khz_db",
    "mean over median 3.5-5 kHz [dB]": "tonality_3500_5000hz_db",
    "lines above mesh 5 [1/kHz]": "lines_above_mesh5_per_khz",
    "of these at no multiple of a shaft": "foreign_line_share",
    "coherence of halves, orders 100-300": "repeated_coherence",
    "kurtosis of that average": "repeated_kurtosis",
    "residual kurtosis 4-8 kHz": "noise_kurtosis_4_8khz",
    "shaft depth 2-8 kHz": "shaft_depth",
    "residual envelope CV 4-8 kHz": "noise_envelope_cv_4_8khz",
    "strongest mesh line [m/s2 rms]": "strongest_mesh_rms_m_s2",
}
Numbers = dict[str, float]


def numbers(turns: np.ndarray, shaft_hz: float, teeth: tuple[int, int], fs_hz: float) -> Numbers:
    """Return the rows of the table of one channel."""
    levels = background_levels(turns, shaft_hz, teeth, fs_hz)
    found = {title: levels[name] for title, name in LEVELS.items()}
    mesh = levels["strongest_mesh_rms_m_s2"]
    once = mesh * 10.0 ** (levels["shaft_1x_db"] / 20.0)
    found["2x to 4x, median [dB]"] = float(np.median([levels[f"shaft_{k}x_db"] for k in (2, 3, 4)]))
    found["velocity at 1x [mm/s rms]"] = 1e3 * once / (2.0 * np.pi * shaft_hz)
    for title, name in (("40-160 Hz", "floor_40_160hz_db"), ("5-10 kHz", "floor_5_10khz_db")):
        found[f"floor {title} [mm/s2/sqrt(Hz)]"] = 1e3 * mesh * 10.0 ** (levels[name] / 20.0)
    return found


def turned(record: Record, channel: str, fs_hz: float, grid: AngleGrid) -> np.ndarray:
    """Return one channel over pinion angle, a row per turn."""
    return resample_to_angle(record.channels[channel], fs_hz, grid).reshape(grid.revolutions, STEPS)


def channels(changes: list[str], gearboxes: int) -> dict[str, list[float]]:
    """Return name -> one number per healthy channel."""
    config = load_config(CONFIG, [*CHANGES, *changes, f"specimens={gearboxes}"])
    found: dict[str, list[float]] = {name: [] for name in AIMS}
    for specimen in range(gearboxes):
        record = simulate(config, [specimen * config.records_per_specimen])[0]
        if not isinstance(record, Record):
            print(f"gearbox {specimen}: {record.status}, {record.reason}", file=sys.stderr)
            continue
        labels = record.labels
        teeth = (int(labels["teeth_pinion"]), int(labels["teeth_gear"]))  # type: ignore[call-overload]
        grid = angle_grid(record.tacho_s, STEPS)
        shaft_hz = grid.revolutions / float(record.tacho_s[-1] - record.tacho_s[0])
        seen = [turned(record, name, config.fs_hz, grid) for name in config.channels]
        for turns in seen:
            for name, value in numbers(turns, shaft_hz, teeth, config.fs_hz).items():
                found[name].append(value)
        rest = [asynchronous_part(turns, teeth) for turns in seen]
        rate_hz = STEPS * shaft_hz
        hz, together = coherence(*rest, fs=rate_hz, nperseg=round(0.02 * rate_hz))
        found["coherence of channels > 2.5 kHz"].append(float(np.median(together[(hz > 2500.0) & (hz < 10_000.0)])))
        print(f"{CONFIG} {' '.join(changes)}: gearbox {specimen + 1} of {gearboxes}", file=sys.stderr)
    return found


def text(values: list[float]) -> str:
    """Return the median and the range from 10 to 90 %."""
    low, middle, high = np.nanpercentile(values, [10.0, 50.0, 90.0])
    return f"{middle:.3g} [{low:.3g}, {high:.3g}]"


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    tables = [channels(changes, count) for changes in (WITHOUT, [])]
    print("| quantity | aim of the median | bench without background and flank waves | bench |\n|---|---|---|---|")
    for name, aim in AIMS.items():
        print(f"| {name} | {aim} | {' | '.join(text(table[name]) for table in tables)} |")
