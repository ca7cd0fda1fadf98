"""Random convolutions of one revolution: shares of the angle at which a kernel's answer lies above a level.

Kernels of nine weights -1 and 2, all 84 choices of three twos, dilated; the answer's share above a level ("proportion
of positive values") is the feature. Source: Dempster et al. 2021 (MiniRocket). Here convolutions are circular, so that
nothing depends on where the revolution starts, levels are quantiles of the answers of all records of the set (no state
is looked at), and the largest answer counts too. aeon and sktime hold MiniRocket, but bring some 20 packages and no
circular convolution.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

LENGTH, TWOS = 9, 3
KERNELS = tuple(combinations(range(LENGTH), TWOS))
DILATIONS = (1, 2, 3, 5, 8, 13, 21, 34)
LEVELS = (0.5, 0.75, 0.9, 0.97, 0.995)
STEPS = 1024
CALIBRATING = 64
"""Records, evenly spread over the set, whose answers set the levels."""


def revolution(lines: np.ndarray, steps: int = STEPS) -> np.ndarray:
    """Return one revolution of lines at equal angle steps, (..., steps) float32; higher orders are left out."""
    from scipy import fft

    kept = lines[..., : steps // 2]
    return np.asarray(fft.irfft(kept, n=steps, axis=-1) * (0.5 * steps), dtype=np.float32)


def convolution_features(waves: np.ndarray) -> np.ndarray:
    """Return the features of every record, mean over its channels.

    Parameters
    ----------
    waves : (records, channels, steps) float32
        One revolution each, of comparable level; channels with NaN do not count.

    Returns
    -------
    (records, features) float64
        84 kernels, eight dilations, five shares and the largest answer; NaN without any channel.
    """
    records, channels, steps = waves.shape
    flat = waves.reshape(-1, steps)
    defined = np.isfinite(flat).all(axis=1)
    used = np.ascontiguousarray(flat[defined])
    found = np.full((records * channels, len(KERNELS) * len(DILATIONS) * (len(LEVELS) + 1)), np.nan, dtype=np.float32)
    if used.size:
        found[defined] = _of_waves(used)
    split = found.reshape(records, channels, -1)
    counted = defined.reshape(records, channels).sum(axis=1)[:, None]
    with np.errstate(invalid="ignore"):
        return np.asarray(np.nansum(split, axis=1, dtype=np.float64) / np.where(counted > 0, counted, np.nan))


def _of_waves(waves: np.ndarray) -> np.ndarray:
    chosen = np.unique(np.linspace(0, len(waves) - 1, CALIBRATING).round().astype(int))
    found = []
    for dilation in DILATIONS:
        shifted = [np.roll(waves, (LENGTH // 2 - place) * dilation, axis=1) for place in range(LENGTH)]
        ones = -np.sum(shifted, axis=0, dtype=np.float32)
        for kernel in KERNELS:
            answer = ones + np.float32(3.0) * (shifted[kernel[0]] + shifted[kernel[1]] + shifted[kernel[2]])
            levels = np.quantile(answer[chosen], LEVELS).astype(np.float32)
            found += [np.count_nonzero(answer > level, axis=1) / np.float32(waves.shape[1]) for level in levels]
            found.append(answer.max(axis=1))
    return np.stack(found, axis=1).astype(np.float32)
