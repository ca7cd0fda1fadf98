"""Share of the normal load that asperities carry in mixed lubrication, from the film ratio Λ = h/σ.

La = 1 - 1.21 Λ^0.64/(1 + 0.37 Λ^1.26) up to Λ = 2, nothing above: the regression of Zhu and Hu's numerical contacts, as
Castro and Seabra use it for gears (from memory). h is the central film of smooth surfaces, σ the composite rms
roughness. At 2 the regression is 4e-4 with a slope of -0.02, and it turns up again beyond 4: so it ends there. Rough
discs rub more up to Λ = 3.5 (Vengudusamy, Enekes and Spallek 2019, abstract): above 2 nothing is a lower bound.

Verified: the mean friction of a mesh that follows against two formulas fitted to measured gears
(`tests/dynamics/friction/test_gear_friction.py`).
"""

from __future__ import annotations

import numpy as np

from siggen.dynamics.friction.contact_kinematics import Values

FULL_FILM = 2.0
"""Film ratio from which asperities carry nothing."""


def asperity_load_share(film_ratio: Values) -> Values:
    """Return La, from 1 without a film to 0 from a film ratio of 2 on."""
    ratio = np.minimum(film_ratio, FULL_FILM)
    share = np.maximum(1.0 - 1.21 * ratio**0.64 / (1.0 + 0.37 * ratio**1.26), 0.0)
    return np.where(np.asarray(film_ratio) >= FULL_FILM, 0.0, share)[()]
