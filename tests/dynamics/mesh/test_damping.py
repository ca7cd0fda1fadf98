"""Damping of tooth pairs, and the film between flanks apart, against formulas of their own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from siggen.dynamics.friction.contact_kinematics import relative_radius
from siggen.dynamics.mesh.pair_columns import DAMPING, NORMAL, POSITION, STIFFNESS
from siggen.dynamics.mesh.pair_forces import pair_forces
from siggen.dynamics.mesh.pair_law import PairLaw, SqueezeFilm
from siggen.dynamics.mesh.pair_places import pair_table
from siggen.gears.geometry.missing_material import missing_material
from tests.dynamics.pair_runs import gear_pair, law

FILM, LENGTH, OIL = 0.8e-6, 20e-3, 0.112
DOUBLE, SINGLE = 5.3, 5.85
"""Angles with two pairs and with one pair in contact: the contact ratio is 1.637."""


def loaded(chosen: PairLaw, approach_m: float, rate_m_s: float, pitches: float) -> np.ndarray:
    pairs = pair_table(chosen)
    pair_forces(chosen, approach_m, rate_m_s, pitches, 0.0, 0.0, pairs)
    return pairs


def test_pairs_share_the_mesh_damping_by_stiffness() -> None:
    exact = missing_material(gear_pair(), None, corner_contact=False)
    pairs = loaded(law(exact, damping_ratio=0.07, mass=0.2124), 5e-6, 0.0, DOUBLE)
    touching = pairs[pairs[:, DAMPING] > 0.0]
    assert len(touching) == 2
    total = touching[:, STIFFNESS].sum()
    assert touching[:, DAMPING].sum() == pytest.approx(2.0 * 0.07 * np.sqrt(total * 0.2124), rel=1e-12)
    np.testing.assert_allclose(
        touching[:, DAMPING] / touching[:, STIFFNESS], touching[0, DAMPING] / touching[0, STIFFNESS]
    )


@pytest.mark.parametrize("gap_m", [FILM, 3e-6])
def test_the_squeeze_film_follows_from_the_reynolds_equation(gap_m: float) -> None:
    # (h³ p')' = -12 η V with h = h_0 + x²/(2 R): p' = -12 η V x/h³, integrated twice, in x/√(2 R h_0).
    exact = missing_material(gear_pair(), None, corner_contact=False)
    (pair,) = [
        row for row in loaded(law(exact, film=SqueezeFilm(OIL, LENGTH, FILM)), -gap_m, 1e-3, SINGLE) if row[NORMAL]
    ]
    radius = relative_radius(pair[POSITION], gear_pair().line_of_action_m)
    scale = np.sqrt(2.0 * radius * gap_m)
    pressure = [
        quad(lambda t: 12.0 * OIL * t * scale**2 / (gap_m * (1.0 + t * t)) ** 3, t0, np.inf)[0] for t0 in (0.0, 0.7)
    ]
    film = gap_m * (1.0 + 0.7**2)
    np.testing.assert_allclose(pressure, [6.0 * OIL * radius / h**2 for h in (gap_m, film)], rtol=1e-8)
    force = LENGTH * 2.0 * scale * quad(lambda t: 6.0 * OIL * radius / (gap_m * (1.0 + t * t)) ** 2, 0.0, np.inf)[0]
    assert pair[NORMAL] / 1e-3 == pytest.approx(force, rel=1e-8)
    if gap_m == FILM:
        # Published as about 2e4 N s/m.
        assert force == pytest.approx(2e4, rel=0.2)
