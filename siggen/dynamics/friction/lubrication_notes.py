"""Sentences about contacts that lie outside the range of the formulas that were applied to them.

Ranges: reference, standard literature; those of the Masjedi-Khonsari and Xu-Kahraman regressions are from memory and
approximate. A note is no error: the formulas stay finite and monotone beyond their data, their accuracy is unknown
there.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

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
    "load": "the load group F_l/(E' R_e)",
    "speed": "the speed group η_0 u_e/(E' R_e)",
    "material": "the material group α_pv E'",
    "hardness": "hardness over E'",
    "roughness": "roughness over R_e",
}


def lubrication_notes(
    groups: FilmGroups,
    formula: str = "masjedi_khonsari",
    checked: Collection[str] = tuple(MEANINGS),
) -> tuple[str, ...]:
    """Return one sentence on all groups that leave the range of the formula.

    Parameters
    ----------
    groups : FilmGroups
        Of all contacts in question; arrays of any shape.
    formula : str
        'masjedi_khonsari' or 'smooth film'.
    checked : collection of str
        Names of the groups to compare with the range; by default all.

    Raises
    ------
    ValueError
        If the formula has no range here.
    """
    if formula not in RANGES:
        raise ValueError(f"formula: received {formula!r}; allowed are {', '.join(RANGES)}")
    notes = [_outside(formula, groups, checked)]
    if np.min(groups.load) < LOAD_FLOOR:
        notes.append(
            f"oil film: the load group falls below {LOAD_FLOOR:g}; film and asperity share keep their values from there"
        )
    return tuple(note for note in notes if note)


def _outside(formula: str, groups: FilmGroups, checked: Collection[str]) -> str:
    """Return one sentence for all groups outside the range, with how far they are outside; empty if none is."""
    parts = []
    for name, (low, high) in RANGES[formula].items():
        if name not in checked:
            continue
        array = np.asarray(getattr(groups, name), dtype=np.float64)
        least, most = float(array.min()), float(array.max())
        # A thousandth over the end is no news to a reader: the ends themselves are known to one digit.
        if least < low * 0.999:
            parts.append(f"{MEANINGS[name]} is {_by(low / least)} below")
        if most > high * 1.001:
            parts.append(f"{MEANINGS[name]} is {_by(most / high)} above")
    if not parts:
        return ""
    return (
        f"oil film: {', '.join(parts)} the data behind the film formula ({formula}); the film thickness is extrapolated"
    )


def _by(ratio: float) -> str:
    return "slightly" if ratio < 1.1 else f"up to {ratio:.2g} times"
