"""Compliance of helical teeth along their contact lines by the twisted body, beside the model that siggen uses.

Load normal to the flank along the contact line, which slopes over it; deflection along the normal, read at every place
of the face where the line of action crosses the tooth's centre line, as of spur teeth (`face_compliance`), and on an
unloaded neighbour at its contact. Forces and deflections are those of the transverse plane, as in
`siggen.gears.helical`.
"""

from __future__ import annotations

from dataclasses import replace
from math import radians, tan
from typing import NamedTuple

import numpy as np

from siggen.gears.gear_pair import GearPair
from siggen.gears.spur_gear import SpurGear, transverse_gear
from tests.reference.finite_elements.extruded_body import face_line
from tests.reference.finite_elements.face_compliance import face_compliance
from tests.reference.finite_elements.helical_body import HelicalBody
from tests.reference.finite_elements.tooth_compliance_fem import (
    interior_functionals,
    lines_of_action,
    nodal_functionals,
)
from tests.reference.finite_elements.tooth_mesh import tooth_mesh

SIZE, ELEMENT = 0.2, 0.8
"""Edge length on the tooth and of the middle elements across the face, in modules; halving both adds 0.7 to 1.0 %."""


class HelicalCase(NamedTuple):
    """A pair of module 3 mm: teeth, roots over bores, width of the face [m], helix."""

    name: str
    teeth: tuple[int, int]
    root_over_bore: tuple[float, float]
    face_width_m: float
    helix_deg: float

    def pair(self) -> GearPair:
        """Return the pair."""
        gears = [
            transverse_gear(
                SpurGear(z, 3e-3, radians(20.0), 0.0, 1.0, 0.25, (0.5 * z - 1.25) * 3e-3 / ratio, body_ratio=1.0),
                radians(self.helix_deg),
            )
            for z, ratio in zip(self.teeth, self.root_over_bore, strict=True)
        ]
        return GearPair(gears[0], gears[1], self.face_width_m, 206e9, 0.3, helix_rad=radians(self.helix_deg))


BENCH_ROOTS = (2.325, 4.45)
"""A helix of 0 says what the mesh, and a face that is no plane stress, leave."""


def helical_bench_pair(helix_deg: float) -> GearPair:
    """Return the 18/47 pair of bench with helical teeth."""
    pair = HelicalCase("bench", (18, 47), BENCH_ROOTS, 20e-3, helix_deg).pair()
    bores = (10e-3, 15e-3)
    gears = (replace(pair.member(w), bore_radius_m=b) for w, b in zip(("pinion", "gear"), bores, strict=True))
    return replace(pair, **dict(zip(("pinion", "gear"), gears, strict=True)))


def line_rolls(pair: GearPair, which: str, across: np.ndarray, teeth: int = 1) -> np.ndarray:
    """Return the rolls (teeth, n) of the contact lines at distances (n,) from the middle over the face's width [rad].

    The middle of the face is in the middle of the path, of two teeth half a base pitch before and behind it, so that
    whole lines are on the flanks.
    """
    s = 0.5 * (pair.contact_start_m + pair.contact_end_m) + across * pair.face_width_m * tan(pair.base_helix_rad)
    path = s if which == "pinion" else pair.line_of_action_m - s
    apart = (np.arange(teeth) - 0.5 * (teeth - 1)) * pair.base_pitch_m
    return np.asarray((path + apart[:, np.newaxis]) / pair.member(which).base_radius_m)


def line_compliances(pair: GearPair, which: str, teeth: int = 1) -> np.ndarray:
    """Return mean deflections (teeth, 1) of contact lines under an even load along the first one, times E b.

    The bore is held.
    """
    gear = pair.member(which)
    width = pair.face_width_m / gear.module_m
    if pair.helix_rad == 0.0 and teeth == 1:  # all places of the line are one node
        return face_compliance(gear, line_rolls(pair, which, np.zeros(1))[0], width, SIZE, ELEMENT, 1).uniform[:, None]
    line = face_line(width, ELEMENT)
    rolls = line_rolls(pair, which, line.y / width - 0.5, teeth)
    if pair.helix_rad == 0.0:
        rolls = rolls[:, :1]
    crossing, way = lines_of_action(gear, rolls)
    mesh = tooth_mesh(gear, rolls, SIZE)
    # The normal along the contact line stands still in space, so that in the section it turns back by the twist.
    slope = tan(pair.base_helix_rad) / (gear.base_radius_m / gear.module_m)
    twist = slope if which == "gear" else -slope
    body = HelicalBody(mesh, line, twist)
    # Flanks are along τ J x + e_z, so that the normal has this share of the force along z.
    at = mesh.load_points
    axial = -twist * (way[..., 1] * at[..., 0] - way[..., 0] * at[..., 1])
    share = line.load(np.ones_like) / width
    rows = np.arange(rolls.shape[1]) if pair.helix_rad else np.zeros(line.y.size, dtype=int)
    push = nodal_functionals(body.plane, at[0], way[0]).toarray()[rows] * share[:, None]
    pull = body.axial.probes(at[0].T).toarray()[rows] * (share * axial[0][rows])[:, None]
    right = (
        np.ascontiguousarray(push[:, body.free].T)[:, None],
        np.ascontiguousarray(pull[:, body.free_axial].T)[:, None],
    )
    moved, moved_axial = body.solved(right)
    found = []
    for i in range(teeth):
        read = (
            interior_functionals(body.plane, crossing[0], way[0])
            if i == 0
            else nodal_functionals(body.plane, at[i], way[i])
        )
        places = crossing[0] if i == 0 else at[i]
        in_plane = read.toarray()[rows][:, body.free]
        along = (body.axial.probes(places.T).toarray() * axial[i][:, None])[rows][:, body.free_axial]
        deflection = np.einsum("np,pn->n", in_plane, moved[:, 0]) + np.einsum("np,pn->n", along, moved_axial[:, 0])
        found.append([float(width * (share @ deflection))])
    return np.array(found)
