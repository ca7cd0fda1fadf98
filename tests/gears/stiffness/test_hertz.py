"""Contact laws: the linear constant, the exact approach of a half plane, exponents, dimensions, lost length."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.mesh.hertz import centre_line_depth, contact_half_width, weber_banaschek_compliance
from siggen.mesh.mesh_stiffness import contact_compliance, pair_compliance, pair_stiffness, rolls_at
from siggen.mesh.stiffness_options import StiffnessOptions
from tests.gears.builders import layers, pair_18_47

FORCE_N = 2000.0


def at_the_pitch_point(pair):
    return rolls_at(pair, np.array([pair.pitch_point_m]))


def weber(pair, force_n, length_m=None, **other):
    rolls = at_the_pitch_point(pair)
    length = np.array([pair.face_width_m if length_m is None else length_m])
    return weber_banaschek_compliance(pair, *rolls, length, force_n, **other)[0]


def approach_per_force(depth, half_width, poisson):
    """E L times the approach of the surface to a point below it, from Hertz's stresses on the axis, plane strain."""
    peak = 2.0 / (pi * half_width)

    def strain(z):
        root = np.hypot(half_width, z)
        across = -peak / half_width * ((half_width**2 + 2 * z * z) / root - 2 * z)
        along = -peak * half_width / root
        return (1 - poisson**2) * along - poisson * (1 + poisson) * across

    return -quad(strain, 0.0, depth, epsabs=1e-13, epsrel=1e-12)[0]


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.45])
def test_weber_banaschek_is_the_approach_of_two_half_planes_under_hertz_pressure(poisson):
    pair = pair_18_47(poisson_ratio=poisson)
    rolls = at_the_pitch_point(pair)
    width = contact_half_width(pair, *rolls, np.array([pair.face_width_m]), FORCE_N)[0]
    depths = [centre_line_depth(pair, which, roll)[0] for which, roll in zip(("pinion", "gear"), rolls, strict=True)]
    exact = sum(approach_per_force(depth, width, poisson) for depth in depths)
    # The logarithm leaves out terms of order (a/h)^2 = 1.2e-3 here; measured 0.01 to 0.02 %.
    assert weber(pair, FORCE_N) * pair.youngs_modulus_pa * pair.face_width_m == pytest.approx(exact, rel=5e-4)


def test_half_width_is_that_of_hertz_for_two_cylinders():
    pair = pair_18_47()
    rolls = at_the_pitch_point(pair)
    width = contact_half_width(pair, *rolls, np.array([0.02]), FORCE_N)[0]
    # Peak pressure of cylinders, p0 = sqrt(F E*/(pi L R)) with E* = E/(2 (1 - nu^2)), and F = pi a L p0/2.
    first, second = rolls[0][0] * pair.pinion.base_radius_m, rolls[1][0] * pair.gear.base_radius_m
    modulus, radius = pair.youngs_modulus_pa / (2 * 0.91), first * second / (first + second)
    pressure = np.sqrt(FORCE_N * modulus / (pi * 0.02 * radius))
    assert pi * width * 0.02 * pressure / 2 == pytest.approx(FORCE_N, rel=1e-12)


@pytest.mark.parametrize(
    "options",
    [
        StiffnessOptions(),
        StiffnessOptions(hertz="weber_banaschek", hertz_force_n=FORCE_N),
    ],
    ids=lambda o: o.hertz,
)
def test_lost_contact_length_counts_as_a_narrower_face(options):
    pits = layers(1, 10)
    pair = pair_18_47()
    position = pair.pinion.base_radius_m * pair.pinion.roll_at_height([1.9e-3])
    pitted = contact_compliance(pair, position, pits, options=options)
    # Ten pits of 0.6 mm at their middle leave 14 of 20 mm.
    narrow = contact_compliance(pair_18_47(face_width_m=14e-3), position, options=options)
    np.testing.assert_allclose(pitted, narrow, rtol=1e-12)
    assert pitted[0] > contact_compliance(pair, position, options=options)[0]


def test_parts_of_a_pair_add_up_to_its_compliance():
    pair = pair_18_47()
    position = np.linspace(pair.contact_start_m, pair.contact_end_m, 9)
    parts = pair_compliance(pair, position, StiffnessOptions(), layers(1, 4))
    np.testing.assert_array_equal(1 / parts.total, pair_stiffness(pair, position, StiffnessOptions(), layers(1, 4)))
