"""Comb: harmonics of something that turns with the pinion, with sidebands of another shaft.

F(Θ) = Σ_h a_h cos(h o Θ + φ_h) (1 + 2 b cos(o_s Θ + φ_s)): two sidebands of b a_h beside every line (derived). Shafts
are given by their turn z = exp(i o Θ), taken once for all that follows them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.compiled import entry


@dataclass(frozen=True, slots=True)
class Comb:
    """Amplitudes [N] and phases (h,) of harmonics of `order` per turn of the pinion; `sideband` is b."""

    order: float
    amplitude_n: FloatArray
    phase_rad: FloatArray
    sideband: float = 0.0
    sideband_order: float = 1.0
    sideband_phase_rad: float = 0.0

    def force_n(self, turns: ComplexArray, beside: ComplexArray | None = None, top_order: float = np.inf) -> FloatArray:
        """Return the force (k,) from the turns (k,) of its own order and of the sidebands' shaft.

        Harmonics whose sidebands would pass `top_order` are left out.
        """
        reach = self.sideband_order if self.sideband else 0.0
        kept = int((np.arange(1, self.amplitude_n.size + 1) * self.order + reach < top_order).sum())
        force = harmonic_sum(turns, self.amplitude_n[:kept] * np.exp(1j * self.phase_rad[:kept]))
        if self.sideband and beside is not None:
            force *= 1.0 + harmonic_sum(beside, np.array([2.0 * self.sideband * np.exp(1j * self.sideband_phase_rad)]))
        return force


@entry(cache=True)
def turns_of(angle_rad: FloatArray, order: float) -> ComplexArray:
    """Return exp(i order Θ) (k,)."""
    result = np.empty(angle_rad.size, dtype=np.complex128)
    for i in range(angle_rad.size):
        result[i] = complex(np.cos(order * angle_rad[i]), np.sin(order * angle_rad[i]))
    return result


@entry(cache=True)
def harmonic_sum(turns: ComplexArray, phasors: ComplexArray) -> FloatArray:
    """Return Re Σ_h p_h z^h (k,), h from 1, by Horner's rule."""
    result, last = np.empty(turns.size), turns.size - 1
    for i in range(0, turns.size, 4):
        # four sums at a time do not wait for each other
        i_1, i_2, i_3 = min(i + 1, last), min(i + 2, last), min(i + 3, last)
        t_0, t_1, t_2, t_3 = 0.0j, 0.0j, 0.0j, 0.0j
        for h in range(phasors.size - 1, -1, -1):
            t_0 = (t_0 + phasors[h]) * turns[i]
            t_1 = (t_1 + phasors[h]) * turns[i_1]
            t_2 = (t_2 + phasors[h]) * turns[i_2]
            t_3 = (t_3 + phasors[h]) * turns[i_3]
        result[i_3], result[i_2], result[i_1], result[i] = t_3.real, t_2.real, t_1.real, t_0.real
    return result
