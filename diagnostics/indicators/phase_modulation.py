"""Phase modulation depth: once-per-revolution part of a mesh harmonic's phase."""

from __future__ import annotations

import math

import numpy as np

from diagnostics.signal.demodulation import Modulation
from diagnostics.signal.spectrum import line_amplitudes

DEEPEST_RAD = 1.0


def phase_modulation_rad(modulation: Modulation, order: int = 1) -> float:
    """Return beta of cos(h z angle + beta sin(k angle + ...)) [rad]; NaN where the phase swings beyond 1 rad.

    Parameters
    ----------
    modulation : Modulation
        Amplitude and phase of a mesh harmonic over one revolution.
    order : int
        Shaft order k of the modulation.

    Notes
    -----
    Undefined beyond 1 rad: such depths come from a mesh line weaker than its sidebands, whose phase then winds. Source:
    McFadden 1986; the limit is derived.
    """
    if not modulation.amplitude.max() > 0.0:
        return math.nan
    depth = float(line_amplitudes(modulation.phase_rad)[order])
    return depth if depth <= DEEPEST_RAD and np.ptp(modulation.phase_rad) < 2.0 * np.pi else math.nan
