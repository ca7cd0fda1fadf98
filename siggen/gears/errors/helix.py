"""Helix: how the flanks of one gear run across the face, alike on all its teeth: crowning, slope and form.

Derived. Crowning is meant: a parabola that takes C_β at both ends of the face and nothing in the middle (ISO 21771).
What is not meant is held to ISO 1328-1: the slope f_Hβ, the change of the mean line over the face; the form f_fβ, the
range of what is left about that line; the total F_β, the range of both. The form is a low wave without its straight
line, as the standard takes it away before it calls the rest form. All count along the line of action, as the standard
measures them, and positive where material is missing.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.errors.iso_1328 import FlankTolerances

HELIX_POINTS = 201
"""Over the face: 100 per cycle of a wave of two cycles."""


@dataclass(frozen=True, slots=True)
class Helix:
    """One gear across the face.

    `crowning_m`: C_β; `slope_m`: f_Hβ with its sign, positive where the far end misses material; `form_m`
    (HELIX_POINTS,): from the near to the far end, of mean 0 and without slope.
    """

    crowning_m: float
    slope_m: float
    form_m: FloatArray

    @property
    def straight(self) -> bool:
        """Whether nothing is missing anywhere."""
        return self.crowning_m == 0.0 and self.slope_m == 0.0 and not np.any(self.form_m)

    def missing_m(self, place: FloatArray) -> FloatArray:
        """Return what is missing at places (k,) across the face, 0 at the near and 1 at the far end [m]."""
        form = np.interp(place, np.linspace(0.0, 1.0, HELIX_POINTS), self.form_m)
        return np.asarray(self.crowning_m * (2.0 * place - 1.0) ** 2 + self.slope_m * (place - 0.5) + form)


def straight_helix(crowning_m: float = 0.0) -> Helix:
    """Return a helix without errors."""
    return Helix(crowning_m, 0.0, np.zeros(HELIX_POINTS))


def drawn_helix(crowning_m: float, slope: float, waves: float, phase_rad: float, limits: FlankTolerances) -> Helix:
    """Return a helix within limits; both errors shrink alike where their total would pass its own.

    Parameters
    ----------
    crowning_m : C_β [m]
    slope : f_Hβ over its limit, -1 to 1
    waves, phase_rad : cycles of the form over the face, and where they begin
    limits : FlankTolerances, as a share of a class's tolerances; the form uses all of its limit
    """
    place = np.linspace(-0.5, 0.5, HELIX_POINTS)
    shape = np.sin(2.0 * pi * waves * place + phase_rad)
    shape -= shape.mean()
    shape -= place * float(place @ shape / (place @ place))
    form, line = shape * limits.helix_form_m / float(np.ptp(shape)), slope * limits.helix_slope_m
    total = float(np.ptp(line * place + form))
    share = min(1.0, limits.helix_m / total) if total > 0.0 else 0.0
    return Helix(crowning_m, share * line, share * form)
