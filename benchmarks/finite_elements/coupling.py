"""How much two loaded neighbours on one gear body deflect each other, which the sum of pair stiffnesses leaves out."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.finite_elements.comparison import SIZE, paper_a_pair
from benchmarks.finite_elements.tooth_compliance_fem import PlaneElasticity, compliance_matrix
from siggen.gears.geometry import GearPair, SpurGear

SHARES = (0.01, 0.5, 0.99)


def neighbour_compliance(gear: SpurGear, roll: float) -> np.ndarray:
    """Compliance matrix of two adjacent teeth that touch the mate on one line of action, times E L.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : float
        Roll angle of the contact nearer the root [rad]; the other lies one pitch higher.

    Returns
    -------
    (2, 2) array
        Entry (i, j): displacement of tooth i along the line of action, without contact, by a unit force on tooth j.
    """
    rolls = np.array([[roll], [roll + 2 * np.pi / gear.teeth]])
    return compliance_matrix(gear, rolls, PlaneElasticity(), SIZE)


def body_torsion(gear: SpurGear, poisson_ratio: float = 0.3) -> float:
    """Compliance along the line of action of the ring twisted between bore and root circle, times E L (derived).

    A force on the line of action has the moment R_b about the centre, so every tooth of the body moves equally.
    """
    shear = 1 / (2 * (1 + poisson_ratio))
    squares = gear.bore_radius_m**-2 - gear.root_radius_m**-2
    return float(gear.base_radius_m**2 * squares / (4 * np.pi * shear))


def coupling_table() -> Iterator[str]:
    """Lines of the deflection a neighbour's load adds, relative to a tooth's own, along the double contact."""
    pair = paper_a_pair()
    yield "| z | double contact | lower tooth by upper | upper tooth by lower | both / own sum | body torsion |"
    yield "|---|---|---|---|---|---|"
    for gear, (first, last) in zip((pair.pinion, pair.gear), pair.active_flank, strict=True):
        room = last - 2 * np.pi / gear.teeth - first
        for share in SHARES:
            c = neighbour_compliance(gear, first + share * room)
            both = (c[0, 1] + c[1, 0]) / np.trace(c)
            torsion = 2 * body_torsion(gear) / np.trace(c)
            columns = (c[0, 1] / c[0, 0], c[1, 0] / c[1, 1], both, torsion)
            yield f"| {gear.teeth} | {share:.2f} | " + " | ".join(f"{x:.3f}" for x in columns) + " |"


def double_contact_table() -> Iterator[str]:
    """Lines of the double-contact mesh stiffness with the neighbours coupled, over the sum of both pairs'."""
    pair = paper_a_pair()
    yield "| place in double contact | coupled / sum of pairs | torsion of the bodies only / sum of pairs |"
    yield "|---|---|---|"
    for share in SHARES:
        full, torsion = _stiffness_ratios(pair, share)
        yield f"| {share:.2f} | {full:.3f} | {torsion:.3f} |"


def _stiffness_ratios(pair: GearPair, share: float) -> tuple[float, float]:
    """Equal approach of both pairs, K = 1' C^-1 1; contact compliance 4 (1 - nu^2)/(pi E L) on the diagonal."""
    position = pair.contact_start_m + share * (pair.contact_end_m - pair.base_pitch_m - pair.contact_start_m)
    on_gear = (pair.line_of_action_m - position - pair.base_pitch_m) / pair.gear.base_radius_m
    # The pair nearer the pinion's root is nearer the gear's tip, hence the gear's teeth in reverse.
    bodies = neighbour_compliance(pair.pinion, position / pair.pinion.base_radius_m)
    bodies = bodies + neighbour_compliance(pair.gear, on_gear)[::-1, ::-1]
    bodies += np.eye(2) * 4 * (1 - pair.poisson_ratio**2) / np.pi
    alone = np.diag(np.diag(bodies))
    twist = (body_torsion(pair.pinion) + body_torsion(pair.gear)) * (1 - np.eye(2))
    plain = _equal_approach(alone)
    return _equal_approach(bodies) / plain, _equal_approach(alone + twist) / plain


def _equal_approach(compliance: np.ndarray) -> float:
    return float(np.linalg.solve(compliance, np.ones(2)).sum())
