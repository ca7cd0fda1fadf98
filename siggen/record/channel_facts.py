"""What is drawn for one channel of a record, and what its labels say."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from siggen.gearbox.channels import DrawnChannel
from siggen.keys.number import at
from siggen.noise.source import Draws
from siggen.planning.plan import PlannedRecord
from siggen.seeding import Stream, named_generator, named_uniforms
from siggen.sensing.measurement import Measurement
from siggen.specimen.instrument import ChannelInstrument


def channel_draws(seed: int, record: PlannedRecord, channel: str, *, levelled: bool) -> Draws:
    """Return where the numbers of a channel come from; noise that is `levelled` has that of the gearbox."""
    owner, levels = record.owner, named_uniforms(seed, Stream.BACKGROUND, record.specimen_id)
    return Draws(
        named_uniforms(seed, Stream.PATH, record.specimen_id),
        named_uniforms(seed, Stream.NOISE, *owner),
        partial(_named, seed, owner, channel),
        partial(_level, levels, channel) if levelled else None,
    )


def white_noise(
    seed: int, record: PlannedRecord, channel: DrawnChannel, draws: Draws
) -> tuple[np.random.Generator, float | None]:
    """Return the generator of a channel's white noise, and its floor; None without one."""
    rng = named_generator(seed, Stream.NOISE, *record.owner, name=channel.name)
    floor, u = channel.noise_floor, draws.level("noise", rng)
    return rng, None if floor is None else at(floor, u)


def _named(seed: int, owner: tuple[int, ...], channel: str, part: str) -> np.random.Generator:
    return named_generator(seed, Stream.NOISE, *owner, name=f"{channel} {part}")


def _level(levels: Callable[[str], float], channel: str, name: str) -> float:
    return levels(f"sensors.{channel}.{name}")


def channel_labels(channel: ChannelInstrument, measured: Measurement) -> dict[str, object]:
    """Return the labels of a channel's measurement and of its path."""
    labels: dict[str, object] = {
        f"noise_floor_{channel.name}_{channel.drawn.quantity.suffix}": measured.noise_floor,
        f"snr_{channel.name}_db": measured.snr_db,
        f"clipped_share_{channel.name}": measured.clipped_share,
    }
    if channel.accelerance is not None:
        labels[f"path_modes_{channel.name}"] = channel.path_modes
        labels[f"path_accelerance_{channel.name}_m_s2_per_n"] = channel.path_rms_m_s2_per_n
        if channel.drawn.path is not None and channel.drawn.path.of_several:
            labels[f"path_number_{channel.name}"] = channel.drawn.path.number
    return labels
