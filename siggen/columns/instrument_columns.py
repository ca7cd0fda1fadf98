"""Columns about transfer paths and disturbances; a set has those of the parts that its configuration has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import Column, Role, in_role
from siggen.sensing.inputs import MOTION

if TYPE_CHECKING:
    from siggen.config import Config
    from siggen.sensors.sensor import SensorBase


def channel_columns(sensor: SensorBase, channel: str, *, gives_way: bool) -> Iterator[Column]:
    """Yield the columns that describe path and disturbances of one channel: those of parts that its sensor has."""
    yield from in_role(Role.PROVENANCE, *_parts(sensor, channel, gives_way=gives_way), section="sensors")


def _parts(sensor: SensorBase, channel: str, *, gives_way: bool) -> Iterator[Column]:
    if sensor.through is not None or (gives_way and MOTION in sensor.reads):
        yield from path_columns(channel, is_family=getattr(sensor.through, "is_family", False))
    for source in sensor.sources:
        name = source.column(channel, sensor.quantity.suffix)
        yield Column(name, pa.float64(), f"{sensor.quantity.unit}{source.per[1]}", f"{source.meaning} {channel}")


def path_columns(channel: str, *, is_family: bool) -> Iterator[Column]:
    """Yield the columns about the path to one channel."""
    accelerance = f"rms accelerance to {channel}, 100 Hz to 0.45 fs, all forces"
    yield Column(f"path_modes_{channel}", pa.int32(), "", f"modes of the housing to {channel}; 0 if it was measured")
    yield Column(f"path_accelerance_{channel}_m_s2_per_n", pa.float64(), "m/s^2/N", accelerance)
    if is_family:
        yield Column(f"path_number_{channel}", pa.int32(), "", f"which of the measured paths to {channel}, from 0")


def instrument_columns(config: Config) -> Iterator[Column]:
    """Yield the columns of all parts that a configuration has, channel by channel."""
    for sensor in config.sensors:
        for name, _ in sensor.channels:
            yield from channel_columns(sensor, name, gives_way=config.gives_way or config.turns_in_housing)
