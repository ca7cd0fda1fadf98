"""What is added to one channel of one record by its surroundings and its electronics, and the labels of it.

Frequencies belong to the gearbox and are the same for all its sensors; levels and phases belong to the record. Nothing
is drawn from the state.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Inverter, Mains, PinkNoise, Sensor, SensorDensity, Tones, at
from siggen.record.measured_disturbance import Draws, Turning, noise_strength, table_lines
from siggen.sensing.force_density import noise_of, tabulated
from siggen.sensing.noise_spectrum import noise_spectrum
from siggen.sensing.spectral_filter import frequencies, record_of
from siggen.sensing.tones import Lines, carrier_lines, harmonic_lines, lines_signal, single_lines
from siggen.specimen.instrument import ChannelInstrument


@dataclass(frozen=True, slots=True)
class Disturbance:
    """What is added to a channel behind its amplifier (n,), None for nothing, and the labels of its parts."""

    signal_m_s2: FloatArray | None
    labels: dict[str, object]


def channel_disturbance(
    channel: ChannelInstrument, draws: Draws, turning: Turning, *, fs_hz: float, length: int
) -> Disturbance:
    """Return everything that does not come from the gears but white noise.

    Vibrations of other machines pass the sensor as those of the gears do; hum, 1/f noise, noise of a given density and
    given lines are as they are stored.
    """
    samples = turning.angle_rad.size
    sensor, name = channel.sensor, channel.name
    signal = np.zeros(samples)
    labels: dict[str, object] = {}
    if sensor.pink_noise is not None:
        pink, density = _pink(sensor.pink_noise, channel, draws, fs_hz, length)
        signal += record_of(pink, length, samples)
        labels[f"pink_noise_{name}_m_s2_per_sqrt_hz"] = density
    if sensor.noise_spectrum is not None:
        added = _of_spectrum(sensor.noise_spectrum, channel, draws, fs_hz, length)[length - samples :]
        if sensor.noise_spectrum.modulation is not None:
            added = added * np.sqrt(noise_strength(sensor.noise_spectrum.modulation, draws, turning, fs_hz))
        signal += added
        labels[f"noise_spectrum_{name}_m_s2"] = float(added.std())
    if sensor.lines is not None:
        added = table_lines(sensor.lines, draws, turning, fs_hz)
        signal += added
        labels[f"lines_{name}_m_s2"] = float(added.std())
    for part, lines in _lines(sensor, draws):
        response = np.ones(lines.frequency_hz.size, dtype=complex)
        if part != "mains":
            response *= channel.gain
        if part != "mains" and channel.sensor_response is not None:
            response *= _between(channel.sensor_response, lines.frequency_hz * length / fs_hz)
        signal += lines_signal(lines, response, fs_hz, samples)
        labels[f"{part}_{name}_m_s2"] = lines.rms_m_s2
    return Disturbance(signal if labels else None, labels)


def _pink(
    section: PinkNoise, channel: ChannelInstrument, draws: Draws, fs_hz: float, length: int
) -> tuple[ComplexArray, float]:
    rng = draws.record("pink_noise")
    density = at(section.density_m_s2_per_sqrt_hz, draws.level("pink_noise.density_m_s2_per_sqrt_hz", rng))
    corner_hz = at(section.corner_hz, draws.level("pink_noise.corner_hz", rng))
    spectrum = noise_spectrum(density, length, fs_hz, rng, pink_corner_hz=corner_hz)
    return (spectrum if channel.high_pass is None else spectrum * channel.high_pass), density


def _of_spectrum(
    section: SensorDensity, channel: ChannelInstrument, draws: Draws, fs_hz: float, length: int
) -> FloatArray:
    rng = draws.record("noise_spectrum")
    factor = at(section.factor, draws.level("noise_spectrum.factor", rng))
    density = factor * tabulated(frequencies(length, fs_hz), section.frequency_hz, section.density)
    return noise_of(density if channel.high_pass is None else density * np.abs(channel.high_pass), length, fs_hz, rng)


def _lines(sensor: Sensor, draws: Draws) -> Iterator[tuple[str, Lines]]:
    """Yield part -> its lines, for every part that the sensor has."""
    if sensor.mains is not None:
        yield "mains", _mains(sensor.mains, draws)
    if sensor.tones is not None:
        yield "tones", _tones(sensor.tones, draws)
    if sensor.inverter is not None:
        yield "inverter", _inverter(sensor.inverter, draws)


def _mains(section: Mains, draws: Draws) -> Lines:
    rng = draws.record("mains")
    amplitude = at(section.amplitude_m_s2, draws.level("mains.amplitude_m_s2", rng))
    return harmonic_lines(
        at(section.frequency_hz, draws.specimen("mains.frequency_hz")), amplitude, section.harmonics, rng
    )


def _tones(section: Tones, draws: Draws) -> Lines:
    rng = draws.record("tones")
    uniforms = [draws.specimen(f"tones.{tone}.frequency_hz") for tone in range(section.count)]
    own = [draws.level(f"tones.{tone}.amplitude_m_s2", rng) for tone in range(section.count)]
    amplitudes = [at(section.amplitude_m_s2, u) for u in own]
    return single_lines(np.array([at(section.frequency_hz, u) for u in uniforms]), np.array(amplitudes), rng)


def _inverter(section: Inverter, draws: Draws) -> Lines:
    rng = draws.record("inverter")
    amplitude = at(section.amplitude_m_s2, draws.level("inverter.amplitude_m_s2", rng))
    carrier_hz = at(section.carrier_hz, draws.specimen("inverter.carrier_hz"))
    # the electrical frequency belongs to the record: all sensors see the same motor
    modulation_hz = at(section.modulation_hz, draws.shared("inverter.modulation_hz"))
    return carrier_lines(carrier_hz, modulation_hz, amplitude, section.sidebands, rng)


def _between(values: ComplexArray, bins: FloatArray) -> ComplexArray:
    """Return a response (k,) at fractions of its bins, linearly between them."""
    whole = np.arange(values.size)
    return np.interp(bins, whole, values.real) + 1j * np.interp(bins, whole, values.imag)
