"""What is drawn for one channel of a record, and what its labels say."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from siggen.config import Config
from siggen.keys.number import at
from siggen.noise.source import Draws
from siggen.planning.plan import PlannedRecord
from siggen.record.background_course import noise_levels
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensing.measurement import Measurement
from siggen.sensors.path import MeasuredPath
from siggen.specimen.drive import record_owner
from siggen.specimen.instrument import ChannelInstrument


def channel_draws(config: Config, record: PlannedRecord, channel: str) -> Draws:
    """Return where the numbers of a channel come from."""
    owner, levels = record_owner(record), noise_levels(config, record)
    return Draws(
        named_uniforms(config.seed, Stage.PATH, record.specimen_id),
        named_uniforms(config.seed, Stage.NOISE, *owner),
        partial(_named, config.seed, owner, channel),
        None if levels is None else partial(_level, levels, channel),
    )


def white_noise(
    config: Config, record: PlannedRecord, channel: ChannelInstrument, draws: Draws
) -> tuple[np.random.Generator, float | None]:
    """Return the generator of a channel's white noise, and its floor; None without one."""
    rng = named_generator(config.seed, Stage.NOISE, *record_owner(record), name=channel.name)
    floor, u = channel.sensor.noise_floor, draws.level("noise", rng)
    return rng, None if floor is None else at(floor, u)


def _named(seed: int, owner: tuple[int, ...], channel: str, part: str) -> np.random.Generator:
    return named_generator(seed, Stage.NOISE, *owner, name=f"{channel} {part}")


def _level(levels: Callable[[str], float], channel: str, name: str) -> float:
    return levels(f"sensors.{channel}.{name}")


def channel_labels(channel: ChannelInstrument, measured: Measurement) -> dict[str, object]:
    """Return the labels of a channel's measurement and of its path."""
    labels: dict[str, object] = {
        f"noise_floor_{channel.name}_{channel.sensor.quantity.suffix}": measured.noise_floor,
        f"snr_{channel.name}_db": measured.snr_db,
        f"clipped_share_{channel.name}": measured.clipped_share,
    }
    if channel.accelerance is not None:
        labels[f"path_modes_{channel.name}"] = channel.path_modes
        labels[f"path_accelerance_{channel.name}_m_s2_per_n"] = channel.path_rms_m_s2_per_n
        if isinstance(channel.sensor.through, MeasuredPath) and channel.sensor.through.is_family:
            labels[f"path_number_{channel.name}"] = channel.path_number
    return labels
