"""What is added to one channel of one record by its surroundings and its electronics, and the labels of it."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.noise.source import Draws, NoisyChannel
from siggen.specimen.instrument import ChannelInstrument


class ChannelDisturbance:
    """What the sources of a channel add to it behind its amplifier, part after part, and the labels of it."""

    def __init__(self, channel: ChannelInstrument, about: NoisyChannel, draws: Draws) -> None:
        sources, suffix = channel.sensor.sources, channel.sensor.quantity.suffix
        self._parts = {one.column(channel.name, suffix): one.part(about, draws) for one in sources}
        self.follows_angle = any(one.follows_angle for one in sources)

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray | None:
        """Return what is added (k,) from sample `first` on, at angles of the pinion (k,); None for nothing.

        Unless it `follows_angle`, angles count by their number alone.
        """
        if not self._parts:
            return None
        signal = np.zeros(angle_rad.size)
        for part in self._parts.values():
            signal += part.take(first, angle_rad)
        return signal

    @property
    def labels(self) -> dict[str, object]:
        """The labels, complete when all was taken."""
        return {column: part.label for column, part in self._parts.items()}
