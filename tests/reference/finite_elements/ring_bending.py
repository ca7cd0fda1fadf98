"""Bending of a gear body along its axis: a ring in three dimensions beside the plate of `siggen.gears.stiffness`.

A plain ring, its bore held, is pushed along the axis on the arc of one root, evenly over the arc and the face, or bent
there by stress along the radius that grows across the face. Read is the mean way of that arc along the axis.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from siggen.gears.stiffness.axial_body import wave_sum
from tests.reference.finite_elements.extruded_body import ExtrudedBody, face_line
from tests.reference.finite_elements.tooth_compliance_fem import nodal_functionals
from tests.reference.finite_elements.tooth_mesh import ToothMesh, meshed

ARC_EDGES = 12


class RingCase(NamedTuple):
    """A ring; lengths over the radius of its rim."""

    ratio: float
    width: float
    half_angle_rad: float


CASES = tuple(
    RingCase(*numbers)
    for numbers in (
        (1.5, 0.3, 0.06),
        (1.5, 0.9, 0.16),
        (2.3, 0.9, 0.16),
        (4.5, 0.15, 0.06),
        (4.5, 0.3, 0.06),
        (4.5, 0.9, 0.06),
    )
)
"""Rim over bore, face width over the radius of the rim, half of the root's arc [rad]."""


def ring_bending_table() -> Iterator[str]:
    """Yield the ways by an axial force and by a moment, plate over solid ring."""
    yield "| rim / bore | width / rim | half arc [rad] | by the force | by the moment |\n|---|---|---|---|---|"
    for case in CASES:
        solid, plate = solid_ring(case), wave_sum(1.0 / case.ratio, case.width, 0.3, case.half_angle_rad)
        force, moment = plate[0, 0] / solid[0], plate[0, 1] / solid[1]
        yield f"| {case.ratio:g} | {case.width:g} | {case.half_angle_rad:g} | {force:.3f} | {moment:.3f} |"


def solid_ring(case: RingCase) -> tuple[float, float]:
    """Return the mean way of the arc along the axis by a unit force there, and by a unit moment, times E b."""
    h = case.half_angle_rad
    step = 2.0 * h / ARC_EDGES
    arc = np.linspace(-h, h, ARC_EDGES + 1)
    rest = [h]
    while rest[-1] < np.pi:
        rest.append(rest[-1] + min(step * 1.15 ** len(rest), 0.1))
    away = h + (np.array(rest[1:-1]) - h) * (np.pi - h) / (rest[-1] - h)
    turns = np.concatenate([arc, away, [np.pi], 2.0 * np.pi - away[::-1]])
    rim = np.column_stack([np.sin(turns), np.cos(turns)])
    around = np.arange(0.0, 2.0 * np.pi, 0.06)
    bore = np.column_stack([np.sin(around), np.cos(around)]) / case.ratio
    points, triangles = meshed((rim, bore))
    line = face_line(case.width, case.width / 10)
    body = ExtrudedBody(ToothMesh(points, triangles, 1.0 / case.ratio, np.zeros((1, 0, 2))), line)
    places = rim[: ARC_EDGES + 1]
    weights = np.ones(arc.size)
    weights[[0, -1]] = 0.5
    weights /= weights.sum()
    along = weights @ body.axial.probes(places.T).toarray()
    out = weights @ nodal_functionals(body.plane, places, places).toarray()
    even, bent = (line.load(q) for q in (lambda y: np.ones_like(y) / case.width, lambda y: _bending(y, case.width)))
    push = np.zeros((body.free.size, 2, line.y.size)), np.zeros((body.free_axial.size, 2, line.y.size))
    push[1][:, 0] = along[body.free_axial][:, None] * even
    push[0][:, 1] = out[body.free][:, None] * bent
    _, axial = body.solved(push)
    ways = np.einsum("p,pkn,n->k", along[body.free_axial], axial, even)
    return float(case.width * ways[0]), float(case.width * ways[1])


def _bending(y: np.ndarray, width: float) -> np.ndarray:
    """Return the stress of the moment of a unit axial force at unit height over the rim."""
    return -12.0 * (np.asarray(y) - 0.5 * width) / width**3
