from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from siggen.dynamics.mesh.damping import (
    DampingLaw,
    damping_notes,
    damping_ratio,
    mesh_damping_ratio,
    pair_damping,
    squeeze_damping,
    squeeze_force,
)

FILM, RADIUS, LENGTH, OIL = 0.8e-6, 6.68e-3, 20e-3, 0.112


@settings(deadline=None)
@given(share=st.floats(0.0, 1.0))
def test_the_ratio_stays_between_full_film_and_boundary_contact(share: float) -> None:
    law = DampingLaw()
    ends = mesh_damping_ratio(law, 0.0), mesh_damping_ratio(law, 1.0)
    assert ends == (pytest.approx(0.06), pytest.approx(0.09))
    # Three operations round at 1e-17.
    assert ends[0] - 1e-16 <= mesh_damping_ratio(law, share) <= ends[1] + 1e-16


def test_pairs_share_the_mesh_damping_by_stiffness() -> None:
    pairs = [1.5e8, 2.3e8]
    parts = [pair_damping(0.07, k, sum(pairs), 0.2124) for k in pairs]
    assert sum(parts) == pytest.approx(2.0 * 0.07 * np.sqrt(sum(pairs) * 0.2124), rel=1e-12)


def test_the_squeeze_film_follows_from_the_reynolds_equation() -> None:
    # (h³ p')' = -12 η V with h = h_0 + x²/(2 R): p' = -12 η V x/h³, integrated twice, in x/√(2 R h_0).
    scale = np.sqrt(2.0 * RADIUS * FILM)
    pressure = [
        quad(lambda t: 12.0 * OIL * t * scale**2 / (FILM * (1.0 + t * t)) ** 3, t0, np.inf)[0] for t0 in (0.0, 0.7)
    ]
    film = FILM * (1.0 + 0.7**2)
    np.testing.assert_allclose(pressure, [6.0 * OIL * RADIUS / h**2 for h in (FILM, film)], rtol=1e-8)
    force = LENGTH * 2.0 * scale * quad(lambda t: 6.0 * OIL * RADIUS / (FILM * (1.0 + t * t)) ** 2, 0.0, np.inf)[0]
    assert squeeze_damping(FILM, RADIUS, LENGTH, OIL) == pytest.approx(force, rel=1e-8)
    # Published as about 2e4 N s/m.
    assert force == pytest.approx(2e4, rel=0.2)


@settings(deadline=None)
@given(depth=st.floats(-1e-4, 1e-5), rate=st.floats(-0.1, 0.1))
def test_the_squeeze_film_resists_only_approach_of_flanks_apart(depth: float, rate: float) -> None:
    force = squeeze_force(depth, rate, FILM, RADIUS, LENGTH, OIL)
    assert force * rate >= 0.0
    assert (force > 0.0) == (depth <= 0.0 and rate > 0.0)
    assert force <= squeeze_damping(FILM, RADIUS, LENGTH, OIL) * abs(rate)


def test_overdamped_literature_values_are_named() -> None:
    supports = {"pinion bearing": (6.56e7, 1.8e5, 0.96), "gear bearing": (1e8, 1e3, 3.0)}
    notes = damping_notes(supports)
    assert len(notes) == 1
    assert notes[0].startswith("pinion bearing: damping ratio 11.3 ")
    assert damping_ratio(6.56e7, 1.8e5, 0.96) == pytest.approx(11.3, abs=0.05)
    with pytest.raises(ValueError, match="stiffness_n_per_m"):
        damping_notes({"bolt": (0.0, 1.0, 1.0)})
