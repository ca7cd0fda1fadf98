"""The instrument of one specimen: for every channel the way from bearing forces and model to the amplifier."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from siggen.arrays import ComplexArray, FloatArray
from siggen.drivetrain.drivetrain import Modes
from siggen.drivetrain.makers import SEATS_OF_SET, Housing, supports_of_set
from siggen.drivetrain.structure import Structure
from siggen.gearbox.channels import DrawnChannel, MeasuredWay
from siggen.gearbox.specimen import Specimen
from siggen.motion.decimation import PASS_EDGE
from siggen.record.forced_ways import (
    ChannelWay,
    Forcing,
    SpecimenBackground,
    background_history_s,
    forced_ways,
    mean_meshes,
    specimen_background,
)
from siggen.record.housing import SpecimenHousing, housing_settle_s, specimen_housing
from siggen.record.structure import linear_structure, linear_train, moved_along, specimen_body
from siggen.sensing.filters import TOGETHER, BlockGrid, block_grid, frequencies, limited
from siggen.sensing.inputs import BACKGROUND, FORCE, MOTION, Input
from siggen.sensing.responses import MEMORY_S

# What a planetary set presses its housing with, as its channels hear it: forces on held seats, set free (derived).
#
# Seats that modes beyond those of the machine let give way by R lie in series with the springs, K = (1/k + R)^-1. A
# force F_0 on one of them stretches that chain by R F_0, which passes K R F_0 back to the body.


def forces_through_housing(
    specimen: Specimen, channels: Mapping[str, ChannelWay], frequency_hz: FloatArray
) -> dict[str, ComplexArray]:
    """Return channel -> response (`SEATS_OF_SET`, k) at frequencies (k,) to what a set presses held seats with.

    Raises
    ------
    ValueError
        If a channel shows what the machine does not have.
    """
    housing, assembled = specimen_body(specimen), linear_structure(linear_train(specimen))
    assert housing is not None
    assert specimen.planets is not None
    supports = supports_of_set(specimen.planets.stage, None)
    forcing = _on_seats(assembled, housing, np.concatenate([np.diag(one.stiffness) for one in supports]))
    return forced_ways((assembled, mean_meshes(specimen, assembled)), forcing, channels, frequency_hz)


def _on_seats(assembled: Structure, housing: Housing, stiffness: FloatArray) -> Forcing:
    """Return unit forces on the seats of a housing whose springs have a stiffness (seats,)."""
    split = [name.split("/") for name in SEATS_OF_SET]
    seats = np.array([assembled.drivetrain.row(housing.seats[place], along) for place, along in split])
    flexibility = np.zeros((len(seats), len(seats)))
    if isinstance(housing.body, Modes):
        order = [housing.body.seats.index(name) for name in SEATS_OF_SET]
        flexibility = housing.body.give_m_per_n[np.ix_(order, order)]
    pulled = np.array([assembled.bearing_forces[name][0] for name in SEATS_OF_SET])
    back = np.linalg.solve(np.diag(1.0 / stiffness) + flexibility, flexibility)
    rows, shares = seats + flexibility @ pulled, np.eye(len(seats)) - back
    pressed = [dict(zip(SEATS_OF_SET, own, strict=True)) for own in shares.T.tolist()]
    return Forcing(dict(zip(SEATS_OF_SET, rows, strict=True)), dict(zip(SEATS_OF_SET, pressed, strict=True)))


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
    """A channel behind what carries its sensor.

    Attributes
    ----------
    drawn : what the gearbox has of it
    seen : what of the model it shows -> factor on it; several with cross-axis sensitivity
    accelerance : (forces, k) m/s² per N from bearing forces, before the sensor; None without a path
    sensor_response : (k,) of mounting, sensor and coupling; None without
    path_modes, path_rms_m_s2_per_n : number of modes, and rms accelerance over inputs and band; 0 without a path
    forces : bearing forces that its path begins at
    """

    drawn: DrawnChannel
    seen: Mapping[Input, float]
    accelerance: ComplexArray | None
    sensor_response: ComplexArray | None
    path_modes: int
    path_rms_m_s2_per_n: float
    forces: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Name of the channel."""
        return self.drawn.name

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
    """All channels of one specimen, and the length whose frequencies their responses have: what `blocks` remember.

    `acting` are the inputs of its background.
    """

    length: int
    fs_hz: float
    channels: tuple[ChannelInstrument, ...]
    blocks: BlockResponses
    acting: tuple[str, ...] = ()


def settle_s(specimen: Specimen) -> float:
    """Return the time before the first sample over which what lies between bearings and sensors settles [s]."""
    measured = any(channel.path is not None for channel in specimen.channels)
    return max(housing_settle_s(specimen), MEMORY_S if measured else 0.0)


def history_s(specimen: Specimen) -> float:
    """Return the history that the instrument needs [s].

    The longest memory of a filter counts whatever the sensors are: the motion begins before it. Otherwise a sensor
    that is added would move all others by what is left of the start.
    """
    return max(settle_s(specimen), CHAIN_HISTORY_S)


def specimen_instrument(specimen: Specimen) -> Instrument:
    """Return the instrument of a specimen; the same for all of its states, operating points and repeats."""
    drawn, fs_hz = specimen.background, specimen.sampling.fs_hz
    history = max(history_s(specimen), 0.0 if drawn is None else background_history_s(specimen, drawn))
    blocks = block_grid(round(history * fs_hz), specimen.sampling.samples)
    housing = specimen_housing(specimen)
    grid = frequencies(blocks.memory, fs_hz)
    paths = _Paths(housing, grid, moved_along(specimen))
    found = [_channel(channel, paths) for channel in specimen.channels]
    channels, ways = [channel for channel, _ in found], {channel.name: way for channel, way in found}
    if specimen.planets is not None and specimen.housed:
        through = forces_through_housing(specimen, ways, grid)
        channels = [_on_set(channel, through[channel.name], grid) for channel in channels]
    background = None if drawn is None else specimen_background(specimen, drawn, ways, grid)
    filters = block_responses(
        blocks, {channel.name: channel_ways(channel, background, grid.size) for channel in channels}
    )
    acting = () if background is None else background.inputs
    return Instrument(blocks.memory, fs_hz, tuple(channels), filters, acting)


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


@dataclass(frozen=True, slots=True)
class _Paths:
    """A housing, a grid of frequencies (k,), and motions along the shafts."""

    housing: SpecimenHousing | None
    grid: FloatArray
    along: tuple[str, ...]


def _channel(drawn: DrawnChannel, paths: _Paths) -> tuple[ChannelInstrument, ChannelWay]:
    """Return a channel and what it sees of forces that the model does not make."""
    housing, grid, shown = paths.housing, paths.grid, drawn.shown
    motions = {one.name: weight for one, weight in shown.items() if one.kind == MOTION}
    accelerance, beyond, entries = None, None, None
    forces = () if housing is None else housing.forces
    if drawn.path is not None:
        forces, accelerance = drawn.path.forces, _measured(drawn.path, grid)
        beyond = accelerance
    elif housing is not None and motions:
        coupled, others = slice(housing.coupled), slice(housing.coupled, None)
        beyond = housing.shown_accelerance(motions, forces, grid, others)
        entries = housing.shown_accelerance(motions, tuple(housing.entries), grid, others)
        accelerance = beyond + housing.shown_accelerance(motions, forces, grid, coupled)
    channel = ChannelInstrument(
        drawn,
        seen=_of_model(shown, housing, paths.along),
        accelerance=accelerance,
        sensor_response=drawn.response(grid),
        path_modes=0 if housing is None or entries is None else housing.modes.frequency_hz.size,
        path_rms_m_s2_per_n=0.0 if accelerance is None else _band_rms(accelerance, grid),
        forces=forces,
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


def _measured(path: MeasuredWay, grid: FloatArray) -> ComplexArray:
    """Return the accelerance (forces, k) that was measured."""
    return reduce(np.add, (w * path.response.accelerance(d, path.forces, grid) for d, w in path.weights.items()))


def _band_rms(accelerance: ComplexArray, grid: FloatArray) -> float:
    band = (grid >= BAND_HZ) & (grid <= PASS_EDGE * 2.0 * grid[-1])
    return float(np.sqrt((np.abs(accelerance[:, band]) ** 2).mean()))
