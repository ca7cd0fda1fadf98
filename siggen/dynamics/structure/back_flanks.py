"""A structure as the back flanks see it: their line of action is the mirror image of the drive flanks' one.

Derived. In a mirror along the centre line rotations change their sign, and shifts and tilts of the gears are reflected
at it. So p, t and the sliding of drive flanks, reflected, are those of back flanks: gears are pushed apart under either
torque. Along their axes helical teeth, which keep their hand, push the other way (`axial_motion`). Positions s' count
from the base tangent point of the gear (`siggen.gears.geometry.back_flanks`), s = T - s'.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.axial_motion import turned_back
from siggen.dynamics.structure.mesh_vectors import Flanks
from siggen.dynamics.structure.structure import Structure

MOVED = ("", "phi_")
"""How names of shifts and of tilts begin, before the axis and the number of the gear."""


def on_back_flanks(structure: Structure, line_m: float, ahead_pitches: float) -> Structure:
    """Return the structure with the vectors of its back flanks.

    Parameters
    ----------
    structure : Structure, with those of its drive flanks
    line_m : float
        Length T of the line of action [m].
    ahead_pitches : float
        See `Flanks`.
    """
    mesh = structure.mesh
    still, turning = (_reflected(structure, vector) for vector in mesh.sliding)
    sliding = np.stack([still + line_m * turning, -turning])
    mirrored = replace(
        mesh,
        vector=_fixed(_back_approach(structure, mesh.vector)),
        sliding=_fixed(sliding),
        tilt=None if mesh.tilt is None else _fixed(_reflected(structure, mesh.tilt)),
        flanks=Flanks(-1.0, ahead_pitches),
    )
    return replace(structure, meshes=(mirrored,))


def _back_approach(structure: Structure, approach: FloatArray) -> FloatArray:
    row = dict(zip(structure.coordinates, _reflected(structure, approach).tolist(), strict=True))
    return np.array(list(turned_back(row).values()))


def _fixed(vector: FloatArray) -> FloatArray:
    vector.setflags(write=False)
    return vector


def _reflected(structure: Structure, vector: FloatArray) -> FloatArray:
    """Return a row of the gears' motions for the motions in the mirror."""
    row = dict(zip(structure.coordinates, vector.tolist(), strict=True))
    found = {name: -value if name.startswith("theta") else value for name, value in row.items()}
    h_x, h_y = structure.mesh.centre_line
    for kind in MOVED:
        for gear in "12":
            x, y = f"{kind}x_{gear}", f"{kind}y_{gear}"
            if x in row:
                along = h_x * row[x] + h_y * row[y]
                found |= {x: 2.0 * h_x * along - row[x], y: 2.0 * h_y * along - row[y]}
    return np.array([found[name] for name in structure.coordinates])
