"""Sources that are lines of fixed frequencies, as they are stored."""

from __future__ import annotations

from siggen.arrays import FloatArray
from siggen.noise.source import NoisyChannel
from siggen.sensing.tones import Lines, lines_signal


class LinesPart:
    """Lines of one channel of one record; their label is the RMS of all together."""

    def __init__(self, lines: Lines, channel: NoisyChannel) -> None:
        self._lines, self._fs_hz = lines, channel.fs_hz

    @property
    def label(self) -> float:
        """Root mean square of all lines."""
        return self._lines.rms

    def take(self, first: int, angle_rad: FloatArray) -> FloatArray:
        """Return the lines (k,), as of `Part`."""
        return lines_signal(self._lines, self._fs_hz, angle_rad.size, first)
