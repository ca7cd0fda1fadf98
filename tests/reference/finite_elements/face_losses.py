"""Loss of pair stiffness of spalls on part of the face, and moment of a misaligned pair: teeth and contact in 3-D.

Pair 18/47 of module 3 mm, 20 mm wide, bores of bench, at the pitch point, by `spatial_pair`.
"""

from __future__ import annotations

from functools import lru_cache
from math import radians, tan

import numpy as np

from siggen.mesh.body_coupling import ring_torsion
from tests.reference.contact.face_contact import FaceCase, land_of_gap
from tests.reference.finite_elements.face_compliance import FaceCompliance, face_compliance
from tests.reference.finite_elements.face_kernel import kernel_modes, rule_length
from tests.reference.finite_elements.spatial_pair import SpatialPair, bench_pair, spatial_pair

FORCE_N = 1200.0
MODES = 16
CELL_M = 0.1e-3
"""Length of a pressure cell; half of it changes the losses by less than 0.15 points."""
KINDS = ("rigid", "three_dimensional", "rule")


@lru_cache(maxsize=1)
def tooth_faces() -> tuple[FaceCompliance, FaceCompliance]:
    """Return both teeth at the pitch point."""
    pair, roll = bench_pair(), np.array([tan(radians(20.0))])
    width = pair.face_width_m / pair.pinion.module_m
    return face_compliance(pair.pinion, roll, width, modes=MODES), face_compliance(pair.gear, roll, width, modes=MODES)


@lru_cache(maxsize=3)
def body_matrix(kind: str, cells: int) -> np.ndarray:
    """Return (cells, cells) [m/N]: how both teeth give way: `three_dimensional`, by the `rule`, or `rigid`."""
    pair = bench_pair()
    scale = 1.0 / (pair.youngs_modulus_pa * pair.face_width_m)
    if kind == "rigid":
        return np.full((cells, cells), scale * sum(float(t.uniform[0]) for t in tooth_faces()))
    y = (np.arange(cells) + 0.5) / cells
    faces = tooth_faces() if kind == "three_dimensional" else rule_faces(cells)
    return np.asarray(scale * sum(t.matrix(y)[0] for t in faces))


def rule_faces(count: int) -> tuple[FaceCompliance, ...]:
    """Return both teeth by the rule of `face_kernel`, in `count` cosines."""
    pair = bench_pair()
    found = []
    for gear, face in zip((pair.pinion, pair.gear), tooth_faces(), strict=True):
        c = float(face.uniform[0])
        share = 1.0 - ring_torsion(gear, pair.poisson_ratio) / c
        modes = c * np.diag(kernel_modes(share, rule_length(face.width), face.width, count))
        found.append(FaceCompliance(modes[None], face.width))
    return tuple(found)


def answer(
    kind: str, share: float, start: float | None, misalignment_m: float = 0.0, cell_m: float = CELL_M
) -> SpatialPair:
    """Return the pair at 1,200 N with one gap of a share of the face, in the middle (None) or from `start`."""
    case = FaceCase(cell_m=cell_m)
    land = land_of_gap(case, share, start)
    lead = misalignment_m * (np.arange(land.size) + 0.5) / land.size
    return spatial_pair(case, body_matrix(kind, land.size), land, lead, FORCE_N)


def loss(kind: str, share: float, start: float | None, cell_m: float = CELL_M) -> float:
    """Return the loss of pair stiffness at 1,200 N (secant)."""
    return 1.0 - answer(kind, 0.0, None, 0.0, cell_m).approach_m / answer(kind, share, start, 0.0, cell_m).approach_m
