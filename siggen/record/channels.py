"""What every sensor of a record stores, block after block: inputs through filters of limited length.

Memory is bounded but for the stored channels (docs/understand/methods.md).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.drive.drive import Rotation
from siggen.dynamics.time.response_stream import ResponsePieces
from siggen.gearbox.channels import DrawnChannel
from siggen.gearbox.specimen import Specimen
from siggen.noise.source import Draws, NoisyChannel
from siggen.planning.plan import PlannedRecord
from siggen.record.block_inputs import BlockInputs
from siggen.record.channel_facts import channel_draws, channel_labels, white_noise
from siggen.seeding import Stream, named_uniforms
from siggen.sensing.block_filter import BLOCK_SAMPLES
from siggen.sensing.recorder import Recorder
from siggen.sensors.transducer import Running
from siggen.specimen.instrument import Instrument


class ChannelDisturbance:
    """What the sources of a channel add to it behind its amplifier, part after part, and the labels of it."""

    def __init__(self, channel: DrawnChannel, about: NoisyChannel, draws: Draws) -> None:
        self._parts = {
            one.column(channel.name, channel.quantity.suffix): one.part(about, draws) for one in channel.sources
        }
        self.follows_angle = any(one.follows_angle for one in channel.sources)

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


def measured_channels(
    specimen: Specimen, record: PlannedRecord, rotation: Rotation, response: ResponsePieces, instrument: Instrument
) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return channel name -> float32 signal (n,) in its unit, and the labels of all channels.

    Every channel has its own generators, so that adding a sensor leaves the others as they were. A stream is stepped
    here, piece after piece.

    Raises
    ------
    SolverFailure, ValueError
        As the response, where it is stepped as it is taken; a SolverFailure too where a sensor cannot read it.
    """
    inputs = BlockInputs(specimen, record, rotation, response, instrument)
    fs_hz, samples = specimen.sampling.fs_hz, specimen.sampling.samples
    recorders = {channel.name: Recorder(samples, channel.drawn.gain) for channel in instrument.channels}
    whole: dict[str, list[FloatArray]] = {c.name: [] for c in instrument.channels if c.drawn.transducer is not None}
    for seen in inputs.seen():
        for name, values in seen.items():
            (whole[name].append if name in whole else recorders[name].take)(values)
    if whole:
        for name, reading in _readings(instrument, whole, _running(specimen, record, rotation)):
            recorders[name].take(reading)
    disturbances = _disturbances(specimen, record, instrument, recorders, rotation)
    for first in range(0, samples, BLOCK_SAMPLES):
        count = min(BLOCK_SAMPLES, samples - first)
        follows = any(disturbance.follows_angle for disturbance in disturbances.values())
        angle = _angle_rad(rotation, fs_hz, first, count) if follows else np.zeros(count)
        for name, recorder in recorders.items():
            recorder.convert(count, disturbances[name].take(first, angle))
    labels: dict[str, object] = {}
    signals: dict[str, np.ndarray] = {}
    for channel in instrument.channels:
        measured = recorders[channel.name].measurement()
        signals[channel.name] = measured.values
        labels |= {**channel_labels(channel, measured), **disturbances[channel.name].labels}
    return signals, {**labels, **inputs.labels}


def _readings(
    instrument: Instrument, whole: Mapping[str, Sequence[FloatArray]], running: Running
) -> Iterator[tuple[str, FloatArray]]:
    """Yield channels that are read as a whole, with their readings (n,); last those that read other channels alone."""
    found: dict[str, FloatArray] = {}
    for channel in sorted(instrument.channels, key=lambda one: not one.seen):
        if channel.drawn.transducer is not None:
            shown = np.concatenate(whole[channel.name]) if channel.seen else np.empty(0)
            found[channel.name] = channel.drawn.transducer.reading(shown, replace(running, readings=found))
            yield channel.name, found[channel.name]


def _running(specimen: Specimen, record: PlannedRecord, rotation: Rotation) -> Running:
    sampling = specimen.sampling
    return Running(
        sampling.fs_hz,
        _angle_rad(rotation, sampling.fs_hz, 0, sampling.samples),
        specimen.names.of_turning(list(map(float, specimen.shaft_turns))),
        specimen.points[record.operating_point_id].torque_nm,
        _base_radii_m(specimen),
        {channel.name: channel.place for channel in specimen.channels},
        2.0 * np.pi * named_uniforms(specimen.seed, Stream.NOISE, *record.owner)("line.phase"),
    )


def _base_radii_m(specimen: Specimen) -> dict[str, float]:
    """Return what turns -> base radius of the gear that it turns with."""
    found: dict[str, float] = {}
    every = [mesh.pair for mesh in specimen.meshes]
    for mesh, pair in zip(specimen.names.meshes, every, strict=True):
        found |= {mesh.driver.body: pair.pinion.base_radius_m, mesh.driven.body: pair.gear.base_radius_m}
    return {**found, "motor": found[specimen.names.first.driver.body], "load": pair.gear.base_radius_m}


def _disturbances(
    specimen: Specimen,
    record: PlannedRecord,
    instrument: Instrument,
    recorders: Mapping[str, Recorder],
    rotation: Rotation,
) -> dict[str, ChannelDisturbance]:
    """Return channel -> what is added to it; its recorder learns its noise and its converter."""
    largest, fs_hz = _largest_step_rad(specimen, rotation), specimen.sampling.fs_hz
    levelled = specimen.background is not None
    gear_order = specimen.pair.pinion.teeth / specimen.pair.gear.teeth
    found = {}
    for channel in instrument.channels:
        drawn, draws = channel.drawn, channel_draws(specimen.seed, record, channel.name, levelled=levelled)
        about = NoisyChannel(
            gain=drawn.gain,
            response=channel.sensor_response,
            coupling_hz=drawn.coupling_hz,
            fs_hz=fs_hz,
            length=instrument.length,
            gear_order=gear_order,
            largest_step_rad=largest,
        )
        found[channel.name] = ChannelDisturbance(drawn, about, draws)
        rng, floor = white_noise(specimen.seed, record, drawn, draws)
        recorders[channel.name].begin_conversion(
            limit=drawn.limit,
            bits=drawn.bits,
            rng=rng,
            noise_floor=floor,
        )
    return found


def _angle_rad(rotation: Rotation, fs_hz: float, first: int, count: int) -> FloatArray:
    return rotation.angle_rad((np.arange(count) + first) / fs_hz)


def _largest_step_rad(specimen: Specimen, rotation: Rotation) -> float:
    """Return how far the pinion turns in a sample at most; 0 where nobody asks."""
    if not any(source.asks_largest_step for channel in specimen.channels for source in channel.sources):
        return 0.0
    fs_hz, samples = specimen.sampling.fs_hz, specimen.sampling.samples
    steps = (
        np.diff(_angle_rad(rotation, fs_hz, first, min(BLOCK_SAMPLES, samples - first) + 1)).max()
        for first in range(0, samples, BLOCK_SAMPLES)
    )
    return float(max(steps))
