"""What a load on one tooth does to its neighbour across the face: how far from rigid the coupling of neighbours is.

`stiffness.coupling: body` moves the neighbour alike at every place of the face, by the total load alone. Here two teeth
stand on the extruded ring (`extruded_body`); one is loaded along its contact line, the other is read at its contact
itself, where nothing is singular without its own load (`neighbour_compliance`).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from siggen.gears.geometry.gear_pair import SpurGear
from tests.reference.finite_elements.extruded_body import ExtrudedBody, face_line
from tests.reference.finite_elements.face_compliance import ELEMENT, SIZE, load_on, tilt_load
from tests.reference.finite_elements.face_losses import bench_pair
from tests.reference.finite_elements.tooth_compliance_fem import (
    interior_functionals,
    lines_of_action,
    nodal_functionals,
)
from tests.reference.finite_elements.tooth_mesh import tooth_mesh

MODES = 6
MIDDLE = 0.5
"""Place in the double contact."""
LOADS = {"even": load_on(0.0, 1.0, MODES), "30 % at one end": load_on(0.0, 0.3, MODES)}


def neighbour_face(gear: SpurGear, roll: float, width: float, size: float = SIZE) -> tuple[np.ndarray, np.ndarray]:
    """Return compliances of the loaded tooth and of its neighbour, times E b, between cosines of the face.

    Parameters
    ----------
    gear : SpurGear
        The gear.
    roll : float
        Roll angle of the loaded line [rad]; that of the neighbour lies one pitch higher.
    width : float
        Face width in modules.
    size : float
        Edge length on the teeth, in modules.

    Returns
    -------
    own, cross : (n, n) arrays
        Entry (i, j): mean over the face of cos(i π y/b) u(y) under the load cos(j π y/b)/b.
    """
    rolls = np.array([[roll], [roll + 2 * np.pi / gear.teeth]])
    crossing, way = lines_of_action(gear, rolls)
    mesh = tooth_mesh(gear, rolls, size)
    body = ExtrudedBody(mesh, face_line(width, ELEMENT))
    push = nodal_functionals(body.plane, mesh.load_points[0], way[0]).toarray().T
    reads = (
        interior_functionals(body.plane, crossing[0], way[0]),
        nodal_functionals(body.plane, mesh.load_points[1], way[1]),
    )
    loads = np.column_stack(
        [body.line.load(lambda y, n=n: np.cos(n * np.pi * y / width) / width) for n in range(MODES)]
    )
    answer = body.displacements(np.repeat(push, MODES, axis=1), loads)
    flat = answer.reshape(answer.shape[0], -1)
    own, cross = (width * loads.T @ np.asarray(read @ flat).reshape(MODES, -1).T for read in reads)
    return own, cross


def neighbour_face_table() -> Iterator[str]:
    """Lines of how the neighbour moves across the face: ends over mean, and its tilt over that of the loaded tooth."""
    pair = bench_pair()
    width = pair.face_width_m / pair.pinion.module_m
    heads = (
        "mean, neighbour / loaded tooth",
        "neighbour: one end, middle, other end / mean",
        "tilt, neighbour / loaded",
    )
    yield f"| z | load | {' | '.join(heads)} |"
    yield "|---|---|---|---|---|"
    places = np.cos(np.pi * np.arange(MODES) * np.array([[0.0], [0.5], [1.0]])) * np.where(np.arange(MODES), 2.0, 1.0)
    for gear, (first, last) in zip((pair.pinion, pair.gear), pair.active_flank, strict=True):
        room = last - 2 * np.pi / gear.teeth - first
        own, cross = neighbour_face(gear, first + MIDDLE * room, width)
        for name, load in LOADS.items():
            moved = cross @ load
            along = places @ moved / moved[0]
            tilts = tilt_load(MODES) @ moved, tilt_load(MODES) @ own @ load
            tilt = f"{tilts[0] / tilts[1]:.3f}" if name != "even" else ""
            shape = ", ".join(f"{x:.3f}" for x in along)
            yield f"| {gear.teeth} | {name} | {moved[0] / (own @ load)[0]:.3f} | {shape} | {tilt} |"
