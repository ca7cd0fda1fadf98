"""What the averages of both shafts leave of a record in equal steps of pinion angle."""

from __future__ import annotations

import numpy as np

GEAR_BINS = 2048


def asynchronous_part(turns: np.ndarray, gear_order: float) -> np.ndarray:
    """Return the record less the averages of pinion and gear, (revolutions * steps,) float64.

    Parameters
    ----------
    turns : (revolutions, steps) float64
        One row per pinion revolution.
    gear_order : float
        Revolutions of the gear per pinion revolution. Its average is taken in 2048 bins of its angle.

    Notes
    -----
    Of noise a share of one over the revolutions goes with each average. Source: standard literature.
    """
    rest = (turns - turns.mean(axis=0)).ravel()
    place = np.arange(rest.size) * (gear_order / turns.shape[1]) % 1.0
    bins = (place * GEAR_BINS).astype(np.int64)
    mean = np.bincount(bins, rest, GEAR_BINS) / np.maximum(np.bincount(bins, minlength=GEAR_BINS), 1)
    return np.asarray(rest - mean[bins])


def band_signal(spectrum: np.ndarray, low: int, high: int) -> np.ndarray:
    """Return the complex envelope of the bins low <= k < high, as few samples as hold it, of rfft lines.

    Parameters
    ----------
    spectrum : (bins,) complex128
        As of `scipy.fft.rfft`.
    low, high : int
        Bins; the envelope has `high - low` samples over the record, and the rms of the analytic signal.
    """
    from scipy import fft

    kept = spectrum[low:high]
    return np.asarray(fft.ifft(kept) * kept.size if kept.size else np.empty(0, np.complex128))
