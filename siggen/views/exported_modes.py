"""Modes of a gearbox's housing as a table that `housing: {kind: modal}` reads: an example, and a check of both ways."""

from __future__ import annotations

from math import pi

import numpy as np

from siggen.gearbox.mode_table import BASE, DRIVE, ModeTable
from siggen.record.housing import SpecimenHousing, participation

RESIDUAL_HZ, RESIDUAL_DAMPING = 1e10, 1e-6
"""Of residual vectors: so high that within any band they only give way (to 1e-11 at 30 kHz)."""
LEAST = 1e-15
"""Share of the largest flexibility below which what is left is rounding."""


def exported_modes(housing: SpecimenHousing) -> ModeTable:
    """Return the modes of a housing at its seats, sensors and entries; behind them what all higher modes give way.

    Derived. That flexibility is R = Σ λ_k v_k v_kᵀ over all places; a mode of frequency ω and shape √λ_k ω v_k gives
    way by as much. Such residual vectors are usual in finite elements (reference: standard literature).
    """
    places = {**housing.seats, **housing.motions, **{name: housing.entries[name] for name in DRIVE}}
    modes, motions = housing.modes, list(places.values())
    values, vectors = np.linalg.eigh(modes.residual_flexibility(motions, motions))
    kept = values > LEAST * max(float(values.max()), 0.0)
    beyond = vectors[:, kept] * np.sqrt(values[kept]) * (2.0 * pi * RESIDUAL_HZ)
    shapes = np.concatenate([modes.shapes(motions), beyond], axis=1)
    more = np.ones(int(kept.sum()))
    return ModeTable(
        frequency_hz=np.concatenate([modes.frequency_hz, RESIDUAL_HZ * more]),
        damping_ratio=np.concatenate([housing.damping_ratio, RESIDUAL_DAMPING * more]),
        shapes={name.removeprefix("casing_"): shape for name, shape in zip(places, shapes, strict=True)},
        base={name: np.concatenate([row, 0.0 * more]) for name, row in zip(BASE, participation(housing).T, strict=True)}
        if housing.bolts()
        else {},
    )
