"""Recordings of a machine that nobody knows: simulated with numbers of its own, written as files with a tacho."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import siggen

FS_HZ = 25_600.0
TEETH = (18, 47)
HIDDEN: dict[str, Any] = {
    "extends": "quickstart",
    "name": "hidden",
    "seed": 4242,
    "specimens": 1,
    "repeats": 4,
    "states": {"others": None, "healthy": {}},
    "operating_points": [{"speed_hz": 34.0, "torque_nm": 40.0}],
    # clear enough to be found: as strong as the range of the preset allows
    "background": {"second_stage": {"order": 27 * 18 / 47, "force_share": 0.05}},
}


def tacho_waveform(time_s: np.ndarray, pulses_s: np.ndarray) -> np.ndarray:
    """Return pulses of 3 ms that rise over four samples about their time, as behind the filter of a recorder."""
    nearest = pulses_s[np.abs(time_s[:, None] - pulses_s).argmin(axis=1)]
    since = time_s - nearest
    return np.asarray(5.0 * np.clip(0.5 + since * FS_HZ / 4.0, 0.0, 1.0) * (since < 0.003))


def write_recording(record: siggen.Record, file: Path, *, tacho: bool = True) -> Path:
    """Write channels as text, a tacho's waveform beside them if there is one."""
    signals = {f"ch{k + 1} [m/s2]": signal for k, signal in enumerate(record.channels.values())}
    if tacho:
        time_s = np.arange(next(iter(signals.values())).size) / FS_HZ
        signals["tacho"] = tacho_waveform(time_s, record.tacho_s)
    np.savetxt(
        file, np.stack(list(signals.values()), axis=1), delimiter=",", header=",".join(signals), comments="", fmt="%.7g"
    )
    return file


def hidden_recordings(folder: Path, **changes: Any) -> list[Path]:
    """Write four healthy recordings of the hidden machine, with these sections changed; return the files."""
    gearbox = siggen.draw(siggen.load_config({**HIDDEN, **changes}))
    records = siggen.runs(gearbox, gearbox.cases)
    return [write_recording(record, folder / f"run{k}.csv") for k, record in enumerate(records)]


def channel_data(file: Path) -> np.ndarray:
    """Return the vibration channels (n, 2) of a file."""
    return np.loadtxt(file, delimiter=",", skiprows=1)[:, :2]


def hidden_record() -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return channels and pulse times of the hidden machine's first recording."""
    record = siggen.run(siggen.draw(siggen.load_config(HIDDEN)))
    return dict(record.channels), record.tacho_s
