"""Amplitude modulation depth: once-per-revolution part of a mesh harmonic's amplitude, over its mean."""

from __future__ import annotations

import math

from diagnostics.signal.demodulation import Modulation
from diagnostics.signal.spectrum import line_amplitudes


def amplitude_modulation(modulation: Modulation, order: int = 1) -> float:
    """Return m of A (1 + m cos(k angle + ...)).

    Parameters
    ----------
    modulation : Modulation
        Amplitude and phase of a mesh harmonic over one revolution.
    order : int
        Shaft order k of the modulation.

    Notes
    -----
    1 + m cos: m for m <= 1. NaN where the harmonic is zero. Source: McFadden 1986.
    """
    lines = line_amplitudes(modulation.amplitude)
    return float(lines[order] / lines[0]) if lines[0] > 0.0 else math.nan
