"""What is drawn of sensors: one channel for each of their axes, as a gearbox has them for all of its records."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Config
from siggen.config.config import MOST_SPECIMENS
from siggen.keys.number import Number, constant
from siggen.noise.source import Source
from siggen.seeding import Stream, named_generator, named_uniforms
from siggen.sensing.inputs import FORCE, Input
from siggen.sensing.responses import FrequencyResponse
from siggen.sensors.path import MeasuredPath
from siggen.sensors.quantity import Quantity
from siggen.sensors.response_text import decoded_response
from siggen.sensors.sensor import AxisDraws, SensorBase
from siggen.sensors.transducer import Transducer

MOST_RENEWALS = 400
"""So all keys of sensors are below 2^32: one word of a seed, which no two others look like."""


@dataclass(frozen=True, slots=True)
class MeasuredWay:
    """A measured accelerance from bearing forces to a sensor.

    Attributes
    ----------
    response : curves
    forces : bearing forces that it begins at, as place/axis
    weights : direction -> what the channel sees of it
    number, of_several : which of the files the gearbox drew, from 0, and whether there are several
    """

    response: FrequencyResponse
    forces: tuple[str, ...]
    weights: Mapping[str, float]
    number: int
    of_several: bool


@dataclass(frozen=True, slots=True)
class DrawnChannel:
    """One axis of one sensor, in the unit of its quantity.

    Attributes
    ----------
    name, sensor, place, axis : of the channel, of its sensor, where that stands, and along which of its axes
    quantity : what it holds
    gain : of the amplifier
    shown : what of the model it shows -> factor on it; what a path adds comes by itself
    response : frequencies (k,) -> what mounting, sensor and coupling do there (k,); None for nothing
    coupling_hz : corner of the coupling, None without
    transducer : what makes a reading of the whole record; None where it reads what it shows
    limit, bits : of its converter; None: not quantised
    noise_floor : standard deviation of its white noise, drawn per record or level; None without
    sources : what is added to it besides
    path : measured accelerance in place of the housing's; None without
    """

    name: str
    sensor: str
    place: str
    axis: str
    quantity: Quantity
    gain: float
    shown: Mapping[Input, float]
    coupling_hz: float | None
    limit: float
    bits: int | None
    noise_floor: Number | None
    sources: tuple[Source, ...]
    response: Callable[[FloatArray], ComplexArray | None] = field(compare=False)
    transducer: Transducer | None = field(compare=False)
    path: MeasuredWay | None = field(compare=False)

    @property
    def reads(self) -> frozenset[str]:
        """Kinds of `Input` that it needs: those that it shows, and forces where they come through a path."""
        return frozenset({one.kind for one in self.shown} | (set() if self.path is None else {FORCE}))


def drawn_channels(config: Config, specimen_id: int, sensors: Sequence[SensorBase]) -> Iterator[DrawnChannel]:
    """Yield the channels of drawn sensors."""
    uniform = named_uniforms(config.seed, Stream.SENSOR, specimen_id)
    named = partial(_named, config.seed, specimen_id)
    pressed = config.places.pressed
    for sensor in sensors:
        for axis, gain in zip(sensor.axes, sensor.gains, strict=True):
            draw = AxisDraws(uniform, f"sensors.{sensor.name}.{axis}", named)
            yield DrawnChannel(
                name=sensor.channel_name(axis),
                sensor=sensor.name,
                place=sensor.place,
                axis=axis,
                quantity=sensor.quantity,
                gain=constant(gain),
                shown=sensor.shows(axis, draw),
                response=partial(sensor.response, draw),
                coupling_hz=sensor.coupling_hz(draw),
                transducer=sensor.transducer(axis, draw),
                limit=sensor.limit,
                bits=sensor.converter_bits,
                noise_floor=sensor.noise_floor,
                sources=sensor.sources,
                path=_way(sensor.through, sensor.weights(axis, draw), uniform, pressed),
            )


def sensors_of(specimen_id: int, renewal: int) -> int:
    """Return the key of the sensors of a gearbox, or of those that a renewal puts in their place.

    Those are of a gearbox beyond all that a set may have.
    """
    return specimen_id + renewal * MOST_SPECIMENS


def renewed_channels(config: Config, specimen_id: int, renewal: int) -> tuple[DrawnChannel, ...]:
    """Return the channels of a gearbox by its own configuration, drawn anew at their old places."""
    key = sensors_of(specimen_id, renewal)
    uniform = named_uniforms(config.seed, Stream.SENSOR, key)
    return tuple(drawn_channels(config, key, [one.drawn(uniform) for one in config.sensors]))


def _named(seed: int, specimen_id: int, name: str) -> np.random.Generator:
    return named_generator(seed, Stream.SENSOR, specimen_id, name=name)


def _way(
    path: MeasuredPath | None, weights: Mapping[str, float], uniform: Callable[[str], float], pressed: Sequence[str]
) -> MeasuredWay | None:
    """Return the measured path of a gearbox, one of its files; sensors with as many files have the same."""
    if path is None:
        return None
    count = len(path.family)
    number = min(int(uniform("path.number") * count), count - 1) if count > 1 else 0
    response = decoded_response(path.family[number])
    known = {force for _, force in response.curves}
    return MeasuredWay(response, tuple(one for one in pressed if one in known), weights, number, path.is_family)
