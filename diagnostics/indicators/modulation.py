"""Indicators of a demodulated mesh harmonic: depth of amplitude and of phase modulation once per revolution."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.indicators.indicator import indicator
from diagnostics.signal.mesh_band import Modulation
from diagnostics.signal.spectrum import line_amplitudes

DEEPEST_RAD = 1.0


@indicator(
    "amplitude_modulation_{shaft}_h{demodulated_harmonic}",
    "AM depth",
    signal="average within six sidebands of h z, demodulated",
    formula="order 1 of the amplitude over its mean",
    known="1 + m cos θ: m",
    undefined="the mesh harmonic is zero or the sideband is unresolved",
    source="McFadden 1986",
)
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


@indicator(
    "phase_modulation_{shaft}_h{demodulated_harmonic}",
    "PM depth",
    signal="average within six sidebands of h z, demodulated",
    formula="order 1 of the phase",
    unit="rad",
    known="β sin θ: β",
    undefined="the depth exceeds 1 rad (a mesh line weaker than its sidebands), or the sideband is unresolved",
    source="McFadden 1986",
)
def phase_modulation_rad(modulation: Modulation, order: int = 1) -> float:
    """Return beta of cos(h z angle + beta sin(k angle + ...)) [rad]; NaN where the phase swings beyond 1 rad.

    Parameters
    ----------
    modulation, order
        As of `amplitude_modulation`.

    Notes
    -----
    Undefined beyond 1 rad: such depths come from a mesh line weaker than its sidebands, whose phase then winds. Source:
    McFadden 1986; the limit is derived.
    """
    if not modulation.amplitude.max() > 0.0:
        return math.nan
    depth = float(line_amplitudes(modulation.phase_rad)[order])
    return depth if depth <= DEEPEST_RAD and np.ptp(modulation.phase_rad) < 2.0 * np.pi else math.nan
