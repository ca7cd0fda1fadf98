"""Columns about one channel: its noise, its path, its disturbances; a set has those of the parts that its sensors have.

What a channel measures stands in `siggen.columns.record`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pyarrow as pa

from siggen.keys.column import DECIBEL, Column, Role, in_role
from siggen.sensing.inputs import MOTION

if TYPE_CHECKING:
    from siggen.gearbox.channels import DrawnChannel
    from siggen.gearbox.specimen import Specimen


def channel_columns(gearbox: Specimen) -> tuple[Column, ...]:
    """Return the columns of all channels: their noise, then path and disturbances of each."""
    noises = (column for channel in gearbox.channels for column in _noise(channel))
    ways = (column for channel in gearbox.channels for column in _way(channel, heard=gearbox.passes_forces))
    return in_role(Role.PROVENANCE, *noises, *ways, section="sensors")


def _noise(channel: DrawnChannel) -> Iterator[Column]:
    name, quantity = channel.name, channel.quantity
    floor = f"noise_floor_{name}_{quantity.suffix}"
    level = f"power of the signal over the white noise in {name}"
    yield Column(floor, pa.float64(), quantity.unit, f"RMS of the white noise in {name}")
    yield Column(f"snr_{name}_db", pa.float64(), DECIBEL, level, Role.CONSEQUENCE)
    yield Column(f"clipped_share_{name}", pa.float64(), "", f"share of clipped samples in {name}", Role.MEASURED)


def _way(channel: DrawnChannel, *, heard: bool) -> Iterator[Column]:
    name, quantity, path = channel.name, channel.quantity, channel.path
    if path is not None or (heard and MOTION in channel.reads):
        accelerance = f"rms accelerance to {name}, 100 Hz to 0.45 fs, all forces"
        yield Column(f"path_modes_{name}", pa.int32(), "", f"modes of the housing to {name}; 0 if it was measured")
        yield Column(f"path_accelerance_{name}_m_s2_per_n", pa.float64(), "m/s^2/N", accelerance)
    if path is not None and path.of_several:
        yield Column(f"path_number_{name}", pa.int32(), "", f"which of the measured paths to {name}, from 0")
    for source in channel.sources:
        unit = f"{quantity.unit}{source.per[1]}"
        yield Column(source.column(name, quantity.suffix), pa.float64(), unit, f"{source.meaning} {name}")
