"""The law of the stored codes of a channel: what converter, format or program leave in whole multiples of a step.

Samples that lie many steps apart take neighbouring codes equally often, however strong the signal is. So a count of
codes is compared with the mean of its two neighbours, c[k] - (c[k-1] + c[k+1]) / 2, of variance 1.5 c[k]: where codes
come at random that is noise at any level of the signal. Summed over residues it shows codes that are avoided or
preferred; alone, the code zero; over large or small samples, steps that depend on size. Low bits of neighbours, and of
channels, are independent, and no program can pack them. A run of samples stands in a record once.

All holds from a scatter of 16 steps of the second difference on; records below, and such without steps, give zeros.
Source: derived.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Mapping
from itertools import combinations

import numpy as np

from diagnostics.records.sample_bytes import sample_bytes

MODULI = (2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 16, 32, 64, 100, 128, 256)
FEWEST_STEPS, LARGEST_CODE = 16.0, 1 << 16
SIZES: Mapping[str, tuple[float, float]] = {"small": (0.0, 0.25), "large": (1.0, math.inf), "largest": (2.0, math.inf)}
"""Samples by their size over the rms value."""

RUN = 8
"""Samples of a run that should stand in a record once."""

MIXED = 0x9E3779B97F4A7C15
"""Odd, without pattern: 2^64 over the golden ratio."""


def code_law(channels: Mapping[str, np.ndarray]) -> dict[str, float]:
    """Return the numbers of the codes of a record, by name.

    Parameters
    ----------
    channels : mapping of str to (n,) float
        Samples as they are stored.
    """
    codes = {name: stored_codes(signal) for name, signal in channels.items()}
    found = {f"{what} of {name}": value for name, own in codes.items() for what, value in _of_channel(own).items()}
    for first, second in combinations(codes, 2):
        alike = codes[first].size == codes[second].size
        found[f"low bits that {first} and {second} share"] = _mean_sign(codes[first] + codes[second]) if alike else 0.0
    return found


def stored_codes(signal: np.ndarray) -> np.ndarray:
    """Return samples in steps of their converter, (n,) int64; empty where these are no codes, or too few apart.

    Parameters
    ----------
    signal : (n,) float
        Samples as they are stored.
    """
    step = 2.0 ** sample_bytes(signal)["converter_step_log2"]
    if not math.isfinite(step):
        return np.empty(0, np.int64)
    codes = np.round(np.asarray(signal, dtype=np.float64) / step)
    if codes.size < RUN or np.diff(codes, 2).std() < FEWEST_STEPS:
        return np.empty(0, np.int64)
    return np.asarray(codes, dtype=np.int64)


def _of_channel(codes: np.ndarray) -> dict[str, float]:
    names = ["unevenness", "zeros", "low bits packed", "low bits beside the next", "low bits beside the second next"]
    names += [f"unevenness modulo {m}" for m in MODULI] + [f"odd ones of {size} codes" for size in SIZES]
    if not codes.size:
        return dict.fromkeys([*names, "runs that stand twice"], 0.0)
    size, inner = np.sqrt(np.mean(np.square(codes))), codes[np.abs(codes) <= LARGEST_CODE]
    reach = int(np.abs(inner).max(initial=0)) + 2
    counts = np.bincount(inner + reach, minlength=2 * reach + 1).astype(np.float64)
    inside, around = counts[1:-1], 0.5 * (counts[:-2] + counts[2:])
    excess, own = inside - around, np.arange(1 - reach, reach)
    zero = reach - 1
    found = {
        "unevenness": float(np.square(excess).sum() / (1.5 * inner.size + 1.0)),
        "zeros": float(excess[zero] / np.sqrt(1.5 * around[zero] + 1.0)),
        "low bits packed": len(zlib.compress((codes & 15).astype(np.uint8).tobytes(), 1)) / codes.size,
        "low bits beside the next": _mean_sign(codes[1:] + codes[:-1]),
        "low bits beside the second next": _mean_sign(codes[2:] + codes[:-2]),
        "runs that stand twice": _twice(codes),
    }
    for modulus in MODULI:
        total = np.append(excess, np.zeros(-excess.size % modulus)).reshape(-1, modulus).sum(axis=0)
        found[f"unevenness modulo {modulus}"] = float(np.log(np.square(total).sum() / (2.0 * inner.size + 1.0) + 1e-3))
    for name, (low, high) in SIZES.items():
        kept = (np.abs(own) >= low * size) & (np.abs(own) < high * size)
        odd = np.sum(np.where(own[kept] % 2, excess[kept], -excess[kept]))
        found[f"odd ones of {name} codes"] = float(odd / np.sqrt(6.0 * inside[kept].sum() + 1.0))
    return found


def _mean_sign(codes: np.ndarray) -> float:
    """Return the mean of +1 for even and -1 for odd codes, in its standard deviations."""
    return float(np.mean(1 - 2 * (codes & 1)) * math.sqrt(codes.size)) if codes.size else 0.0


def _twice(codes: np.ndarray) -> float:
    """Return how many runs of samples stand in a record again."""
    if codes.size < RUN:
        return 0.0
    hashed, power = codes.astype(np.uint64), 1
    total = np.zeros(codes.size - RUN + 1, np.uint64)
    for place in range(RUN):  # sums wrap around, as a hash may
        total += np.uint64(power) * hashed[place : place + total.size]
        power = power * MIXED % 2**64
    return float(total.size - np.unique(total).size)
