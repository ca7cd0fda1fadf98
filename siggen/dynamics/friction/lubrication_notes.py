"""Sentences about contacts that lie outside the range of the formulas that were applied to them.

Ranges: reference, standard literature; those of the Masjedi-Khonsari and Xu-Kahraman regressions are from memory and
approximate. A note is no error: the formulas stay finite and monotone beyond their data, their accuracy is unknown
there.
"""

from __future__ import annotations

import numpy as np

from siggen.dynamics.friction.friction_coefficient import XU_KAHRAMAN_ROUGHEST_M
from siggen.dynamics.friction.lubrication import LOAD_FLOOR, FilmGroups

RANGES = {
    "masjedi_khonsari": {
        "load": (2e-5, 5e-4),
        "speed": (1e-12, 1e-10),
        "material": (2000.0, 7000.0),
        "hardness": (0.005, 0.03),
        "roughness": (0.0, 1e-4),
    },
    "smooth film": {"load": (1e-5, 1e-3), "speed": (1e-13, 1e-10), "material": (2000.0, 7000.0)},
}
"""Range of each group by formula; 'smooth film' stands for Dowson-Higginson, Dowson-Toyoda and Pan-Hamrock."""

MEANINGS = {
    "load": "load group F_l/(E' R_e)",
    "speed": "speed group η_0 u_e/(E' R_e)",
    "material": "material group α_pv E'",
    "hardness": "hardness over E'",
    "roughness": "roughness over R_e",
}


def lubrication_notes(
    groups: FilmGroups, formula: str = "masjedi_khonsari", fluid_friction: str = "constant", roughness_m: float = 0.0
) -> tuple[str, ...]:
    """Return one sentence for each group that leaves the range of the formula, and for a misused friction formula.

    Parameters
    ----------
    groups : FilmGroups
        Of all contacts in question; arrays of any shape.
    formula : str
        'masjedi_khonsari' or 'smooth film'.
    fluid_friction : str
        Name of the friction of the lubricated part; 'xu_kahraman' is checked against `roughness_m`.
    roughness_m : float
        Composite roughness of the roughest flank in question [m].

    Raises
    ------
    ValueError
        If the formula has no range here.
    """
    if formula not in RANGES:
        raise ValueError(f"formula: received {formula!r}; allowed are {', '.join(RANGES)}")
    notes = [
        _outside(formula, MEANINGS[name], getattr(groups, name), low, high)
        for name, (low, high) in RANGES[formula].items()
    ]
    if np.min(groups.load) < LOAD_FLOOR:
        notes.append(f"load group below {LOAD_FLOOR:g}: films and asperity shares are held at their values there")
    if fluid_friction == "xu_kahraman" and roughness_m > XU_KAHRAMAN_ROUGHEST_M:
        notes.append(
            f"Xu-Kahraman friction: received a roughness of {roughness_m * 1e6:.3g} µm; it holds up to "
            f"{XU_KAHRAMAN_ROUGHEST_M * 1e6:.3g} µm, so it is applied with the healthy flank's roughness only"
        )
    return tuple(note for note in notes if note)


def _outside(formula: str, meaning: str, values: object, low: float, high: float) -> str:
    array = np.asarray(values, dtype=np.float64)
    least, most = float(array.min()), float(array.max())
    # A thousandth over the end is no news to a reader: the ends themselves are known to one digit.
    if least >= low * 0.999 and most <= high * 1.001:
        return ""
    return f"{formula}: {meaning} runs from {least:.2g} to {most:.2g}; fitted for {low:g} to {high:g}"
