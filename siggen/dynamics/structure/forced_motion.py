"""ForcedMotion: what small external forces do to a gear stage in mesh, as responses in frequency.

Derived. With the mean stiffness k and damping c of the mesh, the small motion obeys
(K + k p pᵀ + iω (C + c p pᵀ) - ω² M) q = d F. Solved at every frequency by elimination with pivoting, in own code: the
last bits of a library's would depend on its number of threads. What it leaves out: the stiffness changes over a pitch,
and a force that takes teeth out of contact; both matter for forces that are not small against the mesh force.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from siggen.arrays import ComplexArray, FloatArray
from siggen.dynamics.structure.forced_responses import forced_responses
from siggen.dynamics.structure.structure import Structure


@dataclass(frozen=True, slots=True)
class MeanMesh:
    """The mesh as a constant spring and damper along the line of action [N/m, N s/m]."""

    stiffness_n_per_m: float
    damping_n_s_per_m: float


@dataclass(frozen=True, slots=True)
class ForcedMotion:
    """Responses (inputs, k): place/axis -> acceleration [m/s² per N], and -> force on the housing [N per N].

    `shaft` are those of `Structure.shaft_readings`.
    """

    acceleration: Mapping[str, ComplexArray]
    bearing_force: Mapping[str, ComplexArray]
    shaft: Mapping[str, ComplexArray]


def forced_motion(
    structure: Structure,
    mesh: MeanMesh | Sequence[MeanMesh],
    directions: FloatArray,
    motions: tuple[str, ...],
    frequency_hz: FloatArray,
    readings: tuple[str, ...] = (),
) -> ForcedMotion:
    """Return the responses to inputs along generalised forces (inputs, n) at frequencies (k,).

    Parameters
    ----------
    structure : Structure; one that turns freely has no response at frequency 0
    mesh : MeanMesh, or one for each mesh of the structure
    directions : (inputs, n)
    motions : names of `structure.motions` that are wanted
    frequency_hz : (k,)
    readings : names of `structure.shaft_readings` that are wanted
    """
    stiffness, damping = structure.stiffness, structure.damping
    means = (mesh,) if isinstance(mesh, MeanMesh) else mesh
    for p, mean in zip((one.vector for one in structure.meshes), means, strict=True):
        stiffness = stiffness + mean.stiffness_n_per_m * p[:, None] * p[None, :]
        damping = damping + mean.damping_n_s_per_m * p[:, None] * p[None, :]
    bearings = structure.bearing_forces
    zero = np.zeros(len(structure.coordinates))
    rows = [(zero, zero, structure.motions[name]) for name in motions]
    rows += [(k, c, zero) for k, c in bearings.values()]
    of_shafts = structure.shaft_readings
    rows += [(*of_shafts[name], zero) for name in readings]
    found = forced_responses(
        np.ascontiguousarray(structure.mass),
        np.ascontiguousarray(damping),
        np.ascontiguousarray(stiffness),
        np.ascontiguousarray(directions),
        np.array(rows).reshape(len(rows), 3, len(structure.coordinates)),
        2.0 * np.pi * frequency_hz,
    )
    # a bearing's motion and its force bear the same name
    first, end = len(motions), len(motions) + len(bearings)
    return ForcedMotion(
        dict(zip(motions, found[:first], strict=True)),
        dict(zip(bearings, found[first:end], strict=True)),
        dict(zip(readings, found[end:], strict=True)),
    )
