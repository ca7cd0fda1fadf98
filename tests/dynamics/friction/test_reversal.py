"""How fast the friction of asperities turns round, against a time course of Mindlin's law and closed forms."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.stats import norm

from siggen.mesh.asperities import share_at
from siggen.mesh.friction import TURN_OVER_SLIP_SPEED, PitchPoint, gaussian_integral, presliding_m, slip_speed
from siggen.mesh.lubrication import LubricatedMesh, central_film_m, entrainment_speed, hertz_half_width, relative_radius
from tests.dynamics.lubricated import FORCE, LINE, MODULUS, PAIR, PITCH_POINT, mesh

ROUGH_M = 0.57e-6


def at(hz: float) -> tuple[LubricatedMesh, PitchPoint]:
    speed = 2.0 * pi * hz
    oil = mesh(speed_1_rad_s=speed, speed_2_rad_s=speed * 18 / 47)
    return oil, PitchPoint(PITCH_POINT, speed * PAIR.pinion.base_radius_m, 0.25 * pi * 3e-3)


def turned(y: float) -> float:
    """Return Mindlin's friction over its bound after a push back of y times what turns it round."""
    return 1.0 - 2.0 * (1.0 - min(y, 1.0)) ** 1.5


@pytest.mark.parametrize("hz", [5.0, 20.0, 40.0])
def test_the_slip_speed_spans_mindlins_turn_on_the_way_past_the_pitch_point(hz: float) -> None:
    oil, pitch = at(hz)
    push = presliding_m(oil, pitch, FORCE, ROUGH_M)

    def pushed(time_s: float) -> float:
        """Return the way of the flanks over each other since the pitch point, by integration of the sliding speed."""
        place = lambda t: pitch.position_m + pitch.roll_speed_m_s * t  # noqa: E731
        return quad(lambda t: place(t) * oil.speed_1_rad_s - (LINE - place(t)) * oil.speed_2_rad_s, 0.0, time_s)[0]

    ends = [
        brentq(lambda t, level=level: turned(pushed(t) / (2.0 * push)) - level, 0.0, 1e-2, xtol=1e-12)
        for level in (-0.9, 0.9)
    ]
    speeds = [(oil.speed_1_rad_s + oil.speed_2_rad_s) * pitch.roll_speed_m_s * end for end in ends]
    assert speeds[1] - speeds[0] == pytest.approx(
        2.0 * np.arctanh(0.9) * slip_speed(oil, pitch, FORCE, ROUGH_M), rel=2e-3
    )


def test_asperities_are_pressed_by_the_mean_over_their_load() -> None:
    """Only they give way on a plain of no bulk: a share of 0 at a thin film of hardly any load is not to be had."""
    oil, pitch = at(20.0)
    shallow = pitch._replace(depth_m=1e-9)
    film_m = float(central_film_m(oil.groups(PITCH_POINT, FORCE)))

    def weighed(power: float) -> float:
        return quad(lambda z: (z - film_m) ** power * norm.pdf(z / ROUGH_M) / ROUGH_M, film_m, 12.0 * ROUGH_M)[0]

    mindlin = (2.0 - 0.3) / (2.0 * (1.0 - 0.3))
    expected = 0.09 * mindlin * weighed(2.5) / weighed(1.5)
    assert presliding_m(oil, shallow, FORCE, ROUGH_M) == pytest.approx(expected, rel=1e-6)


def test_the_bulk_gives_way_by_the_share_of_the_asperities() -> None:
    oil, pitch = at(20.0)
    share = float(share_at(oil, ROUGH_M, PITCH_POINT, FORCE))
    radius = float(relative_radius(PITCH_POINT, LINE))
    half = float(hertz_half_width(FORCE / 20e-3, radius, MODULUS))
    # Two half planes under an elliptic pressure: the surface over a point at depth d, by Flamant's solution. Strain in
    # depth on the axis, integrated from the surface down (Poisson's ratio 0.3, plane strain).
    peak = 2.0 * FORCE / 20e-3 / (pi * half)

    def strain(z: float) -> float:
        root = sqrt(half**2 + z**2)
        across, down = -peak / half * ((half**2 + 2.0 * z**2) / root - 2.0 * z), -peak * half / root
        return (down - 0.3 / 0.7 * across) / MODULUS

    approach = -2.0 * quad(strain, 0.0, pitch.depth_m, points=[half, 10 * half], limit=200)[0]
    bulk = presliding_m(oil, pitch, FORCE, ROUGH_M) - presliding_m(oil, pitch._replace(depth_m=1e-9), FORCE, ROUGH_M)
    # The logarithm is that of a depth of many half widths: 35 of them here.
    assert bulk == pytest.approx(0.09 * share * approach, rel=2e-3)


def test_neither_steady_creep_nor_the_width_sets_the_ramp() -> None:
    for hz in (5.0, 20.0, 40.0):
        oil, pitch = at(hz)
        whole = TURN_OVER_SLIP_SPEED * slip_speed(oil, pitch, FORCE, ROUGH_M)
        radius = float(relative_radius(PITCH_POINT, LINE))
        half = float(hertz_half_width(FORCE / 20e-3, radius, MODULUS))
        roll = float(entrainment_speed(PITCH_POINT, LINE, oil.speed_1_rad_s, oil.speed_2_rad_s))
        spin = oil.speed_1_rad_s + oil.speed_2_rad_s
        carter, passage_s = 0.09 * half / radius * roll, 2.0 * half / roll
        assert carter < 0.15 * whole
        # The push is done long before the flanks have passed the width, so creep is never steady.
        assert whole / (spin * pitch.roll_speed_m_s) < passage_s / 3.0
        assert sliding_over_width(oil, half) < 0.01 * whole


def sliding_over_width(oil: LubricatedMesh, half_m: float) -> float:
    """Return by how much the sliding speed differs over the width, of rigid flanks that turn about their axes."""
    spin = oil.speed_1_rad_s + oil.speed_2_rad_s
    bend = 0.5 * (1.0 / PITCH_POINT - 1.0 / (LINE - PITCH_POINT))
    # A surface of that curvature; one gear slides over the other by spin times the arm from the pitch point.
    farthest = minimize_scalar(lambda x: -abs(0.5 * bend * x * x), bounds=(0.0, half_m), method="bounded").x
    return spin * abs(0.5 * bend * farthest**2)


def test_the_ramp_grows_with_speed_and_with_roughness() -> None:
    speeds = [slip_speed(*at(hz), FORCE, ROUGH_M) for hz in (5.0, 10.0, 20.0, 40.0)]
    assert speeds == sorted(speeds)
    assert 1e-3 < speeds[0] < speeds[-1] < 1e-2
    rough = [slip_speed(*at(20.0), FORCE, 1e-6 * sigma) for sigma in (0.01, 0.1, 0.5, 2.0)]
    assert rough == sorted(rough)


@pytest.mark.parametrize("order", [0.0, 1.0, 1.5, 2.5])
@pytest.mark.parametrize("separation", [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 5.0])
def test_gaussian_integrals_against_quadrature(order: float, separation: float) -> None:
    direct = quad(
        lambda x: (x - separation) ** order * np.exp(-0.5 * x * x) / np.sqrt(2.0 * np.pi), separation, separation + 14.0
    )[0]
    # quad's absolute tolerance is 1.5e-8; the values at 5 are about 1e-8.
    assert gaussian_integral(order, separation) == pytest.approx(direct, rel=1e-6, abs=1e-12)
