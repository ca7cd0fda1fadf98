"""What every sensor of a record stores, block after block: inputs through filters of limited length.

Memory is bounded but for the stored channels (docs/understand/methods.md).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.drivetrain.drive import Rotation
from siggen.gearbox.channels import DrawnChannel
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen
from siggen.keys.number import at
from siggen.motion.response import ResponsePieces
from siggen.noise.source import Draws, NoisyChannel
from siggen.record.background import BackgroundBlocks
from siggen.record.instrument import ChannelInstrument, Instrument
from siggen.seeding import Stream, named_generator, named_uniforms
from siggen.sensing.filters import AHEAD, BLOCK_SAMPLES, TOGETHER
from siggen.sensing.inputs import FORCE, MOTION, SHAFT, Input
from siggen.sensing.measurement import Measurement, Recorder
from siggen.sensors.transducer import Running

# What is drawn for one channel of a record, and what its labels say.


def channel_draws(seed: int, record: PlannedRecord, channel: str, *, levelled: bool) -> Draws:
    """Return where the numbers of a channel come from; noise that is `levelled` has that of the gearbox."""
    owner, levels = record.noise_owner, named_uniforms(seed, Stream.BACKGROUND, record.sensors_of)
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
    rng = named_generator(seed, Stream.NOISE, *record.noise_owner, name=channel.name)
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


# MotionBlocks: motions, forces and readings of a response as inputs of filters, in parts of any length.


def delivered(response: ResponsePieces) -> tuple[Input, ...]:
    """Return what a response holds, as inputs."""
    kinds = ((MOTION, response.motions), (FORCE, response.places), (SHAFT, response.readings))
    return tuple(Input(kind, name) for kind, names in kinds for name in names)


class MotionBlocks:
    """Values from sample -`back` on, about the mean of the history; 0 before the history.

    `offsets` are the means that were taken off.
    """

    def __init__(self, response: ResponsePieces, back: int) -> None:
        self.inputs = delivered(response)
        self._pieces = response.pieces()
        self._mean = np.zeros((len(self.inputs), 1))
        history = self._read(np.empty((len(self.inputs), 0)), response.before)
        if response.before:
            self._mean = history[:, : response.before].mean(axis=1, keepdims=True)
        self.offsets = dict(zip(self.inputs, self._mean[:, 0], strict=True))
        self._left = np.concatenate(
            [np.zeros((len(self.inputs), back - response.before)), history - self._mean], axis=1
        )

    def take(self, count: int) -> dict[Input, FloatArray]:
        """Return the next values (count,) of every input; 0 behind the end of the response.

        Raises
        ------
        SolverFailure, ValueError
            As the response, where it is stepped as it is taken.
        """
        rows = self._read(self._left, count)
        self._left = rows[:, count:].copy()
        return dict(zip(self.inputs, rows[:, :count], strict=True))

    def _read(self, left: FloatArray, count: int) -> FloatArray:
        """Return what is left and as many pieces behind it as make at least `count` samples."""
        found, have = [left], left.shape[1]
        while have < count:
            piece = next(self._pieces, None)
            if piece is None:
                rows = np.zeros((len(self.inputs), count - have))
            else:
                rows = np.concatenate([p for p in piece if p.shape[0]]) - self._mean
            found.append(rows)
            have += rows.shape[1]
        return np.concatenate(found, axis=1)


# BlockInputs: what reaches the channels of a record, filtered block after block (overlap-save, `block_filter`).


class BlockInputs:
    """Inputs of one record, and what its channels see of them."""

    def __init__(
        self,
        specimen: Specimen,
        record: PlannedRecord,
        rotation: Rotation,
        response: ResponsePieces,
        instrument: Instrument,
    ) -> None:
        self._samples, self._grid = specimen.sampling.samples, instrument.blocks.grid
        back = self._grid.back
        _refuse_undelivered(instrument, delivered(response))
        self._motions = MotionBlocks(response, back)
        self._background: BackgroundBlocks | None = None
        self._filters = instrument.blocks.filters
        if specimen.background is not None:
            length = back + self._samples + AHEAD
            self._background = BackgroundBlocks(specimen, record, rotation, instrument.acting, -back, length)
        self._plain = {c.name: next(iter(c.seen)) for c in instrument.channels if c.is_plain}
        felt = dict.fromkeys(one for filters in self._filters.values() for one in filters)
        seen = tuple(dict.fromkeys([*felt, *self._plain.values()]))
        self._felt, self._values = tuple(felt), np.zeros((len(seen), self._grid.length))
        self._buffers = dict(zip(seen, self._values, strict=True))

    @property
    def labels(self) -> dict[str, object]:
        """Labels of the background, complete when the first block was taken."""
        return {} if self._background is None else self._background.labels

    def seen(self) -> Iterator[dict[str, FloatArray]]:
        """Yield channel -> its quantity (k,) before its gain, block after block."""
        block, back = self._grid.block, self._grid.back
        for first in range(0, self._samples, block):
            count = min(block, self._samples - first)
            self._shift(count, 0 if first == 0 else back + AHEAD)
            yield self._filtered(slice(back, back + count))

    def _shift(self, count: int, kept: int) -> None:
        """Move every input on, so that the next block of `count` samples and what filters see around it is there."""
        new = count if kept else self._grid.back + count + AHEAD
        taken = {**self._motions.take(new), **({} if self._background is None else self._background.take(new))}
        for one, buffer in self._buffers.items():
            buffer[:kept] = buffer[self._grid.block : self._grid.block + kept].copy()
            buffer[kept:] = 0.0
            if one in taken:
                buffer[kept : kept + new] = taken[one]

    def _filtered(self, valid: slice) -> dict[str, FloatArray]:
        bins = self._grid.length // 2 + 1
        totals: dict[str, ComplexArray] = {
            n: np.zeros(bins, complex) for n, filters in self._filters.items() if filters
        }
        product = np.empty(bins, complex)
        for one, spectrum in zip(self._felt, self._spectra(), strict=True):
            for name, filters in self._filters.items():
                if one in filters:
                    np.multiply(filters[one], spectrum, out=product)
                    totals[name] += product
        found = {name: np.fft.irfft(total, self._grid.length)[valid] for name, total in totals.items()}
        for name, one in self._plain.items():
            shown = self._buffers[one][valid] + self._motions.offsets[one]
            found[name] = found[name] + shown if name in found else shown
        return found

    def _spectra(self) -> Iterator[ComplexArray]:
        """Yield the spectrum of every input that a filter sees; others are shown as they are."""
        for k in range(0, len(self._felt), TOGETHER):
            yield from np.fft.rfft(self._values[k : min(k + TOGETHER, len(self._felt))])


def _refuse_undelivered(instrument: Instrument, delivered: tuple[Input, ...]) -> None:
    """Raise where a sensor shows what the model does not give: its channel would be nothing, in silence."""
    for channel in instrument.channels:
        for one in channel.seen:
            if one not in delivered:
                given = ", ".join(f"{kind} {name}" for kind, name in delivered)
                raise ValueError(
                    f"sensor {channel.drawn.sensor}: shows {one.kind} {one.name}, which the model does not give "
                    f"(it gives {given})"
                )


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
        2.0 * np.pi * named_uniforms(specimen.seed, Stream.NOISE, *record.noise_owner)("line.phase"),
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
