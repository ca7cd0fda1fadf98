"""Numbers of docs/understand/transfer_path.md: levels and noise of healthy channels, how sensors of a gearbox differ.

`python docs/scripts/transfer_path.py`; it takes half a minute.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from siggen.checks.loading import load_config
from siggen.config.config import Config
from siggen.record.simulation import simulate
from siggen.sensing.modal_path import modal_accelerance
from siggen.specimen.housing import specimen_housing
from siggen.specimen.measured_path import INPUTS

GEARBOXES, SPREAD_GEARBOXES, SENSORS = 5, 150, 12
HEALTHY_ROW = 1
"""Of the records of a gearbox, the healthy one at 25 Hz."""

COLUMNS = "h2 h3 h4 h5 [dB], noise at mesh 1 and 2 [dB/Hz], median bin [dB], kurtosis, crest, rms, force noise"


def channel_numbers(signal: np.ndarray, fs_hz: float, labels: Mapping[str, Any]) -> list[float]:
    """Return what COLUMNS names for one healthy channel."""
    window = np.hanning(signal.size)
    spectrum = np.abs(np.fft.rfft(signal * window))
    amplitude = spectrum * 2.0 / window.sum()
    density = 2.0 * spectrum**2 / (fs_hz * (window**2).sum())
    bin_hz, shaft_hz, mesh_hz = fs_hz / signal.size, labels["pinion_shaft_hz"], labels["mesh_hz"]
    frequency_hz = bin_hz * np.arange(spectrum.size)

    def line(harmonic: int) -> float:
        near = int(harmonic * mesh_hz / bin_hz)
        return float(amplitude[near - 2 : near + 4].max())

    def noise_db(harmonic: int) -> float:
        order = (frequency_hz - harmonic * mesh_hz) / shaft_hz
        between = (np.abs(order) < 8.0) & (np.abs(order - np.round(order)) > 0.2)
        return float(10.0 * np.log10(density[between].mean() / (line(harmonic) ** 2 / 2.0)))

    strongest = max(line(harmonic) for harmonic in range(1, 11))
    centred = signal - signal.mean()
    return [
        *(20.0 * np.log10(line(harmonic) / line(1)) for harmonic in (2, 3, 4, 5)),
        *(noise_db(harmonic) for harmonic in (1, 2)),
        20.0 * np.log10(np.median(amplitude) / strongest),
        float(np.mean(centred**4) / signal.var() ** 2),
        float(np.abs(signal).max() / signal.std()),
        float(signal.std()),
        labels["force_noise_n_per_sqrt_hz"],
    ]


def healthy_channels(config: Config) -> np.ndarray:
    """Return the numbers of all channels of one healthy record of every gearbox."""
    rows = []
    for specimen in range(GEARBOXES):
        record = simulate(config, [specimen * config.records_per_specimen + HEALTHY_ROW])[0]
        rows += [channel_numbers(x.astype(float), config.fs_hz, record.labels) for x in record.channels.values()]
    return np.array(rows)


def sensor_spread(config: Config, mesh_hz: float) -> np.ndarray:
    """Return the spread over sensors of sidebands and harmonics 2 to 5 over the mesh line [dB], median of gearboxes."""
    force = np.random.default_rng(1).standard_normal(len(INPUTS))  # one fixed pattern over the bearing forces
    lines_hz = np.array([mesh_hz - 30.0, mesh_hz, mesh_hz + 30.0, *(mesh_hz * np.arange(2, 6))])
    spread = []
    for specimen in range(SPREAD_GEARBOXES):
        housing = specimen_housing(config, specimen)
        bearings = housing.at_bearings(INPUTS)
        shapes = [housing.shape_at(f"sensor {k}") for k in range(SENSORS)]
        level = np.array([np.abs(force @ modal_accelerance(housing.modes, bearings, s, lines_hz)) for s in shapes])
        ratios = [0.5 * (level[:, 0] + level[:, 2]) / level[:, 1], *(level[:, 3:] / level[:, 1:2]).T]
        spread.append([np.std(20.0 * np.log10(ratio), ddof=1) for ratio in ratios])
    return np.median(spread, axis=0)


def main() -> None:
    """Print the table's numbers and the spread over sensors."""
    np.set_printoptions(precision=2, suppress=True, linewidth=160)
    config = load_config("configs/transfer_path.yaml", ["specimens=6"])
    print(COLUMNS, "(rows: 5 %, median, 95 %)")
    print(np.percentile(healthy_channels(config), [5, 50, 95], axis=0))
    for mesh_hz in (270.0, 540.0):
        print(f"{mesh_hz:g} Hz: standard deviation over sensors of SB1, h2 to h5 [dB]", sensor_spread(config, mesh_hz))


if __name__ == "__main__":
    main()
