"""What channels hold, in words and unit, as pages show it: what the files of a set say."""

from __future__ import annotations

from typing import NamedTuple

from siggen.dataset.reading import Dataset


class ShownQuantity(NamedTuple):
    """A quantity and its unit."""

    word: str
    unit: str


RECORDED = ShownQuantity("acceleration", "m/s²")
"""What recordings are turned into when they are read."""

ANGULAR_SPEED, TRANSMISSION_ERROR = "angular speed", "transmission error"
"""Words of what encoders give, as the files of a set say them."""


def channel_quantities(dataset: Dataset) -> dict[str, ShownQuantity]:
    """Return channel name -> what it holds."""
    return {channel.name: ShownQuantity(channel.quantity, channel.shown_unit) for channel in dataset.channels}
