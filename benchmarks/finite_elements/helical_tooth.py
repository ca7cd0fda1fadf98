"""Compliance of one helical tooth along its contact line by the twisted body, beside the model that siggen uses.

Load normal to the flank along the contact line, which slopes over it; deflection along the normal, read at every place
of the face where the line of action crosses the tooth's centre line, as of spur teeth (`face_compliance`). Forces and
deflections are those of the transverse plane, as in `siggen.gears.geometry.helical`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import radians, tan
from typing import NamedTuple

import numpy as np

from benchmarks.finite_elements.extruded_body import face_line
from benchmarks.finite_elements.face_compliance import face_compliance
from benchmarks.finite_elements.helical_body import HelicalBody
from benchmarks.finite_elements.spatial_pair import bench_pair
from benchmarks.finite_elements.tooth_compliance_fem import interior_functionals, lines_of_action, nodal_functionals
from benchmarks.finite_elements.tooth_mesh import tooth_mesh
from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.helical import transverse_gear
from siggen.gears.stiffness.compliance import tooth_compliance
from siggen.gears.stiffness.stiffness_options import StiffnessOptions

SIZE, ELEMENT = 0.2, 0.8
"""Edge length on the tooth and of the middle elements across the face, in modules; halving both adds 0.7 to 1.0 %."""
HELICES_DEG = (0.0, 10.0, 15.0, 20.0, 25.0)


class HelicalTooth(NamedTuple):
    """Mean deflections under an even load along a contact line times E b: finite elements over the model.

    `still`: with a body that does not move along its axis, `moving`: with one that does but for its bore.
    """

    helix_deg: float
    gear: str
    still: float
    moving: float


def helical_table() -> Iterator[str]:
    """Yield the table of `helical`: finite elements over the model in the middle of the path."""
    yield "| helix | gear | body still along its axis | body that moves |\n|---|---|---|---|"
    for one in helical_teeth():
        yield f"| {one.helix_deg:.0f}° | {one.gear} | {one.still:.3f} | {one.moving:.3f} |"


def helical_teeth() -> Iterator[HelicalTooth]:
    """Yield both gears of the pair at every helix."""
    for helix_deg in HELICES_DEG:
        pair = helical_bench_pair(helix_deg)
        for which in ("pinion", "gear"):
            still, moving = (line_compliance(pair, which, body_moves=moves) for moves in (False, True))
            model = _model(pair, which)
            yield HelicalTooth(helix_deg, which, still / model, moving / model)


def helical_bench_pair(helix_deg: float) -> GearPair:
    """Return the 18/47 pair of bench with helical teeth."""
    spur, helix = bench_pair(), radians(helix_deg)
    gears = {which: transverse_gear(spur.member(which), helix) for which in ("pinion", "gear")}
    return replace(spur, **gears, helix_rad=helix)


def line_rolls(pair: GearPair, which: str, across: np.ndarray) -> np.ndarray:
    """Return the rolls (n,) of the contact line at distances (n,) from the middle of the face over its width [rad].

    The middle of the face is in the middle of the path, so that the whole line is on the flank.
    """
    s = 0.5 * (pair.contact_start_m + pair.contact_end_m) + across * pair.face_width_m * tan(pair.base_helix_rad)
    path = s if which == "pinion" else pair.line_of_action_m - s
    return np.asarray(path / pair.member(which).base_radius_m)


def line_compliance(pair: GearPair, which: str, *, body_moves: bool) -> float:
    """Return the mean deflection under an even load along a contact line times E b; the body may move along its axis.

    The bore is held in any case.
    """
    gear = pair.member(which)
    width = pair.face_width_m / gear.module_m
    if pair.helix_rad == 0.0:  # all places of the line are one node
        return float(face_compliance(gear, line_rolls(pair, which, np.zeros(1)), width, SIZE, ELEMENT, 1).uniform[0])
    line = face_line(width, ELEMENT)
    rolls = np.atleast_2d(line_rolls(pair, which, line.y / width - 0.5))
    crossing, way = (part[0] for part in lines_of_action(gear, rolls))
    mesh = tooth_mesh(gear, rolls, SIZE)
    # The normal along the contact line stands still in space, so that in the section it turns back by the twist.
    slope = tan(pair.base_helix_rad) / (gear.base_radius_m / gear.module_m)
    twist = slope if which == "gear" else -slope
    body = HelicalBody(mesh, line, twist, 0.0 if body_moves else gear.root_radius_m / gear.module_m)
    points = mesh.load_points[0]
    # Flanks are along τ J x + e_z, so that the normal has this share of the force along z.
    axial = -twist * (way[:, 1] * points[:, 0] - way[:, 0] * points[:, 1])
    share = line.load(np.ones_like) / width
    push = nodal_functionals(body.plane, points, way).toarray() * share[:, None]
    pull = body.axial.probes(points.T).toarray() * (share * axial)[:, None]
    right = (
        np.ascontiguousarray(push[:, body.free].T)[:, None],
        np.ascontiguousarray(pull[:, body.free_axial].T)[:, None],
    )
    moved, moved_axial = body.solved(right)
    read = interior_functionals(body.plane, crossing, way).toarray()[:, body.free]
    read_axial = body.axial.probes(crossing.T).toarray()[:, body.free_axial] * axial[:, None]
    deflection = np.einsum("np,pn->n", read, moved[:, 0]) + np.einsum("np,pn->n", read_axial, moved_axial[:, 0])
    return float(width * (share @ deflection))


def _model(pair: GearPair, which: str) -> float:
    """Return the same by the model, whose slices give way as at their own heights."""
    across = (np.arange(200) + 0.5) / 200 - 0.5
    rolls = line_rolls(pair, which, across)
    whole = tooth_compliance(pair, which, rolls, StiffnessOptions()).total
    return float(whole.mean() * pair.youngs_modulus_pa * pair.face_width_m)
