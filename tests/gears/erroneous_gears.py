"""Drawn errors of the 18/47 gears that the tests share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from siggen.gears.errors import ErrorShapes, GearErrors, error_shapes, gear_errors
from siggen.gears.gear_pair import GearPair
from siggen.gears.tolerances import FlankTolerances, flank_tolerances


def named(seed: int, owner: str = "") -> Callable[[str], np.random.Generator]:
    return lambda name: np.random.default_rng([seed, *f"{owner}.{name}".encode()])


def shapes(teeth: int, seed: int, owner: str = "") -> ErrorShapes:
    draws = named(seed, owner)
    return error_shapes(draws("waves").uniform(2.5, 3.5, teeth), draws)


def limits(pair: GearPair, which: str, accuracy_class: int, share: float) -> FlankTolerances:
    return flank_tolerances(pair.member(which), pair.face_width_m, accuracy_class).times(share)


def drawn(
    pair: GearPair, which: str, seed: int, accuracy_class: int = 6, share: float = 0.4, runout_share: float = 0.6
) -> GearErrors:
    teeth = pair.member(which).teeth
    return gear_errors(
        pair, which, shapes(teeth, seed, which), limits(pair, which, accuracy_class, share), runout_share
    )


def only_eccentric(pair: GearPair, which: str, eccentricity_m: float, phase_rad: float = 0.3) -> GearErrors:
    """Return a gear that is perfect but for its eccentricity; 0 for a perfect one."""
    zero = drawn(pair, which, 0, share=0.0)
    return GearErrors(eccentricity_m, phase_rad, zero.pitch_m, zero.slope_m, zero.form_m)
