"""Complex envelopes of lines of a recording about a course of angle.

One transform per channel; around every line a slice of it is turned back by the course and low-passed. A line whose
course is right has a constant envelope; a correction of the course turns all envelopes, each by its harmonic. Source:
demodulation in the frequency domain is standard literature.
"""

from __future__ import annotations

import numpy as np

SILENCE_S = 1.0
"""Zeros behind the recording: without them its end leaks into its beginning."""


class LineEnvelopes:
    """Spectra of the channels (channels, n) of a recording [fs_hz], from which envelopes are cut."""

    def __init__(self, signals: np.ndarray, fs_hz: float) -> None:
        from scipy import fft

        self.duration_s = signals.shape[1] / fs_hz
        length = fft.next_fast_len(signals.shape[1] + int(SILENCE_S * fs_hz), real=True)
        self._span_s = length / fs_hz
        self._spectra = fft.rfft(signals, length, axis=1)

    def around(
        self, time_s: np.ndarray, turns: np.ndarray, orders: np.ndarray, half_hz: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return even times (m,) [s] and the envelopes (channels, orders, m), of a band of +-half_hz about each line.

        Parameters
        ----------
        time_s, turns : (k,) float64
            The course of angle over the whole recording.
        orders : (h,) float64
            Lines, per turn.
        half_hz : float
            Half the width of the band [Hz].
        """
        from scipy import fft

        span = self._span_s
        mean_hz = float((turns[-1] - turns[0]) / (time_s[-1] - time_s[0]))
        swing_hz = float(np.abs(np.gradient(turns, time_s) - mean_hz).max())
        reach = int(np.ceil((float(orders.max()) * swing_hz + 2.0 * half_hz) * span)) + 2
        points = fft.next_fast_len(2 * reach)
        kept = max(8, int(np.ceil(half_hz * span)))
        fine_s = np.arange(points) * (span / points)
        away = np.interp(fine_s, time_s, turns - mean_hz * time_s)
        envelopes = np.empty((len(self._spectra), orders.size, 2 * kept), np.complex128)
        for place, order in enumerate(orders):
            centre = round(order * mean_hz * span)
            cells = np.arange(max(centre - reach, 1), min(centre + reach, self._spectra.shape[1]))
            slice_ = np.zeros((len(self._spectra), points), np.complex128)
            slice_[:, (cells - centre) % points] = self._spectra[:, cells]
            rest_hz = order * mean_hz - centre / span
            turned = fft.ifft(slice_, axis=1) * np.exp(-2j * np.pi * (order * away + rest_hz * fine_s))
            narrow = fft.fft(turned, axis=1)
            envelopes[:, place] = fft.ifft(np.hstack([narrow[:, :kept], narrow[:, points - kept :]]), axis=1)
        even_s = np.arange(2 * kept) * (span / (2 * kept))
        inside = even_s <= self.duration_s
        return even_s[inside], envelopes[..., inside]
