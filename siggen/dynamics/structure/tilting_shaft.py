"""A shaft that bends, on two bearings, with a gear that tilts: springs between the gear and the two seats.

Derived: seen from the gear, either end of the shaft is a cantilever that carries its bearing's force R alone, so its
bending and shear give way by R (a³/(3 E I) + a/(κ G A)) (Timoshenko; κ = 6 (1 + ν)/(7 + 6 ν) of a round section,
Cowper 1966). The shaft and its bearings are therefore two springs in parallel, each of them the bearing in series with
its cantilever, at the distances -a and +b from the middle of the gear. Nothing is condensed away but the shaft's mass,
which belongs to the gear's. The bearing's damper sees the bearing's own share of the motion alone, k_e/k of it with the
stiffness k_e of both in series, so it dissipates (k_e/k)² as much (exact for slow motion). A stiff shaft with the gear
in its middle leaves gear and bearings as without shafts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

from siggen.dynamics.structure.structure import Element


@dataclass(frozen=True, slots=True)
class Shaft:
    """A round shaft of one diameter between two bearings.

    Parameters
    ----------
    span_m : float
        Distance of the bearings, above 0.
    gear_share : float
        Place of the gear's middle from bearing a, as a share of the span, between 0 and 1.
    diameter_m : float
    youngs_modulus_pa, poisson_ratio : float
    tilt_inertia_kg_m2 : float
        Moment of inertia of the gear about a diameter.
    """

    span_m: float
    gear_share: float
    diameter_m: float
    youngs_modulus_pa: float
    poisson_ratio: float
    tilt_inertia_kg_m2: float

    @property
    def levers_m(self) -> dict[str, float]:
        """Where the bearings a and b lie from the middle of the gear [m]."""
        return {"a": -self.gear_share * self.span_m, "b": (1.0 - self.gear_share) * self.span_m}


def cantilever_compliance_m_per_n(shaft: Shaft, length_m: float) -> float:
    """Return how far the end of a piece of the shaft gives way per force on it [m/N], clamped in the gear."""
    area, inertia = 0.25 * pi * shaft.diameter_m**2, pi * shaft.diameter_m**4 / 64.0
    poisson = shaft.poisson_ratio
    shear_modulus = shaft.youngs_modulus_pa / (2.0 * (1.0 + poisson))
    effective = 6.0 * (1.0 + poisson) / (7.0 + 6.0 * poisson) * area
    bending = length_m**3 / (3.0 * shaft.youngs_modulus_pa * inertia)
    return bending + length_m / (shear_modulus * effective)


def tilting_ends(bearing: Element, shaft: Shaft, index: str) -> dict[str, Element]:
    """Return the springs at the ends a and b of a shaft in place of the element of both bearings.

    Parameters
    ----------
    bearing : Element
        Both bearings together, along one axis, between the gear of this index and its seat.
    shaft : Shaft
    index : str
        1 for the pinion, 2 for the gear; tilts are called phi_x_<index> and phi_y_<index>.
    """
    ends = {}
    for end, lever_m in shaft.levers_m.items():
        half = 0.5 * bearing.stiffness
        softened = 1.0 / (1.0 / half + cantilever_compliance_m_per_n(shaft, abs(lever_m)))
        direction = dict(bearing.direction) | tilts(bearing.direction, lever_m, index)
        ends[end] = Element(direction, softened, 0.5 * bearing.damping * (softened / half) ** 2)
    return ends


class CrossedEnd(NamedTuple):
    """Springs and dampers at one end of a shaft along two axes, and what ties them: force per way along the other."""

    elements: tuple[Element, Element]
    stiffness: float
    damping: float


def crossed_ends(bearings: tuple[Element, Element], mixed: float, shaft: Shaft, index: str) -> tuple[CrossedEnd, ...]:
    """Return the ends a and b of a shaft whose bearings push across too, by `mixed` in all: as `tilting_ends`.

    Half of the bearings' stiffness K in series with the cantilever's compliance c is P K with P = (1 + c K)^-1, and
    their damping C becomes P C P.
    """
    first, second = bearings
    k = 0.5 * np.array([[first.stiffness, mixed], [mixed, second.stiffness]])
    c = 0.5 * np.diag([first.damping, second.damping])
    ends = []
    for lever_m in shaft.levers_m.values():
        (a, b), (_, d) = np.eye(2) + cantilever_compliance_m_per_n(shaft, abs(lever_m)) * k
        p = np.array([[d, -b], [-b, a]]) / (a * d - b * b)
        stiff, damped = p @ k, p @ c @ p
        made = [
            Element(dict(e.direction) | tilts(e.direction, lever_m, index), float(stiff[i, i]), float(damped[i, i]))
            for i, e in enumerate(bearings)
        ]
        ends.append(CrossedEnd((made[0], made[1]), float(stiff[0, 1]), float(damped[0, 1])))
    return tuple(ends)


def tilts(direction: Mapping[str, float], lever_m: float, index: str) -> dict[str, float]:
    """Return what the gear's tilts add along an axis at a distance along the shaft, with their signs."""
    return {f"phi_{axis}_{index}": lever_m * direction[f"{axis}_{index}"] for axis in "xy"}
