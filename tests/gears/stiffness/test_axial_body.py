"""Bending of gear bodies along the axis: against the energy of the plate, in the limit of shear, on helical teeth."""

from __future__ import annotations

from math import log, pi

import numpy as np
import pytest

from siggen.mesh import axial_body
from siggen.mesh.axial_body import axial_compliance, wave_answer, wave_sum
from siggen.mesh.body_coupling import body_coupling, neighbour_compliance
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.mesh.tooth_compliance import tooth_compliance
from tests.gears.geometry.test_helical import helical_pair


def least_energy(m: int, bore: float, width: float, poisson: float, elements: int) -> np.ndarray:
    """Return rim deflection and slope under edge force and edge moment, from linear elements along the radius.

    Independent: strains of Mindlin's plate in the middle of every element, no solution of its equations.
    """
    bending, shear = width**3 / (12 * (1 - poisson**2)), width / (2 * (1 + poisson)) * 5 / 6
    radii = np.linspace(bore, 1.0, elements + 1)
    stiffness = np.zeros((3 * radii.size, 3 * radii.size))
    law = np.diag([bending, bending, bending * (1 - poisson) / 2, shear, shear])
    law[0, 1] = law[1, 0] = poisson * bending
    for i in range(elements):
        length, r = radii[i + 1] - radii[i], 0.5 * (radii[i] + radii[i + 1])
        value, slope = np.array([0.5, 0.5]), np.array([-1.0, 1.0]) / length
        strain = np.zeros((5, 2, 3))  # of w, ψ_r, ψ_θ at both ends
        strain[0, :, 1] = slope
        strain[1, :, 1], strain[1, :, 2] = value / r, m * value / r
        strain[2, :, 1], strain[2, :, 2] = -m * value / r, slope - value / r
        strain[3, :, 0], strain[3, :, 1] = slope, value
        strain[4, :, 0], strain[4, :, 2] = -m * value / r, value
        flat = strain.reshape(5, 6)
        stiffness[3 * i : 3 * i + 6, 3 * i : 3 * i + 6] += r * length * flat.T @ law @ flat
    loads = np.zeros((3 * radii.size, 2))
    loads[-3, 0], loads[-2, 1] = 1.0, -1.0
    moved = np.linalg.solve(stiffness[3:, 3:] + (1e-30 if m else np.diag(np.tile([0, 0, 1.0], elements))), loads[3:])
    return loads[3:].T @ moved


@pytest.mark.parametrize("m", [0, 1, 2, 7])
@pytest.mark.parametrize(("bore", "width"), [(0.22, 0.3), (0.43, 0.86), (0.7, 0.05)])
def test_every_wave_is_that_of_the_least_energy(m: int, bore: float, width: float) -> None:
    coarse, fine = (least_energy(m, bore, width, 0.3, n) for n in (100, 200))
    found = wave_answer(m, bore, width, 0.3)
    # Extrapolated over the square of the elements' length; thin plates leave most.
    np.testing.assert_allclose(found, fine + (fine - coarse) / 3.0, rtol=2e-4)
    assert found[0, 1] == pytest.approx(found[1, 0], rel=1e-11)


def test_a_very_thick_ring_only_shears() -> None:
    # Around the axis the stress is F/(2π r b), the strain 1.2 of it over G, the way its integral over the radius.
    thick = wave_answer(0, 0.4, 100.0, 0.3)[0, 0] * 100.0 / (2 * pi)
    assert thick == pytest.approx(1.2 * 2.6 * log(1 / 0.4) / (2 * pi), rel=1e-3)


@pytest.mark.parametrize(("bore", "width", "angle", "height"), [(0.43, 0.86, 0.167, 0.19), (0.17, 0.15, 0.03, 0.047)])
def test_further_waves_add_nothing(
    bore: float, width: float, angle: float, height: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 18 and 100 teeth that are loaded at their tips."""
    found = wave_sum(bore, width, 0.3, angle)
    monkeypatch.setattr(axial_body, "WAVES", 110)
    more, lever = wave_sum.__wrapped__(bore, width, 0.3, angle), np.array([1.0, height])
    assert lever @ found @ lever == pytest.approx(lever @ more @ lever, rel=1e-3)


def test_the_body_bends_with_the_square_of_the_axial_force_and_moves_neighbours() -> None:
    options = StiffnessOptions(coupling="body")
    rolls = {"pinion": np.array([0.35]), "gear": np.array([0.36])}
    spur, slight = helical_pair(0.0), helical_pair(1e-6)
    for which, roll in rolls.items():
        same = [tooth_compliance(pair, which, roll, options).total for pair in (spur, slight)]
        np.testing.assert_allclose(same[1], same[0], rtol=1e-12)
    pair = helical_pair(15.0)
    gear, angle = pair.gear, pair.gear.rack_root_half_angle_rad
    own, near = (axial_compliance(gear, 20e-3, 0.3, angle, rolls["gear"], apart=n)[0] for n in (0, 1))
    # A disc of 47 teeth that is held at its bore bends as a whole: neighbours go along.
    assert 0.8 * own < near < own
    middle = np.array([0.5 * (pair.contact_start_m + pair.contact_end_m - pair.base_pitch_m)])
    both, flat = body_coupling(pair, options, middle)[0, 0] * 206e9 * 20e-3, 0.0
    ahead = pair.line_of_action_m - middle - pair.base_pitch_m
    for member, along in ((pair.pinion, middle), (pair.gear, ahead)):
        flat += neighbour_compliance(member, along / member.base_radius_m, 1, 0.3)[0]
    assert both - flat > np.tan(pair.base_helix_rad) ** 2 * near
