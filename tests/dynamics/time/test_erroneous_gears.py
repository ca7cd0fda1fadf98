"""Vibration of gears with manufacturing errors in a gearbox with casing: 30 N m, the load held at its mean speed."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from siggen.gears.errors import GearErrors, with_errors
from siggen.gears.missing_material import missing_material
from siggen.mesh.node_forces import static_approach_m
from tests.dynamics.casing_stage import make_structure
from tests.dynamics.pair_runs import MESHES, RELIEF, TORQUE, columns, gear_pair, law, motion, settled
from tests.gears.erroneous_gears import drawn, only_eccentric
from tests.gears.errors.unloaded_transmission_error import unloaded_transmission_error_m

HUNTING = 18 * 47
STEPS = 160
"""Per mesh; every mesh has the same steps, so whatever repeats with the teeth repeats in the numbers too."""
SPEED = 30.0
STEP_S = 1.0 / (MESHES * SPEED * STEPS)
SETTLE_S = 3.0
"""The lock of the load forgets with e^(-6 t), so its start is 2e-8 by then."""
PAIR = gear_pair()


def inner(
    pinion: GearErrors,
    gear: GearErrors,
    meshes: int = HUNTING,
    settle_s: float = SETTLE_S,
) -> dict[str, np.ndarray]:
    missing = with_errors(missing_material(PAIR, RELIEF), PAIR, pinion, gear)
    run = motion(make_structure(), law(missing), speed_hz=SPEED, step_s=STEP_S)
    pitches, states = settled(run, SPEED, STEP_S, meshes * STEPS, settle_s)
    found = columns(run, states[:-1], pitches[:-1])
    # The pinion's velocity: its lines are those of the acceleration.
    found["velocity_m_s"] = states[:-1, len(run.structure.coordinates) + run.structure.coordinates.index("y_pinion")]
    return found


def lines(values: np.ndarray) -> np.ndarray:
    """Return amplitudes over lines per hunting period: mesh 846, pinion 47, gear 18."""
    return np.asarray(2.0 * np.abs(np.fft.rfft(values)) / values.size)


@cache
def class_6(share: float = 0.4) -> dict[str, np.ndarray]:
    return inner(*(drawn(PAIR, which, 1, 6, share) for which in ("pinion", "gear")))


def test_hardly_loaded_gears_rest_at_the_unloaded_transmission_error() -> None:
    missing = with_errors(missing_material(PAIR, RELIEF), PAIR, drawn(PAIR, "pinion", 5), drawn(PAIR, "gear", 5))
    chosen = law(missing, backlash_m=1e-3)
    pitches = np.linspace(0.0, HUNTING, 300) + 0.0137
    found = [static_approach_m(chosen, 1e-3, float(angle)) for angle in pitches]
    # A thousandth of a newton on 2e8 N/m.
    np.testing.assert_allclose(found, unloaded_transmission_error_m(PAIR, missing, pitches), atol=1e-11)


@pytest.mark.parametrize(("which", "shaft"), [("pinion", 47), ("gear", 18)])
def test_an_eccentric_gear_has_sidebands_at_its_own_shaft_frequency_alone(which: str, shaft: int) -> None:
    eccentricity = {"pinion": 0.0, "gear": 0.0, which: 4e-6}
    spectrum = lines(inner(*(only_eccentric(PAIR, name, e) for name, e in eccentricity.items()))["velocity_m_s"])
    mesh = spectrum[HUNTING]
    sidebands = [spectrum[HUNTING + sign * shaft] for sign in (-1, 1)]
    # Weak: the heavy gears follow a slow displacement almost without force.
    assert min(sidebands) > 1e-5 * mesh
    foreign = [n for n in range(1, 6 * HUNTING) if n % shaft]
    assert spectrum[foreign].max() < 1e-6 * mesh


def test_healthy_gears_with_errors_have_sidebands_of_both_shafts_and_stay_in_contact() -> None:
    found = class_6()
    spectrum = lines(found["velocity_m_s"])
    floor = np.median(spectrum[HUNTING - 100 : HUNTING + 100])
    for shaft in (47, 18):
        for line in (HUNTING - shaft, HUNTING + shaft):
            # Teeth that all differ fill every order of the hunting period; those of the shafts stand out.
            assert spectrum[line] > 1e-3 * spectrum[HUNTING], (shaft, line)
            assert spectrum[line] > 2.0 * floor, (shaft, line)
    assert found["mesh_force_n"].min() > 0.0
    assert found["mesh_force_n"].mean() == pytest.approx(TORQUE / PAIR.pinion.base_radius_m, rel=1e-3)


def test_the_vibration_repeats_after_the_hunting_period_alone() -> None:
    errors = [drawn(PAIR, which, 3) for which in ("pinion", "gear")]
    force = inner(*errors, meshes=HUNTING + 47)["mesh_force_n"]
    first, again = force[: 47 * STEPS], force[HUNTING * STEPS :]
    np.testing.assert_allclose(again, first, atol=1e-3)
    for meshes in (18, 47):
        assert np.abs(force[meshes * STEPS : 2 * meshes * STEPS] - force[: meshes * STEPS]).max() > 10.0
