"""What is added to one channel of one record by its surroundings and its electronics, and the labels of it.

Frequencies belong to the gearbox and are the same for all its sensors; levels and phases belong to the record. Nothing
is drawn from the state.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.config import Inverter, Mains, PinkNoise, SensorDensity, Tones
from siggen.keys.number import at
from siggen.record.measured_disturbance import Draws, NoiseStrength, TableLines, Turning
from siggen.sensing.force_density import tabulated
from siggen.sensing.pink_noise import PinkStream
from siggen.sensing.sensor_response import high_pass_response
from siggen.sensing.shaped_noise import ShapedNoise, shape_taps
from siggen.sensing.spread import Spread
from siggen.sensing.tones import Lines, carrier_lines, harmonic_lines, lines_signal, single_lines
from siggen.specimen.instrument import ChannelInstrument

PINK_HZ = 100.0
"""Where the density of 1/f noise is given, about where it meets the white noise of accelerometers (assumed)."""
CARRIER_SIDEBANDS = 2
"""On either side of the carrier of an inverter (assumed)."""
SPECTRUM_TAPS = 16_384
"""Of the filter of a sensor's noise: at 25.6 kHz densities are smoothed over 1.6 Hz."""

Part = Callable[[int, FloatArray], FloatArray]
"""From the first sample and the pinion's angles (k,) to what is added there (k,); parts of a record in order."""


class ChannelDisturbance:
    """What is added to a channel of one record behind its amplifier, part after part, and the labels of it.

    Vibrations of other machines pass the sensor as those of the gears do; hum, 1/f noise, noise of a given density and
    given lines are as they are stored. Unless it `follows_angle`, angles count by their number alone.
    """

    def __init__(self, channel: ChannelInstrument, draws: Draws, turning: Turning, record: NoiseLength) -> None:
        self._labels: dict[str, object] = {}
        self._spreads: dict[str, Spread] = {}
        self._parts: list[tuple[str | None, Part]] = []
        added, name, suffix = channel.sensor.added, channel.name, channel.sensor.quantity.suffix
        spectrum = added.get("noise_spectrum")
        modulated = spectrum is not None and spectrum.modulation is not None
        self.follows_angle = modulated or "lines" in added
        if "pink_noise" in added:
            self._parts.append((None, self._pink(added["pink_noise"], channel, draws, record)))
        if spectrum is not None:
            part = _of_spectrum(spectrum, channel, draws, turning, record)
            self._parts.append((f"noise_spectrum_{name}_{suffix}", part))
        if "lines" in added:
            table = TableLines(added["lines"], draws, record.fs_hz, turning.largest_step_rad)
            self._parts.append((f"lines_{name}_{suffix}", lambda first, angle: table.at(angle, first)))
        for part_name, lines in _lines(added, draws):
            self._parts.append((None, _line_part(part_name, lines, channel, record)))
            self._labels[f"{part_name}_{name}_{suffix}"] = lines.rms_m_s2

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray | None:
        """Return what is added (k,) from sample `first` on, at angles of the pinion (k,); None for nothing."""
        if not self._parts:
            return None
        signal = np.zeros(angle_rad.size)
        for label, part in self._parts:
            added = part(first, angle_rad)
            signal += added
            if label is not None:
                self._spreads.setdefault(label, Spread()).take(added)
        return signal

    @property
    def labels(self) -> dict[str, object]:
        """The labels, complete when all was taken."""
        return {**self._labels, **{label: spread.std for label, spread in self._spreads.items()}}

    def _pink(self, section: PinkNoise, channel: ChannelInstrument, draws: Draws, record: NoiseLength) -> Part:
        rng = draws.record("pink_noise")
        density = at(section.density_m_s2_per_sqrt_hz, draws.level("pink_noise.density_m_s2_per_sqrt_hz", rng))
        rng.random()  # the noise of sets begins behind this number
        self._labels[f"pink_noise_{channel.name}_{channel.sensor.quantity.suffix}_per_sqrt_hz"] = density
        pink = PinkStream(density, PINK_HZ, channel.high_pass_hz, record.fs_hz, rng)
        return lambda _, angle: pink.take(angle.size)


class NoiseLength(NamedTuple):
    """Samples that the responses of channels stand for, at their rate."""

    length: int
    fs_hz: float


def _of_spectrum(
    section: SensorDensity, channel: ChannelInstrument, draws: Draws, turning: Turning, record: NoiseLength
) -> Part:
    rng = draws.record("noise_spectrum")
    factor = at(section.factor, draws.level("noise_spectrum.factor", rng))
    noise = _shaped(section, factor, channel, record, rng)
    if section.modulation is None:
        return lambda _, angle: noise(angle.size)
    strength = NoiseStrength(section.modulation, draws, turning.gear_order, record.fs_hz)
    return lambda _, angle: noise(angle.size) * np.sqrt(strength.take(angle))


def _shaped(
    section: SensorDensity, factor: float, channel: ChannelInstrument, record: NoiseLength, rng: np.random.Generator
) -> Callable[[int], FloatArray]:
    def density(frequency_hz: FloatArray) -> FloatArray:
        found = tabulated(frequency_hz, section.frequency_hz, section.density)
        if channel.high_pass_hz is None:
            return found
        # no logarithm of nothing: at frequency 0 as at the first one above
        over_zero = np.maximum(frequency_hz, frequency_hz[1])
        return np.asarray(found * np.abs(high_pass_response(over_zero, channel.high_pass_hz)))

    noise = ShapedNoise(factor * shape_taps(density, SPECTRUM_TAPS, record.fs_hz), record.fs_hz, rng)
    return noise.take


def _line_part(part: str, lines: Lines, channel: ChannelInstrument, record: NoiseLength) -> Part:
    response = np.ones(lines.frequency_hz.size, dtype=complex)
    if part != "mains":
        response *= channel.gain
    if part != "mains" and channel.sensor_response is not None:
        response *= _between(channel.sensor_response, lines.frequency_hz * record.length / record.fs_hz)
    return lambda first, angle: lines_signal(lines, response, record.fs_hz, angle.size, first)


def _lines(added: Mapping[str, Any], draws: Draws) -> Iterator[tuple[str, Lines]]:
    """Yield part -> its lines, for every part that the sensor has."""
    if "mains" in added:
        yield "mains", _mains(added["mains"], draws)
    if "tones" in added:
        yield "tones", _tones(added["tones"], draws)
    if "inverter" in added:
        yield "inverter", _inverter(added["inverter"], draws)


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
    return carrier_lines(carrier_hz, modulation_hz, amplitude, CARRIER_SIDEBANDS, rng)


def _between(values: ComplexArray, bins: FloatArray) -> ComplexArray:
    """Return a response (k,) at fractions of its bins, linearly between them."""
    whole = np.arange(values.size)
    return np.interp(bins, whole, values.real) + 1j * np.interp(bins, whole, values.imag)
