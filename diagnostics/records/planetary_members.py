"""Members of a planetary set whose ring is held, from the labels of its records: teeth, places, turns.

Against the carrier the sun turns once in as many mesh periods as it has teeth, and so do planets and ring. So sun and
ring are to each other as pinion and gear of a pair, with pulses that come once per turn of the sun against the
carrier: records of a set are read in that way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

MEMBERS = ("sun", "planet", "ring")
"""What labels call them, and what columns of indicators end in."""
PLACES = "planet_positions_deg"
AS_PAIR = {"teeth_pinion": "teeth_sun", "teeth_gear": "teeth_ring"}
"""What a pair has in the place of sun and ring."""
EVEN = 1e-9
"""Turns by which evenly spaced planets may stand off: rounding of degrees."""


@dataclass(frozen=True, slots=True)
class Planets:
    """Teeth of sun, planets and ring, and where the planets stand on the carrier, in turns of it."""

    teeth: tuple[int, int, int]
    places: tuple[float, ...]

    @property
    def ring(self) -> int:
        """Teeth of the ring."""
        return self.teeth[2]

    @property
    def passing(self) -> int:
        """Orders of the carrier that equal planets leave a sensor are multiples of this: 1 at unequal distances."""
        gaps = np.diff(np.sort(np.asarray(self.places)), append=min(self.places) + 1.0)
        return len(self.places) if float(np.ptp(gaps)) < EVEN else 1

    @property
    def sun_turns(self) -> Fraction:
        """Turns of the sun against the carrier per turn of its shaft. Source: Willis."""
        sun, _, ring = self.teeth
        return Fraction(ring, sun + ring)


def teeth_labels() -> tuple[str, ...]:
    """Return the label columns with the members' teeth."""
    return tuple(f"teeth_{member}" for member in MEMBERS)


def is_planetary(columns: Iterable[str]) -> bool:
    """Return whether label columns are those of planetary sets."""
    return {*teeth_labels(), PLACES} <= set(columns)


def planets_of(labels: Mapping[str, Any]) -> Planets | None:
    """Return the members of a record's gearbox by its labels; None where it is no planetary set."""
    if not is_planetary(labels):
        return None
    sun, planet, ring = (int(labels[name]) for name in teeth_labels())
    return Planets((sun, planet, ring), tuple(float(place) / 360.0 for place in labels[PLACES]))


def planet_labels(planets: Planets) -> dict[str, Any]:
    """Return the labels that `planets_of` makes members of."""
    return dict(zip(teeth_labels(), planets.teeth, strict=True)) | {PLACES: [360.0 * turn for turn in planets.places]}


def own_columns(columns: Sequence[str]) -> list[str]:
    """Return the label columns to read for those of a pair: sun and ring for pinion and gear, and what places say."""
    return [*(AS_PAIR.get(name, name) for name in columns), "teeth_planet", PLACES]


def as_pair(labels: dict[str, Any]) -> dict[str, Any]:
    """Return labels with the teeth of sun and ring as those of a pair besides."""
    return labels | {name: labels[own] for name, own in AS_PAIR.items()}
