"""What every sensor of a record stores: clean accelerations and forces in, float32 channels and their labels out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Config, MeasuredPath, NoiseFloor, NoiseRatio, at
from siggen.dynamics.time.response import Response
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen
from siggen.record.background import record_background
from siggen.record.background_course import noise_levels
from siggen.record.disturbance import channel_disturbance
from siggen.record.forces import RecordForces, record_forces
from siggen.record.measured_disturbance import Draws, Turning
from siggen.seeding import Stage, named_generator, named_uniforms
from siggen.sensing.measurement import Measurement, measure
from siggen.sensing.spectral_filter import record_of, record_spectrum
from siggen.specimen.instrument import ChannelInstrument, Instrument, specimen_instrument


def measured_channels(
    config: Config,
    specimen: Specimen,
    record: PlannedRecord,
    response: Response,
    instrument: Instrument | None = None,
) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return channel name -> float32 signal (n,) in m/s^2, and the labels of all channels.

    Every channel has its own generators, so that adding a sensor leaves the others as they were. `instrument` is that
    of the specimen, if it is there already.
    """
    instrument = instrument or specimen_instrument(config, specimen)
    owner = (record.specimen_id, record.state_id, record.operating_point_id, record.repeat)
    forces = record_forces(config, specimen, record, response, instrument)
    motions = _motion_spectra(instrument, response)
    background, levels = record_background(config, specimen, record, instrument), noise_levels(config, record)
    gears = specimen.gears
    turning = Turning(response.angle_rad, gears.pinion.teeth / gears.gear.teeth)
    signals: dict[str, np.ndarray] = {}
    labels: dict[str, object] = {}
    for channel in instrument.channels:
        named = partial(_named, config.seed, owner, channel.name)
        draws = Draws(
            named_uniforms(config.seed, Stage.PATH, record.specimen_id),
            named_uniforms(config.seed, Stage.NOISE, *owner),
            named,
            None if levels is None else partial(_level, levels, channel.name),
        )
        disturbance = channel_disturbance(channel, draws, turning, fs_hz=config.fs_hz, length=instrument.length)
        rng = named_generator(config.seed, Stage.NOISE, *owner, name=channel.name)
        added = None if background is None else background.spectra.get(channel.name)
        clean = _sensed(channel, response, motions, forces, instrument.length, added)
        measured = _measured(channel, clean, disturbance.signal_m_s2, rng, draws)
        signals[channel.name] = measured.accel_m_s2
        labels |= {**_labels(channel, measured), **disturbance.labels}
    return signals, {**labels, **forces.labels, **(background.labels if background else {})}


def _named(seed: int, owner: tuple[int, ...], channel: str, part: str) -> np.random.Generator:
    return named_generator(seed, Stage.NOISE, *owner, name=f"{channel} {part}")


def _level(levels: Callable[[str], float], channel: str, name: str) -> float:
    return levels(f"sensors.{channel}.{name}")


def _motion_spectra(instrument: Instrument, response: Response) -> dict[str, ComplexArray]:
    """Return place/axis -> spectrum (k,) of every motion that a filtered channel sees; axes of a sensor share them."""
    seen = {motion for channel in instrument.channels if not channel.is_plain for motion in channel.motions}
    before, during = response.history.acceleration_m_s2, response.acceleration_m_s2
    return {motion: record_spectrum(before[motion], during[motion], instrument.length) for motion in seen}


def _sensed(
    channel: ChannelInstrument,
    response: Response,
    motions: Mapping[str, ComplexArray],
    forces: RecordForces,
    length: int,
    added: ComplexArray | None = None,
) -> FloatArray:
    """Return the acceleration (n,) that the sensor shows, before its gain; `added` is the background's spectrum."""
    if channel.is_plain:
        plain = response.acceleration_m_s2[next(iter(channel.motions))]
        return plain if added is None else plain + record_of(added, length, plain.size)
    spectrum = np.zeros(length // 2 + 1, dtype=np.complex128) if added is None else added.copy()
    for motion, weight in channel.motions.items():
        spectrum += weight * motions[motion]
    if channel.accelerance is not None:
        for row, force in zip(channel.accelerance, forces.spectra, strict=True):
            spectrum += row * force
    if channel.sensor_response is not None:
        spectrum *= channel.sensor_response
    return record_of(spectrum, length, len(response.angle_rad))


def _measured(
    channel: ChannelInstrument,
    clean: FloatArray,
    disturbance: FloatArray | None,
    rng: np.random.Generator,
    draws: Draws,
) -> Measurement:
    noise, u = channel.sensor.noise, draws.level("noise", rng)
    return measure(
        clean,
        gain=channel.gain,
        range_m_s2=channel.sensor.range_m_s2,
        bits=channel.sensor.bits,
        rng=rng,
        noise_floor_m_s2=at(noise.floor_m_s2, u) if isinstance(noise, NoiseFloor) else None,
        snr_db=at(noise.snr_db, u) if isinstance(noise, NoiseRatio) else None,
        disturbance_m_s2=disturbance,
    )


def _labels(channel: ChannelInstrument, measured: Measurement) -> dict[str, object]:
    labels: dict[str, object] = {
        f"noise_floor_{channel.name}_m_s2": measured.noise_floor_m_s2,
        f"snr_{channel.name}_db": measured.snr_db,
        f"clipped_share_{channel.name}": measured.clipped_share,
    }
    if channel.accelerance is not None:
        labels[f"path_modes_{channel.name}"] = channel.path_modes
        labels[f"path_accelerance_{channel.name}_m_s2_per_n"] = channel.path_rms_m_s2_per_n
        if isinstance(channel.sensor.path, MeasuredPath) and channel.sensor.path.files:
            labels[f"path_number_{channel.name}"] = channel.path_number
    return labels
