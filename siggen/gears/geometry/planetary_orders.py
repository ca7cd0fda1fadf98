"""How often each thing in a planetary set happens per turn of the carrier, healthy and with a damaged tooth.

Equations: standard literature (Willis; McFadden & Smith's rule for the passing planets), derived again in numbers of
teeth. Exact fractions; the ring stands still. A negative order turns against the carrier.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from siggen.gears.geometry.planetary import PlanetarySet


def shaft_orders(teeth: PlanetarySet) -> Mapping[str, Fraction]:
    """Return the turns of each member per turn of the carrier, the planet about its own axis, seen from outside."""
    return {
        "carrier": Fraction(1),
        "sun": 1 + Fraction(teeth.ring, teeth.sun),
        "planet": 1 - Fraction(teeth.ring, teeth.planet),
        "ring": Fraction(0),
    }


def passing_orders(teeth: PlanetarySet) -> Mapping[str, Fraction]:
    """Return how often meshes, planets and damaged teeth are met per turn of the carrier.

    Sun and ring load opposite flanks of a planet's tooth: a pit on one flank is met once per turn of the planet
    against the carrier, a crack or a broken tooth twice. At unequal distances the orders with any planet are means.
    """
    count, mesh = len(teeth.places), Fraction(teeth.ring)
    return {
        "mesh": mesh,
        "planets before a fixed sensor": Fraction(count),
        "sun against carrier": mesh / teeth.sun,
        "planet against carrier": mesh / teeth.planet,
        "tooth of sun, any planet": count * mesh / teeth.sun,
        "tooth of sun, one planet": mesh / teeth.sun,
        "flank of planet's tooth": mesh / teeth.planet,
        "both flanks of planet's tooth": 2 * mesh / teeth.planet,
        "tooth of ring, any planet": count * mesh / teeth.ring,
        "tooth of ring, one planet": mesh / teeth.ring,
    }


def sideband_steps(teeth: PlanetarySet) -> Mapping[str, tuple[Fraction, ...]]:
    """Return the steps whose whole multiples, added up, are the only orders that a fixed sensor may show.

    For equal planets, by what is damaged. A damaged tooth of the ring stands still before the sensor: it adds no line.
    """
    passing = Fraction(len(teeth.places) if teeth.evenly_spaced else 1)
    turns = shaft_orders(teeth)
    return {
        "healthy": (passing,),
        "sun": (passing, turns["sun"]),
        "one planet": (Fraction(1), Fraction(teeth.ring, teeth.planet)),
        "ring": (passing,),
    }
