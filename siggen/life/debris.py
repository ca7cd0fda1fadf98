"""Oil debris: what a counter in the oil has counted by an age of a gearbox.

It counts a share of the metal that left the flanks, and what every gearbox sheds that wears as it should. All numbers
are assumed. The shedding is a gamma process over hours of age, so a reading at an age is the same under any schedule.
"""

from __future__ import annotations

import numpy as np

from siggen.life.law import Named

STEEL_MG_PER_M3 = 7.85e9
CAUGHT, CAUGHT_SD = 0.5, 0.3
"""Median share of the metal of pits that is counted, and deviation of its logarithm from gearbox to gearbox."""
SHED_MG_PER_H, SHED_SHAPE = 0.01, 0.2
"""Mean of what is counted without a pit, and the shape of the gamma law of an hour: few hours shed most of it."""


def counted_mg(removed_m3: float, age_h: float, named: Named) -> float:
    """Return the mass counted by an age [mg]; `named` gives the gearbox's generators by what they draw."""
    caught = CAUGHT * np.exp(CAUGHT_SD * named("debris/caught").standard_normal())
    hours = named("debris/shed").standard_gamma(SHED_SHAPE, int(age_h) + 1) * SHED_MG_PER_H / SHED_SHAPE
    shed = hours[:-1].sum() + (age_h - int(age_h)) * hours[-1]
    return float(caught * STEEL_MG_PER_M3 * removed_m3 + shed)
