"""How fast the shaft lines of a structure turn when nothing deforms: a walk along its meshes.

Derived: at a mesh with the entries p_a and p_b at the rotations of its gears nothing approaches where
p_a θ_a + p_b θ_b = 0. Rotations count in the running sense of their shaft.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.structure import Structure


def turning_lines(structure: Structure) -> FloatArray:
    """Return (lines, n): each shaft line by itself, as far as it turns per turn of the first one."""
    if structure.line_speeds is not None:
        return _lines(structure, structure.line_speeds)
    turned, speeds = 1.0, [1.0]
    for mesh in structure.meshes:
        driving, driven = mesh.of_turning(structure.coordinates)
        turned *= -driving / driven
        speeds.append(turned)
    return _lines(structure, speeds)


def turning_per_load(structure: Structure) -> FloatArray:
    """Return (n,): how far each rotation turns per turn of the load's line."""
    if structure.line_speeds is not None:
        return rigid_rotation(structure) / structure.line_speeds[-1]
    turned, speeds = 1.0, [1.0]
    for mesh in reversed(structure.meshes):
        driving, driven = mesh.of_turning(structure.coordinates)
        turned *= -driven / driving
        speeds.append(turned)
    return np.asarray(_lines(structure, speeds[::-1]).sum(axis=0))


def rigid_rotation(structure: Structure) -> FloatArray:
    """Return r (n,): how far each coordinate turns per turn of the first shaft line."""
    return np.asarray(turning_lines(structure).sum(axis=0))


def driven_and_loaded(structure: Structure) -> tuple[str, str]:
    """Return the coordinates at which motor and load act."""
    torques = dict(zip(structure.coordinates, structure.torque_vector, strict=True))
    return max(torques, key=lambda name: torques[name]), min(torques, key=lambda name: torques[name])


def without_drift(structure: Structure, forces: FloatArray) -> FloatArray:
    """Return generalised forces (k, n) less what moves the train as a whole, f - M r (rᵀf)/(rᵀMr).

    How the train turns as a whole is prescribed: the drive gives what other forces would take from that.
    """
    rotation = rigid_rotation(structure)
    moved = structure.mass @ rotation
    return np.asarray(forces - np.outer(forces @ rotation, moved) / float(rotation @ moved))


def frame_turns(structure: Structure) -> float:
    """Return the turns of the frame in space per turn of the first shaft line; 0 where it stands still."""
    if not structure.frame:
        return 0.0
    return float(rigid_rotation(structure)[structure.coordinates.index(structure.frame)])


def rolling(structure: Structure) -> FloatArray:
    """Return (n,): how far each coordinate turns per turn of the first shaft line, both against the frame."""
    turning = rigid_rotation(structure)
    if not structure.frame:
        return turning
    # what does not turn in space, such as a ring, turns back against the frame
    against = np.array([name.startswith("theta") for name in structure.coordinates])
    frame = frame_turns(structure)
    return np.asarray((turning - frame * against) / (1.0 - frame))


def _lines(structure: Structure, speeds: Sequence[float]) -> FloatArray:
    of_line = zip(structure.shaft_lines, speeds, strict=True)
    return np.array([[speed * (name in line) for name in structure.coordinates] for line, speed in of_line])
