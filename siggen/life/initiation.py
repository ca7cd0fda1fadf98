"""When pits begin: on every tooth a Poisson process whose mean is a power of damage time.

Derived. The mean number of pits on tooth j is H_j = (A_j/A_ref) (D_j/eta)^slope, with D_j the turns of its own gear.
With standard exponentials E_i pit k begins where H_j = E_1 + ... + E_k. So the first pit of a tooth is exactly Weibull,
and so is the first of a gearbox: the least of Weibull times of one slope.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.life.flank import Flank
from siggen.names import Side

MOST_PITS = 32
"""Of one tooth: more of them have long grown into each other."""


class Begun(NamedTuple):
    """A pit that begins at a damage time [turns of the pinion]."""

    time: float
    gear: Side
    tooth: int
    number: int


def tooth_scale(unit_scale: float, nominal: tuple[Flank, Flank], slope: float) -> float:
    """Return eta of a tooth [turns of its own gear] for which a nominal gearbox has the scale `unit_scale`."""
    return float(unit_scale * sum(one.teeth * one.turns**slope for one in nominal) ** (1.0 / slope))


def times_of(exponentials: FloatArray, eta: float, slope: float, flank: Flank, nominal: Flank) -> FloatArray:
    """Return when the pits of a tooth begin (k,) [turns of the pinion], for exponentials (k,) of mean 1."""
    wanted = np.cumsum(exponentials) * (nominal.area_m2 / flank.area_m2)
    return np.asarray(eta / flank.turns * wanted ** (1.0 / slope))


def begun(
    flanks: tuple[Flank, Flank],
    nominal: tuple[Flank, Flank],
    unit_scale: float,
    slope: float,
    named: Callable[[str], np.random.Generator],
) -> list[Begun]:
    """Return all pits of a gearbox by the time at which they begin."""
    eta = tooth_scale(unit_scale, nominal, slope)
    found = [
        Begun(float(time), flank.gear, tooth, number)
        for flank, own in zip(flanks, nominal, strict=True)
        for tooth in range(flank.teeth)
        for number, time in enumerate(_times(named(f"{flank.gear}/{tooth}/pits"), eta, slope, flank, own))
    ]
    return sorted(found)


def _times(rng: np.random.Generator, eta: float, slope: float, flank: Flank, nominal: Flank) -> FloatArray:
    return times_of(rng.standard_exponential(MOST_PITS), eta, slope, flank, nominal)
