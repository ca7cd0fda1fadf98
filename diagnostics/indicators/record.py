"""One pass over a record: resampled to angle once per channel, averaged once per shaft, and everything read from that.

Indicators, sideband amplitudes, what the audit compares, averaged waveforms and noise sketches all come from here.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from diagnostics.indicators.channel_signals import ChannelSignals
from diagnostics.indicators.indicator import Indicator
from diagnostics.indicators.line_levels import LEVELS, record_levels
from diagnostics.indicators.mesh_signals import MeshSignals, mesh_signals
from diagnostics.indicators.registry import taken_of
from diagnostics.indicators.settings import IndicatorSettings
from diagnostics.records.channel_quantities import RECORDED
from diagnostics.records.gear_train import Gearing, meshes_of, train_of
from diagnostics.records.recording import Recording
from diagnostics.records.sample_bytes import sample_bytes
from diagnostics.records.usable_records import RecordProblem, clipped_channels, record_problems, refused_parts
from diagnostics.signal.noise_sketch import noise_sketch
from diagnostics.signal.order_domain import AngleGrid, speed_variation_percent
from diagnostics.signal.shaft_angle import shaft_angle
from diagnostics.signal.shaft_signals import ShaftSignals
from diagnostics.signal.spectrum import OrderLines
from siggen.errors import UsageError

WAVEFORM_HARMONICS = 20
"""Averaged waveforms are kept up to this mesh harmonic and its first sidebands."""

FEWEST_AUDIT_TURNS = 2


@dataclass(frozen=True, slots=True)
class ChannelResult:
    """What one channel gave: values by column, moments, lines of the averaged waveform, noise sketch, conditions."""

    values: dict[str, float]
    moments: dict[str, float] = field(default_factory=dict)
    waveform: np.ndarray = field(default_factory=lambda: np.empty(0, np.complex64))
    sketch: np.ndarray = field(default_factory=lambda: np.empty(0, np.complex64))
    conditions: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class RecordResult:
    """What one record gave.

    Attributes
    ----------
    labels : mapping
        Label columns.
    channels : dict of str to ChannelResult
        By channel name; without values where the channel cannot be used at all.
    pulses_s : (k,) float64
        Pulse times that the angles come from.
    revolutions : (int, int)
        Whole revolutions of the first mesh's gears that were averaged.
    conditions : dict of str to float
        Speed, speed variation and start angle by the pulses.
    shaft_notes : str
        What the shafts leave undefined, and why.
    problems : list of RecordProblem
        What keeps a ranking from using the record or a channel.
    refused : list of (str, str)
        What keeps everything else from it: channel (empty: the whole record) and text.
    clipped : list of str
        Channels that stand clipped.
    """

    labels: Mapping[str, Any]
    channels: dict[str, ChannelResult]
    pulses_s: np.ndarray
    revolutions: tuple[int, int]
    conditions: dict[str, float]
    shaft_notes: str
    problems: list[RecordProblem]
    refused: list[tuple[str, str]]
    clipped: list[str]


@dataclass(frozen=True, slots=True)
class RecordValues:
    """What a record that belongs to no set gave.

    Attributes
    ----------
    values : dict of str to float
        Indicators by column with channel.
    revolutions : (int, int)
        Whole revolutions of the first mesh's gears.
    notes : str
        What is undefined, and why.
    waveforms : dict of str to (orders,) complex64
        Lines of the first driver's average by channel, see `ChannelResult.waveform`; none below two revolutions.
    """

    values: dict[str, float]
    revolutions: tuple[int, int]
    notes: str
    waveforms: dict[str, np.ndarray] = field(default_factory=dict)


def record_values(
    channels: Mapping[str, np.ndarray],
    tacho_s: np.ndarray,
    fs_hz: float,
    gears: Gearing,
    settings: IndicatorSettings | None = None,
    quantities: Mapping[str, str] = MappingProxyType({}),
) -> RecordValues:
    """Return the indicators of a record that is not one of a set: a window, or a piece of a recording.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Signals by channel name.
    tacho_s : (k,) float64
        Pulse times, one per turn of the first shaft; with fewer than two all but the raw indicators is undefined.
    fs_hz : float
        Sampling frequency [Hz].
    gears : GearTrain or (int, int)
        The gearbox with its teeth, or the teeth of one pair.
    settings : IndicatorSettings, optional
        Default: `IndicatorSettings()`.
    quantities : mapping of str to str
        What channels hold that hold no acceleration.
    """
    signals = {name: _float64(signal) for name, signal in channels.items()}
    meshes = mesh_signals(signals, tacho_s, fs_hz, meshes_of(train_of(gears)), settings or IndicatorSettings())
    values = {
        f"{name}__{channel}": value
        for channel in signals
        for mesh in meshes
        for name, value in mesh.values(channel, taken_of(quantities.get(channel, RECORDED.word))).items()
    }
    turns, waveforms = revolutions(meshes[0]), {}
    if turns[0] >= FEWEST_AUDIT_TURNS:
        first = meshes[0].channels
        waveforms = {name: _waveform(own.shaft(own.shafts[0].name)) for name, own in first.items()}
    return RecordValues(values, turns, shaft_notes(meshes), waveforms)


def revolutions(mesh: MeshSignals) -> tuple[int, int]:
    """Return the whole revolutions of the gears of a mesh, of sun and ring against their carrier."""
    return mesh.shafts[0].revolutions, mesh.shafts[-1].revolutions


def shaft_notes(meshes: tuple[MeshSignals, ...]) -> str:
    """Return what the shafts leave undefined, and why."""
    return "; ".join(note for mesh in meshes for note in mesh.notes())


def record_result(record: Recording, settings: IndicatorSettings | None = None) -> RecordResult:
    """Return everything that is taken of one record of a set.

    Parameters
    ----------
    record : Recording
        Labels, channels and pulses.
    settings : IndicatorSettings, optional
        Default: `IndicatorSettings()`.
    """
    chosen = settings or IndicatorSettings()
    needs_tacho = chosen.speed_range_hz is None
    problems = record_problems(record, chosen.frame_samples, needs_tacho=needs_tacho)
    refused, clipped = refused_parts(record, needs_tacho=needs_tacho), clipped_channels(record)
    lost = {channel for channel, _ in refused}
    usable = {} if "" in lost else {name: _float64(s) for name, s in record.channels.items() if name not in lost}
    pulses = _float64(record.tacho_s)
    if chosen.speed_range_hz is not None and usable:
        bad = {problem.channel for problem in problems}
        good = {name: signal for name, signal in usable.items() if name not in bad}
        try:
            pulses = _mesh_pulses(good or usable, record, chosen.speed_range_hz)
        except UsageError as error:
            problems, usable = [*problems, RecordProblem(int(record.labels["record_id"]), "", str(error))], {}
    channels = {name: ChannelResult({}, conditions=channel_conditions(s)) for name, s in record.channels.items()}
    turns, notes = (0, 0), ""
    if usable:
        meshes = mesh_signals(usable, pulses, record.fs_hz, meshes_of(record.train), chosen)
        turns, notes = revolutions(meshes[0]), shaft_notes(meshes)
        for name in usable:
            taken = taken_of(record.quantities.get(name, RECORDED.word))
            channels[name] = _channel_result(meshes, name, taken, channels[name].conditions, pulses)
    conditions = _pulse_conditions(pulses)
    return RecordResult(record.labels, channels, pulses, turns, conditions, notes, problems, refused, clipped)


def _mesh_pulses(
    channels: Mapping[str, np.ndarray], record: Recording, speed_range_hz: tuple[float, float]
) -> np.ndarray:
    angle = shaft_angle(channels, record.fs_hz, record.teeth, speed_range_hz)
    if not angle.given:
        raise UsageError(f"{angle.speed_hz:.4g} Hz, {angle.words}")
    return angle.pulses_s


def _channel_result(
    meshes: tuple[MeshSignals, ...],
    channel: str,
    taken: tuple[Indicator, ...],
    conditions: dict[str, float],
    pulses: np.ndarray,
) -> ChannelResult:
    signals = meshes[0].channels[channel]
    values = {name: value for mesh in meshes for name, value in mesh.values(channel, taken).items()}
    moments = {name: value for mesh in meshes for name, value in mesh.moments(channel).items()}
    grid = signals.grid
    if grid is None or grid.revolutions < FEWEST_AUDIT_TURNS:
        return ChannelResult(values | dict.fromkeys(LEVELS, math.nan), moments, conditions=conditions)
    values |= _levels(signals, grid, pulses)
    teeth = (signals.shafts[0].teeth, signals.shafts[-1].teeth)
    if signals.shafts[0].revolutions < 1:  # a sun that turns too seldom against its carrier
        return ChannelResult(values, moments, conditions=conditions)
    return ChannelResult(
        values,
        moments,
        _waveform(signals.shaft(signals.shafts[0].name)),
        noise_sketch(signals.signal, signals.fs_hz, signals.steps, teeth, grid),
        conditions,
    )


def _levels(signals: ChannelSignals, grid: AngleGrid, pulses: np.ndarray) -> dict[str, float]:
    turns = signals.steps.reshape(grid.revolutions, grid.samples_per_revolution)
    teeth = (signals.shafts[0].teeth, signals.shafts[-1].teeth)
    lines = OrderLines(signals.amplitude, grid.revolutions, 1.0 / float(pulses[-1] - pulses[0]))
    return record_levels(turns, lines, teeth, signals.fs_hz)


def _waveform(first: ShaftSignals) -> np.ndarray:
    """Return complex lines of an averaged revolution up to the 20th mesh harmonic and its first sidebands."""
    from scipy import fft

    spectrum = 2.0 * fft.rfft(first.average) / first.average.size
    return np.asarray(spectrum[: WAVEFORM_HARMONICS * first.shaft.teeth + 2].astype(np.complex64))


def _float64(values: np.ndarray) -> np.ndarray:
    return np.asarray(values, dtype=np.float64)


def channel_conditions(signal: np.ndarray) -> dict[str, float]:
    """Return checksum of the samples, their bytes, and number of samples before the last ones that repeat."""
    differ = signal[::-1] != signal[-1] if signal.size else np.zeros(1, dtype=np.bool_)
    repeated = int(differ.argmax())  # samples at the end; 0 also where all are equal
    return {
        "checksum": zlib.crc32(np.ascontiguousarray(signal).data),
        "samples": float(signal.size - repeated + 1 if differ[repeated] else 0),
        **sample_bytes(signal),
    }


def _pulse_conditions(pulses: np.ndarray) -> dict[str, float]:
    """Return mean speed [Hz], its slow variation [%], and the first shaft's angle at the first sample [turns]."""
    span = float(pulses[-1] - pulses[0]) if pulses.size > 1 else 0.0
    if not span > 0.0:
        return dict.fromkeys(("pulses_per_s", "speed_variation_percent", "start_turn"), math.nan)
    return {
        "pulses_per_s": (pulses.size - 1) / span,
        "speed_variation_percent": speed_variation_percent(pulses),
        "start_turn": float((-pulses[0] / (pulses[1] - pulses[0])) % 1.0),
    }
