"""Columns about transfer paths and disturbances; a set has those of the parts that its configuration has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.columns.column import Column

if TYPE_CHECKING:
    from siggen.config import Config, Sensor

FORCE_NOISE_COLUMN = Column(
    "force_noise_n_per_sqrt_hz", pa.float64(), "N/sqrt(Hz)", "noise on each bearing force, below its corner"
)


def channel_columns(sensor: Sensor, channel: str) -> tuple[Column, ...]:
    """Return the columns that describe path and disturbances of one channel: those of parts that its sensor has."""
    accelerance = f"path_accelerance_{channel}_m_s2_per_n"
    parts: dict[str, tuple[object, Column]] = {
        "modes": (
            sensor.path,
            Column(f"path_modes_{channel}", pa.int32(), "", f"flexible modes to {channel}; 0 if it was measured"),
        ),
        "accelerance": (
            sensor.path,
            Column(
                accelerance, pa.float64(), "m/s^2/N", f"rms accelerance to {channel}, 100 Hz to 0.45 fs, all forces"
            ),
        ),
        "number": (
            getattr(sensor.path, "is_family", False) or None,
            Column(f"path_number_{channel}", pa.int32(), "", f"which of the measured paths to {channel}, from 0"),
        ),
        "pink": (
            sensor.pink_noise,
            Column(
                f"pink_noise_{channel}_m_s2_per_sqrt_hz", pa.float64(), "m/s^2/sqrt(Hz)", f"at the corner, in {channel}"
            ),
        ),
        "spectrum": (
            sensor.noise_spectrum,
            Column(
                f"noise_spectrum_{channel}_m_s2",
                pa.float64(),
                "m/s^2",
                f"RMS of the noise of given density in {channel}",
            ),
        ),
        **{
            part: (section, Column(f"{part}_{channel}_m_s2", pa.float64(), "m/s^2", f"RMS of {what} {channel}"))
            for part, section, what in (
                ("lines", sensor.lines, "the lines of given orders or frequencies in"),
                ("mains", sensor.mains, "mains hum in"),
                ("tones", sensor.tones, "the tones of other machines at"),
                ("inverter", sensor.inverter, "the inverter's lines at"),
            )
        },
    }
    return tuple(column for section, column in parts.values() if section not in (None, False))


def instrument_columns(config: Config) -> Iterator[Column]:
    """Yield the columns of all parts that a configuration has, channel by channel."""
    for sensor in config.sensors:
        for axis in sensor.axes:
            yield from channel_columns(sensor, f"{sensor.name}_{axis}")
    if config.housing is not None and config.housing.force_noise is not None:
        yield FORCE_NOISE_COLUMN
