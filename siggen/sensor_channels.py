"""What every sensor of a record stores: clean accelerations in, float32 channels and their labels out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from siggen.config import Config, NoiseFloor, NoiseRatio, Sensor, at, constant
from siggen.dataset.plan import PlannedRecord
from siggen.dataset.specimen import Specimen
from siggen.dynamics.response import Response
from siggen.seeding import Stage, named_generator
from siggen.sensing.measurement import Measurement, measure


@dataclass(frozen=True, slots=True)
class ChannelSetting:
    """One axis of one sensor: name of the channel, place/axis of the motion it measures, its gain."""

    name: str
    motion: str
    sensor: Sensor
    gain: float


def channel_settings(specimen: Specimen) -> Iterator[ChannelSetting]:
    """Yield what the specimen's sensors are, channel by channel; the noise is still a distribution."""
    for sensor in specimen.sensors:
        gains = sensor.gain if isinstance(sensor.gain, tuple) else (sensor.gain,) * len(sensor.axes)
        for axis, gain in zip(sensor.axes, gains, strict=True):
            yield ChannelSetting(f"{sensor.name}_{axis}", f"{sensor.motion_place}/{axis}", sensor, constant(gain))


def measured_channels(
    config: Config, specimen: Specimen, record: PlannedRecord, response: Response
) -> tuple[dict[str, np.ndarray], dict[str, object]]:
    """Return channel name -> float32 signal (n,) in m/s^2, and the labels of all channels.

    Every channel has its own generator, so that adding a sensor leaves the others as they were.
    """
    owner = (record.specimen_id, record.state_id, record.operating_point_id, record.repeat)
    measured = {
        setting.name: _measured(setting, response, named_generator(config.seed, Stage.NOISE, *owner, name=setting.name))
        for setting in channel_settings(specimen)
    }
    labels = {name: value for channel, m in measured.items() for name, value in _labels(channel, m).items()}
    return {channel: m.accel_m_s2 for channel, m in measured.items()}, labels


def _measured(setting: ChannelSetting, response: Response, rng: np.random.Generator) -> Measurement:
    noise, u = setting.sensor.noise, rng.random()
    return measure(
        response.acceleration_m_s2[setting.motion],
        gain=setting.gain,
        range_m_s2=setting.sensor.range_m_s2,
        bits=setting.sensor.bits,
        rng=rng,
        noise_floor_m_s2=at(noise.floor_m_s2, u) if isinstance(noise, NoiseFloor) else None,
        snr_db=at(noise.snr_db, u) if isinstance(noise, NoiseRatio) else None,
    )


def _labels(channel: str, measured: Measurement) -> dict[str, object]:
    return {
        f"noise_floor_{channel}_m_s2": measured.noise_floor_m_s2,
        f"snr_{channel}_db": measured.snr_db,
        f"clipped_share_{channel}": measured.clipped_share,
    }
