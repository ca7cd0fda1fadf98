"""What every sensor of a record stores: clean accelerations and forces in, float32 channels and their labels out."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Config
from siggen.dynamics.time.response import Response
from siggen.dynamics.time.response_stream import Pieces
from siggen.planning.plan import PlannedRecord
from siggen.planning.specimen import Specimen
from siggen.record.background import record_background
from siggen.record.block_channels import block_channels
from siggen.record.channel_facts import channel_draws, channel_labels, white_noise
from siggen.record.disturbance import ChannelDisturbance, NoiseLength
from siggen.record.forces import RecordForces, record_forces
from siggen.record.measured_disturbance import Turning
from siggen.sensing.measurement import measure
from siggen.sensing.spectral_filter import record_of, record_spectrum
from siggen.specimen.instrument import ChannelInstrument, Instrument, specimen_instrument


def measured_channels(
    config: Config,
    specimen: Specimen,
    record: PlannedRecord,
    response: Response | Pieces,
    instrument: Instrument | None = None,
) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return channel name -> float32 signal (n,) in m/s^2, and the labels of all channels.

    Every channel has its own generators, so that adding a sensor leaves the others as they were. `instrument` is that
    of the specimen, if it is there already. With `filters: blocks` a stream is stepped here, piece after piece.

    Raises
    ------
    SolverFailure, ValueError
        As a stream, where one is given.
    """
    instrument = instrument or specimen_instrument(config, specimen)
    if instrument.blocks is not None:
        return block_channels(config, specimen, record, response, instrument)
    if not isinstance(response, Response):
        raise TypeError("response: received a stream; allowed with `filters: record` is a whole response")
    return _whole(config, specimen, record, response, instrument)


def _whole(
    config: Config, specimen: Specimen, record: PlannedRecord, response: Response, instrument: Instrument
) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return signals and labels of a record that is filtered at once."""
    forces = record_forces(config, specimen, record, response, instrument)
    motions = _motion_spectra(instrument, response)
    background = record_background(config, specimen, record, instrument)
    angle, gears = response.angle_rad, specimen.gears
    turning = Turning(gears.pinion.teeth / gears.gear.teeth, float(np.diff(angle).max(initial=0.0)))
    noise_length = NoiseLength(instrument.length, config.fs_hz, in_blocks=False)
    signals: dict[str, np.ndarray] = {}
    labels: dict[str, object] = {}
    for channel in instrument.channels:
        draws = channel_draws(config, record, channel.name)
        disturbance = ChannelDisturbance(channel, draws, turning, noise_length)
        disturbed = disturbance.take(0, angle)
        added = None if background is None else background.spectra.get(channel.name)
        clean = _sensed(channel, response, motions, forces, instrument.length, added)
        rng, floor, snr_db = white_noise(config, record, channel, draws)
        measured = measure(
            clean, gain=channel.gain, range_m_s2=channel.sensor.range_m_s2, bits=channel.sensor.bits, rng=rng,
            noise_floor_m_s2=floor, snr_db=snr_db, disturbance_m_s2=disturbed,
        )  # fmt: skip
        signals[channel.name] = measured.accel_m_s2
        labels |= {**channel_labels(channel, measured), **disturbance.labels}
    return signals, {**labels, **forces.labels, **(background.labels if background else {})}


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
