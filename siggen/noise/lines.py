"""Sources that are lines of fixed frequencies: as they are stored, or through the sensor like the gears' vibrations."""

from __future__ import annotations

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.noise.source import NoisyChannel
from siggen.sensing.tones import Lines, lines_signal


class LinesPart:
    """Lines of one channel of one record; their label is the RMS of all together, before the sensor."""

    def __init__(self, lines: Lines, channel: NoisyChannel, *, sensed: bool) -> None:
        self._lines, self._fs_hz = lines, channel.fs_hz
        self._response = np.ones(lines.frequency_hz.size, dtype=complex)
        if sensed:
            self._response *= channel.gain
        if sensed and channel.response is not None:
            self._response *= _between(channel.response, lines.frequency_hz * channel.length / channel.fs_hz)

    @property
    def label(self) -> float:
        """Root mean square of all lines."""
        return self._lines.rms

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray:
        """Return the lines (k,), as of `Part`."""
        return lines_signal(self._lines, self._response, self._fs_hz, angle_rad.size, first)


def _between(values: ComplexArray, bins: FloatArray) -> ComplexArray:
    """Return a response (k,) at fractions of its bins, linearly between them."""
    whole = np.arange(values.size)
    return np.interp(bins, whole, values.real) + 1j * np.interp(bins, whole, values.imag)
