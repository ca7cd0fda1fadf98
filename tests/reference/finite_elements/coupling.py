"""How much two loaded neighbours on one gear body deflect each other, and how well `siggen` reproduces their mesh."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from siggen.gears.gear_pair import GearPair, SpurGear
from siggen.mesh.body_coupling import ring_torsion
from siggen.mesh.mesh_stiffness import mesh_stiffness
from siggen.mesh.stiffness_options import StiffnessOptions
from tests.reference.finite_elements.calibration import ToothShape
from tests.reference.finite_elements.comparison import SIZE, paper_a_pair
from tests.reference.finite_elements.neighbour_compliance import coupled_compliance

SHARES = np.array([0.01, 0.5, 0.99])
HELD_OUT_GEARS = 16
OTHER_RACKS = (
    (ToothShape(26, 1.7, 0.3), ToothShape(26, 1.7, 0.3)),
    (ToothShape(26, 4.0, -0.2), ToothShape(26, 4.0, -0.2)),
    (ToothShape(60, 2.5, 0.5), ToothShape(60, 2.5, -0.5)),
    (ToothShape(30, 3.0, 0.0, 25.0, 0.2), ToothShape(30, 3.0, 0.0, 25.0, 0.2)),
    (ToothShape(30, 3.0, 0.0, 17.5), ToothShape(30, 3.0, 0.0, 17.5)),
)


def neighbour_compliance(gear: SpurGear, roll: np.ndarray, size: float = SIZE) -> np.ndarray:
    """Compliance matrices of two adjacent teeth that touch the mate on one line of action, times E L.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : (k,) array
        Roll angles of the contact nearer the root [rad]; the other lies one pitch higher.
    size : float
        Edge length on the teeth, in modules.

    Returns
    -------
    (k, 2, 2) array
        Entry (i, j): displacement of tooth i along the line of action, without contact, by a unit force on tooth j.
    """
    full = coupled_compliance(gear, np.stack([roll, roll + 2 * np.pi / gear.teeth]), size)
    return np.einsum("iaja->aij", full)


def coupling_table() -> Iterator[str]:
    """Lines of the deflection a neighbour's load adds, relative to a tooth's own, along the double contact."""
    pair = paper_a_pair()
    yield "| z | double contact | of the lower tooth | of the upper tooth | both / own sum | ring torsion |"
    yield "|---|---|---|---|---|---|"
    for gear, (first, last) in zip((pair.pinion, pair.gear), pair.active_flank, strict=True):
        room = last - 2 * np.pi / gear.teeth - first
        for share, c in zip(SHARES, neighbour_compliance(gear, first + SHARES * room), strict=True):
            torsion = 2 * ring_torsion(gear, 0.3) / np.trace(c)
            columns = (c[0, 1] / c[0, 0], c[1, 0] / c[1, 1], 2 * c[0, 1] / np.trace(c), torsion)
            yield f"| {gear.teeth} | {share:.2f} | " + " | ".join(f"{x:.3f}" for x in columns) + " |"


def shape_pair(one: ToothShape, two: ToothShape) -> GearPair:
    """Return the pair of two tooth shapes: module 1 m, face 1 m and Young's modulus 1, so that stiffness is k/(E L)."""
    pinion, gear = (replace(s.gear(), teeth=round(s.teeth)) for s in (one, two))
    return GearPair(pinion, gear, face_width_m=1.0, youngs_modulus_pa=1.0, poisson_ratio=0.3)


def coupled_bodies(pair: GearPair, shares: np.ndarray, size: float = SIZE) -> np.ndarray:
    """Compliances of both pairs at places of the double contact (k, 2, 2) times E L, the pair that entered later first.

    Both gears, and the contact's 4 (1 - nu^2)/(pi E L) on the diagonal.
    """
    position = _double_contact(pair, shares)
    on_gear = (pair.line_of_action_m - position - pair.base_pitch_m) / pair.gear.base_radius_m
    # The pair nearer the pinion's root is nearer the gear's tip, hence the gear's teeth in reverse.
    bodies = neighbour_compliance(pair.pinion, position / pair.pinion.base_radius_m, size)
    bodies = bodies + neighbour_compliance(pair.gear, on_gear, size)[:, ::-1, ::-1]
    return bodies + np.eye(2) * 4 * (1 - pair.poisson_ratio**2) / np.pi


def equal_approach(compliance: np.ndarray) -> np.ndarray:
    """Mesh stiffness 1' C^-1 1 of compliance matrices (k, 2, 2), (k,)."""
    return np.asarray(np.linalg.solve(compliance, np.ones((len(compliance), 2, 1))).sum(axis=(1, 2)))


def model_stiffness(pair: GearPair, shares: np.ndarray, coupling: str) -> np.ndarray:
    """Mesh stiffness of `siggen`'s calibrated teeth at places of the double contact over E L, (k,)."""
    angle = (_double_contact(pair, shares) - pair.contact_start_m) / pair.pinion.base_radius_m
    stiffness = mesh_stiffness(pair, angle, StiffnessOptions(coupling=coupling))
    return stiffness / (pair.youngs_modulus_pa * pair.face_width_m)


def _double_contact(pair: GearPair, shares: np.ndarray) -> np.ndarray:
    room = pair.contact_end_m - pair.base_pitch_m - pair.contact_start_m
    return np.asarray(pair.contact_start_m + shares * room)
