"""Trap: the damaged tooth stands always at the same angle, after the pulse of the tacho or at the first sample.

Rayleigh's test: n independent uniform angles have a mean phasor above r with probability exp(-n r^2). Source: standard
literature.
"""

from __future__ import annotations

import math

import numpy as np

from diagnostics.audit.finding import Finding
from diagnostics.audit.measured_set import MeasuredSet

CHANCE = 1e-3
LEAST_PHASOR = 0.5
MEND = {
    "tacho": "Draw the damaged tooth per specimen.",
    "start": "Draw the start angle of every record over the whole revolution.",
}


def damage_phase(measured: MeasuredSet) -> list[Finding]:
    """Return findings for a constant angle of the damaged tooth after the pulse and at the first sample."""
    if "faulty_teeth_pinion" not in measured.labels:
        return []
    faulty, teeth = measured.labels["faulty_teeth_pinion"], measured.labels["teeth_pinion"]
    damaged = np.array([len(found) > 0 for found in faulty])
    tooth = np.array([found[0] / z if len(found) else 0.0 for found, z in zip(faulty, teeth, strict=True)])
    _, first = np.unique(measured.labels["specimen_id"][damaged], return_index=True)
    start = measured.values["start_turn"][:, 0][damaged]
    angles = {"tacho": tooth[damaged][first], "start": (start - tooth[damaged])[np.isfinite(start)]}
    where = {"tacho": "after the tacho's pulse, over specimens", "start": "at the first sample, over records"}
    return [
        Finding(
            f"constant_damage_phase_{name}",
            f"the first damaged pinion tooth has nearly the same angle {where[name]} "
            f"(mean phasor {mean_phasor(turns):.2f} of {turns.size})",
            f"by chance, 1 of 1000 sets exceeds {phasor_bound(turns.size):.2f}",
            MEND[name],
        )
        for name, turns in angles.items()
        if turns.size > 1 and mean_phasor(turns) > phasor_bound(turns.size)
    ]


def mean_phasor(turns: np.ndarray) -> float:
    """Return the length of the mean phasor of angles in revolutions, 0 (spread) to 1 (equal)."""
    return float(np.abs(np.mean(np.exp(2j * np.pi * turns))))


def phasor_bound(count: int) -> float:
    """Return the larger of 0.5 and what chance exceeds once in a thousand; 0.999 where so few angles cannot tell."""
    return min(max(LEAST_PHASOR, math.sqrt(-math.log(CHANCE) / count)), 0.999)
