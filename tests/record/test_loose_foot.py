"""A loose foot of a rigid casing couples bouncing and rocking; records of either housing have it as a change."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigvalsh

from siggen.checks.loading import load_config
from siggen.columns.record import SimulatedRecord
from siggen.drivetrain.drivetrain import Drivetrain
from siggen.drivetrain.gear_stage import Casing
from siggen.drivetrain.makers import GROUND, rigid_housing
from siggen.drivetrain.structure import matrices
from tests.config.minimal import by_name, minimal
from tests.dynamics.casing_stage import BOLT_PLACES, make_casing
from tests.simulated import simulate

SHEAR, AXIAL, ARM, MASS, INERTIA = 8e7, 1.5e8, 0.09, 20.0, 0.25


def support(share: float, first: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Return stiffness and damping of a casing on bolts of which one is loose."""
    casing = make_casing()
    places = (*BOLT_PLACES[first:], *BOLT_PLACES[:first])
    bolts = replace(casing.bolts, places_m=places, loose_share=share)
    return supported(replace(casing, bolts=bolts))


def supported(casing: Casing) -> tuple[np.ndarray, np.ndarray]:
    housing = rigid_housing(casing, {})
    _, damping, stiffness = matrices(Drivetrain((housing.body, GROUND), housing.bolts))
    return stiffness, damping


@pytest.mark.parametrize("share", [1.0, 0.5, 0.1, 1e-3])
def test_it_couples_bouncing_and_rocking_as_by_hand(share: float) -> None:
    """Closed form: k_y = (3 + s) k, k_yφ = -(1 - s) k b, k_φ = (3 + s) k b²; roots of a quadratic in ω²."""
    bounce, rock = (3.0 + share) * AXIAL / MASS, (3.0 + share) * AXIAL * ARM**2 / INERTIA
    coupled = ((1.0 - share) * AXIAL * ARM) ** 2 / (MASS * INERTIA)
    apart = np.sqrt(0.25 * (bounce - rock) ** 2 + coupled)
    by_hand = [(3.0 + share) * SHEAR / MASS, 0.5 * (bounce + rock) - apart, 0.5 * (bounce + rock) + apart]
    found = eigvalsh(support(share)[0], np.diag([MASS, MASS, INERTIA]))
    # 1e-12: rounding of sums of eight springs, and of the smaller root
    np.testing.assert_allclose(found, sorted(by_hand), rtol=1e-12)


def test_all_four_loose_together_are_softer_bolts() -> None:
    whole, one_each = support(1.0), [support(0.1, first) for first in range(4)]
    casing = make_casing()
    softer = replace(casing.bolts, shear_stiffness_n_per_m=0.1 * SHEAR, axial_stiffness_n_per_m=0.1 * AXIAL)
    all_soft = supported(replace(casing, bolts=softer))
    for tight, soft, *single in zip(whole, all_soft, *one_each, strict=True):
        np.testing.assert_allclose(tight + sum(one - tight for one in single), soft, rtol=1e-12, atol=1e-6)


def changed(kind: str, share: float | None) -> np.ndarray:
    """Return a channel of the second state, in which a foot has a share of its stiffness left; None: no change."""
    loose: dict[str, Any] = {"fault": "looseness", "severity": "severe"}
    changes = {} if share is None else {**loose, "changes": {"housing.loose_foot_share": share}}
    dynamics = {"model": "casing", "mesh": {"law": "linear"}, "friction": {"model": "off"}}
    small = {"specimens": 1, "duration_s": 0.2, "fs_hz": 20480.0, "mesh_harmonics": 3, "dynamics": dynamics}
    sensors = [{"name": "bearing", "noise": None, "bits": None}]
    states = [{"name": "healthy"}, {"name": "second", **changes}]
    config = load_config(minimal(**small, sensors=by_name(sensors), housing={"kind": kind}, states=by_name(states)))
    (record,) = simulate(config, [1])
    assert isinstance(record, SimulatedRecord), record
    assert record.labels["state"] == "second"
    return next(iter(record.channels.values()))


@pytest.mark.parametrize("kind", ["rigid", "plates"])
def test_a_tight_foot_leaves_every_byte_and_a_loose_one_is_heard(kind: str) -> None:
    tight, loose = changed(kind, 1.0), changed(kind, 0.1)
    assert tight.tobytes() == changed(kind, None).tobytes()
    assert np.std(loose.astype(float) - tight.astype(float)) > 0.01 * np.std(tight.astype(float))
