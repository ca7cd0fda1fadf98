"""How teeth give way across the face in few numbers, rigid share and kernel of one length, beside the extruded body.

A load q(y) deflects the line by a rigid part and by a part u with u - l² u'' = c b q, u' = 0 at both ends of the face:

    C(y, y') = c [(1 - k) + k b cosh(y_</l) cosh((b - y_>)/l)/(l sinh(b/l))],    y_< = min(y, y'), y_> = max(y, y')

c is the plane compliance, since a uniform load deflects the line uniformly. In cos(n π y/b) it is diagonal,
1/(1 + (n π l/b)²). The rule reads 1 - k from the twist of the ring (`ring_torsion`) and takes l from module and face.
"""

from __future__ import annotations

from math import exp

import numpy as np
from scipy.optimize import least_squares

from tests.reference.finite_elements.face_compliance import MODES, load_on, norms, tilt_load

LONGEST, NARROW = 1.75, 2.4
"""The rule's l on a wide face, and the face width over which it gets there, in modules; fitted to the pair of bench at
mid-flank with b/m = 1 to 15."""
PLACES = (0.05, 0.5, 0.95)
"""Of the pinion's active flank; the gear touches it at the mirrored place."""
LOADS = {
    "tilt": tilt_load(),
    "middle 20 %": load_on(0.4, 0.6),
    "middle 50 %": load_on(0.25, 0.75),
    "end 20 %": load_on(0.0, 0.2),
    "end 50 %": load_on(0.0, 0.5),
    "beside 30 %": 0.5 * (load_on(0.0, 0.35) + load_on(0.65, 1.0)),
    "beside 80 %": 0.5 * (load_on(0.0, 0.1) + load_on(0.9, 1.0)),
}


def kernel_modes(share: float, length: float, width: float, count: int = MODES) -> np.ndarray:
    """Return the diagonal (count,) of the kernel in cosines for c = 1; lengths in one unit."""
    n = np.arange(count)
    return np.asarray((share / (1 + (n * np.pi * length / width) ** 2) + (1 - share) * (n == 0)) / norms(count))


def deflections(modes: np.ndarray) -> np.ndarray:
    """Return the load-weighted mean deflections under `LOADS` of modes (n, n)."""
    return np.array([load @ modes @ load for load in LOADS.values()])


def fitted_kernel(modes: np.ndarray, width: float) -> tuple[float, float, float]:
    """Return k, l [same unit as the width] and the largest relative error under `LOADS` of modes (n, n)."""
    exact = deflections(modes / modes[0, 0])

    def errors(x: np.ndarray) -> np.ndarray:
        return np.asarray(deflections(np.diag(kernel_modes(x[0], x[1], width, len(modes)))) / exact - 1)

    found = least_squares(errors, (0.8, 1.6), bounds=((0.0, 0.1), (1.0, 20.0)))
    return float(found.x[0]), float(found.x[1]), float(np.abs(found.fun).max())


def rule_length(width: float) -> float:
    """Return l of the rule for a face width, both in modules: a narrow tooth tilts as a whole, like a twisted beam."""
    return LONGEST * (1.0 - exp(-width / NARROW))


def rule_errors(modes: np.ndarray, uniform: np.ndarray, torsion: np.ndarray, width: float) -> np.ndarray:
    """Return relative errors under `LOADS` of the rule for gears of compliances and ring torsions (g,), times E b."""
    kernel = sum(
        c * kernel_modes(1 - t / c, rule_length(width), width, len(modes))
        for c, t in zip(uniform, torsion, strict=True)
    )
    return np.asarray(deflections(np.diag(kernel)) / deflections(modes) - 1)


def _row(name: str, width: float, modes: np.ndarray, uniform: np.ndarray, torsion: np.ndarray, plane: str) -> str:
    symmetric = 0.5 * (modes + modes.T)
    share, length, error = fitted_kernel(symmetric, width)
    rule = rule_errors(symmetric, uniform, torsion, width)
    tilt = deflections(symmetric)[0] / modes[0, 0]
    fit = f"{share:.2f} | {length:.2f} | {error:.1%} | {torsion.sum() / uniform.sum():.2f}"
    parts = f"{rule[0]:+.1%} | {rule[1:].min():+.1%} to {rule[1:].max():+.1%}"
    return f"| {name} | {width:.3g} | {modes[0, 0]:.2f} | {plane} | {tilt:.3f} | {fit} | {parts} |"
