"""PairRest: compliance of a pair without its contact, by how it gives way across the face.

A share of each tooth's compliance bends with the load at its place, over a length (`tooth_kernel`); the remainder, the
gear body above all, is rigid across the face.

Derived for now, until finite elements of a tooth of finite width stand here: the tooth is a plate, clamped at the root
circle, whose sections keep the shape of a cantilever loaded at the height H. Twisting it costs 2 (1 - ν) D ∫φ'²,
bending it D ∫φ''², so that the deflection decays over l = H √(0.8 (1 - ν)) (φ of a load at the end). What bends
so is bending, shear and compression of the tooth; its foundation counts as rigid.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from siggen.arrays import FloatArray
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.stiffness.compliance import ToothCompliance


class PairRest(NamedTuple):
    """At positions (k,): `rigid_m_per_n` (k,); `tooth_m_per_n`, `length_m` (k, 2) of the pinion's and gear's tooth."""

    rigid_m_per_n: FloatArray
    tooth_m_per_n: FloatArray
    length_m: FloatArray


def rigid_rest(compliance_m_per_n: FloatArray) -> PairRest:
    """Return the rest (k,) of teeth that are rigid across the face."""
    none = np.zeros((compliance_m_per_n.size, 2))
    return PairRest(compliance_m_per_n, none, np.full_like(none, np.inf))


def pair_rest(
    pair: GearPair, rolls: tuple[FloatArray, FloatArray], teeth: tuple[ToothCompliance, ToothCompliance]
) -> PairRest:
    """Return the rest of pinion and gear tooth loaded at roll angles (k,) each [rad]."""
    shares, lengths = [], []
    for which, roll, tooth in zip(("pinion", "gear"), rolls, teeth, strict=True):
        gear = pair.member(which)
        height = gear.radius_m(roll) - gear.root_radius_m
        lengths.append(sqrt(0.8 * (1.0 - pair.poisson_ratio)) * height)
        shares.append(1.0 - tooth.foundation / tooth.total)
    total = np.stack([tooth.total for tooth in teeth], axis=1)
    bends = total * np.stack(shares, axis=1)
    return PairRest((total - bends).sum(axis=1), bends, np.stack(lengths, axis=1))
