"""The instrument of one specimen: for every channel the way from bearing forces and model to the amplifier."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial, reduce

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Config
from siggen.dynamics.structure.makers import SEATS_OF_SET
from siggen.dynamics.time.decimation import PASS_EDGE
from siggen.keys.number import constant
from siggen.planning.specimen import Specimen
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensing.block_filter import TOGETHER, BlockGrid, block_grid, limited
from siggen.sensing.inputs import BACKGROUND, FORCE, MOTION, Input
from siggen.sensing.spectral_filter import frequencies
from siggen.sensors.path import MeasuredPath
from siggen.sensors.sensor import AxisDraws, SensorBase
from siggen.sensors.transducer import Transducer
from siggen.specimen.background import (
    SpecimenBackground,
    background_history_s,
    drawn_background,
    specimen_background,
)
from siggen.specimen.forced_ways import ChannelWay
from siggen.specimen.housing import housing_settle_s, specimen_housing
from siggen.specimen.measured_path import MEMORY_S, decoded_response
from siggen.specimen.set_on_housing import forces_through_housing
from siggen.specimen.specimen_housing import SpecimenHousing
from siggen.specimen.structure import moved_along


@dataclass(frozen=True, slots=True)
class BlockResponses:
    """Channel -> input -> spectrum (length // 2 + 1,) of the filter; no inputs that a channel does not feel."""

    grid: BlockGrid
    filters: Mapping[str, Mapping[Input, NDArray[np.complex64]]]

    @property
    def inputs(self) -> tuple[Input, ...]:
        """All inputs that a channel feels."""
        return tuple(dict.fromkeys(one for filters in self.filters.values() for one in filters))


def block_responses(grid: BlockGrid, ways: Mapping[str, Mapping[Input, ComplexArray]]) -> BlockResponses:
    """Return the filters of responses (memory // 2 + 1,)."""
    return BlockResponses(grid, {name: _filters(grid, found) for name, found in ways.items()})


def _filters(grid: BlockGrid, ways: Mapping[Input, ComplexArray]) -> dict[Input, NDArray[np.complex64]]:
    names, responses = tuple(ways), tuple(ways.values())
    parts = (np.array(responses[k : k + TOGETHER]) for k in range(0, len(responses), TOGETHER))
    return dict(zip(names, (row for part in parts for row in limited(part, grid)), strict=True))


CHAIN_HISTORY_S = 0.02
"""History for the resonances of sensors without a path; those above 1 kHz with 1 % damping have 0.1 % left after it."""
BAND_HZ = 100.0
"""Frequency from which the rms accelerance of a path is taken, up to 0.45 of the sampling rate."""


@dataclass(frozen=True, slots=True)
class ChannelInstrument:
    """One axis of one sensor.

    Attributes
    ----------
    name, sensor, gain : of the channel
    seen : what of the model it shows -> factor on it; several with cross-axis sensitivity
    accelerance : (forces, k) m/s² per N from bearing forces, before the sensor; None without a path
    sensor_response : (k,) of mounting, sensor and coupling; None without
    path_modes, path_rms_m_s2_per_n : number of modes, and rms accelerance over inputs and band; 0 without a path
    path_number : which of several measured paths
    high_pass_hz : corner of the coupling, None without
    transducer : what makes a reading of the whole record; None where it reads what it shows
    forces : bearing forces that its path begins at
    """

    name: str
    sensor: SensorBase
    gain: float
    seen: Mapping[Input, float]
    accelerance: ComplexArray | None
    sensor_response: ComplexArray | None
    path_modes: int
    path_rms_m_s2_per_n: float
    path_number: int = 0
    high_pass_hz: float | None = None
    transducer: Transducer | None = None
    forces: tuple[str, ...] = ()

    @property
    def is_plain(self) -> bool:
        """Whether it stores one quantity of the model as it is."""
        return self.accelerance is None and self.sensor_response is None and list(self.seen.values()) == [1.0]

    @property
    def motions(self) -> tuple[str, ...]:
        """Names of the model's motions that it shows."""
        return tuple(one.name for one in self.seen if one.kind == MOTION)


@dataclass(frozen=True, slots=True)
class Instrument:
    """All channels of one specimen, and the length whose frequencies their responses have: what `blocks` remember."""

    length: int
    fs_hz: float
    channels: tuple[ChannelInstrument, ...]
    blocks: BlockResponses
    background: SpecimenBackground | None = None


def settle_s(specimen: Specimen) -> float:
    """Return the time before the first sample over which what lies between bearings and sensors settles [s]."""
    measured = any(isinstance(sensor.through, MeasuredPath) for sensor in specimen.sensors)
    return max(housing_settle_s(specimen), MEMORY_S if measured else 0.0)


def history_s(specimen: Specimen) -> float:
    """Return the history that the instrument needs [s].

    The longest memory of a filter counts whatever the sensors are: the motion begins before it. Otherwise a sensor
    that is added would move all others by what is left of the start.
    """
    return max(settle_s(specimen), CHAIN_HISTORY_S)


def specimen_instrument(config: Config, specimen: Specimen) -> Instrument:
    """Return the instrument of a specimen; the same for all of its states, operating points and repeats."""
    section = drawn_background(config, specimen.specimen_id)
    history = max(history_s(specimen), background_history_s(section))
    blocks = block_grid(round(history * config.fs_hz), config.samples)
    housing = specimen_housing(specimen)
    uniform = named_uniforms(config.seed, Stage.SENSOR, specimen.specimen_id)
    named = partial(_named, config.seed, specimen.specimen_id)
    grid = frequencies(blocks.memory, config.fs_hz)
    along = moved_along(specimen)
    channels, ways = [], {}
    paths = _Paths(housing, grid, along, config.places.pressed)
    for sensor in specimen.sensors:
        for axis, gain in zip(sensor.axes, sensor.gains, strict=True):
            draw = AxisDraws(uniform, f"sensors.{sensor.name}.{axis}", named)
            channel, ways[sensor.channel_name(axis)] = _channel(sensor, axis, constant(gain), draw, paths)
            channels.append(channel)
    if config.turns_in_housing:
        through = forces_through_housing(specimen, ways, grid)
        channels = [_on_set(channel, through[channel.name], grid) for channel in channels]
    background = None
    if section is not None:
        background = specimen_background(config, specimen, section, ways, grid)
    filters = block_responses(
        blocks, {channel.name: channel_ways(channel, background, grid.size) for channel in channels}
    )
    if background is not None:  # nobody asks for them again
        background = replace(background, responses={})
    return Instrument(blocks.memory, config.fs_hz, tuple(channels), filters, background)


def _on_set(channel: ChannelInstrument, accelerance: ComplexArray, grid: FloatArray) -> ChannelInstrument:
    """Return a channel on the housing of a planetary set: what it shows of the model is the ground's alone."""
    rms = _band_rms(accelerance[:-1], grid)  # the last one is by a moment
    return replace(channel, seen={}, accelerance=accelerance, forces=SEATS_OF_SET, path_rms_m_s2_per_n=rms)


def channel_ways(
    channel: ChannelInstrument, background: SpecimenBackground | None, bins: int
) -> dict[Input, ComplexArray]:
    """Return input -> response (k,), sensor included, but for motions of a plain channel."""
    ways: dict[Input, ComplexArray] = {}
    sensed = channel.sensor_response
    if sensed is None:
        sensed = np.ones(bins, dtype=np.complex128)
    if not channel.is_plain:
        ways |= {one: weight * sensed for one, weight in channel.seen.items()}
    if channel.accelerance is not None:
        for name, row in zip(channel.forces, channel.accelerance, strict=True):
            force, through = Input(FORCE, name), row * sensed
            ways[force] = ways[force] + through if force in ways else through
    if background is not None and background.inputs:
        rows = zip(background.inputs, background.responses[channel.name], strict=True)
        ways |= {Input(BACKGROUND, name): row * sensed for name, row in rows}
    return ways


def _named(seed: int, specimen_id: int, name: str) -> np.random.Generator:
    return named_generator(seed, Stage.SENSOR, specimen_id, name=name)


@dataclass(frozen=True, slots=True)
class _Paths:
    """A housing, a grid of frequencies (k,), motions along the shafts, and bearing forces."""

    housing: SpecimenHousing | None
    grid: FloatArray
    along: tuple[str, ...]
    pressed: tuple[str, ...]


def _channel(
    sensor: SensorBase, axis: str, gain: float, draw: AxisDraws, paths: _Paths
) -> tuple[ChannelInstrument, ChannelWay]:
    """Return a channel and what it sees of forces that the model does not make."""
    housing, grid, shown = paths.housing, paths.grid, sensor.shows(axis, draw)
    motions = {one.name: weight for one, weight in shown.items() if one.kind == MOTION}
    accelerance, beyond, entries = None, None, None
    forces = () if housing is None else housing.forces
    if isinstance(sensor.through, MeasuredPath):
        weights = sensor.weights(axis, draw)
        forces, accelerance = _measured(sensor, weights, draw, paths)
        beyond = accelerance
    elif housing is not None and motions:
        coupled, others = slice(housing.coupled), slice(housing.coupled, None)
        beyond = housing.shown_accelerance(motions, forces, grid, others)
        entries = housing.shown_accelerance(motions, tuple(housing.entries), grid, others)
        accelerance = beyond + housing.shown_accelerance(motions, forces, grid, coupled)
    channel = ChannelInstrument(
        name=sensor.channel_name(axis),
        sensor=sensor,
        gain=gain,
        seen=_of_model(shown, housing, paths.along),
        forces=forces,
        accelerance=accelerance,
        sensor_response=sensor.response(draw, grid),
        high_pass_hz=sensor.coupling_hz(draw),
        path_modes=0 if housing is None or entries is None else housing.modes.frequency_hz.size,
        path_rms_m_s2_per_n=0.0 if accelerance is None else _band_rms(accelerance, grid),
        path_number=path_number(sensor, draw.uniform),
        transducer=sensor.transducer(axis, draw),
    )
    return channel, ChannelWay(shown, beyond, entries, forces)


def _of_model(
    shown: Mapping[Input, float], housing: SpecimenHousing | None, along: tuple[str, ...]
) -> dict[Input, float]:
    """Return what of the model's motion is shown as it is: nothing that the modes of a housing give.

    `along` are the motions along the shafts that the model has.
    """
    motions = {} if housing is None else housing.motions
    return {
        one: weight
        for one, weight in shown.items()
        if one.kind != MOTION or not (one.name in motions or (one.name.endswith("/axial") and one.name not in along))
    }


def path_number(sensor: SensorBase, uniform: Callable[[str], float]) -> int:
    """Return which file of a measured path a gearbox drew, from 0; sensors with as many files have the same."""
    family = sensor.through.family if isinstance(sensor.through, MeasuredPath) else ()
    return min(int(uniform("path.number") * len(family)), len(family) - 1) if len(family) > 1 else 0


def _measured(
    sensor: SensorBase, weights: Mapping[str, float], draw: AxisDraws, paths: _Paths
) -> tuple[tuple[str, ...], ComplexArray]:
    """Return bearing forces, and the accelerance (forces, k) from them that was measured."""
    assert isinstance(sensor.through, MeasuredPath)
    response = decoded_response(sensor.through.family[path_number(sensor, draw.uniform)])
    known = {force for _, force in response.curves}
    forces = tuple(force for force in paths.pressed if force in known)
    rows = (weight * response.accelerance(d, forces, paths.grid) for d, weight in weights.items())
    return forces, reduce(np.add, rows)


def _band_rms(accelerance: ComplexArray, grid: FloatArray) -> float:
    band = (grid >= BAND_HZ) & (grid <= PASS_EDGE * 2.0 * grid[-1])
    return float(np.sqrt((np.abs(accelerance[:, band]) ** 2).mean()))
