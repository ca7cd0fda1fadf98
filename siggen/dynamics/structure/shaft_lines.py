"""How the shafts of a structure turn when nothing deforms. Rotations count in the running sense of their shaft."""

from __future__ import annotations

import numpy as np

from siggen.arrays import FloatArray
from siggen.dynamics.structure.drivetrain import ROUND
from siggen.dynamics.structure.structure import Structure


def rigid_rotation(structure: Structure) -> FloatArray:
    """Return r (n,): how far each coordinate turns per turn of the driver."""
    return np.asarray(structure.lines.sum(axis=0))


def driven_and_loaded(structure: Structure) -> tuple[str, str]:
    """Return the coordinates at which motor and load act."""
    machine = structure.drivetrain
    return f"{ROUND}_{machine.driver}", f"{ROUND}_{machine.load}"


def without_drift(structure: Structure, forces: FloatArray) -> FloatArray:
    """Return generalised forces (k, n) less what moves the train as a whole, f - M r (rᵀf)/(rᵀMr).

    How the train turns as a whole is prescribed: the drive gives what other forces would take from that.
    """
    rotation = rigid_rotation(structure)
    moved = structure.mass @ rotation
    return np.asarray(forces - np.outer(forces @ rotation, moved) / float(rotation @ moved))


def frame_turns(structure: Structure) -> float:
    """Return the turns of the frame in space per turn of the driver; 0 where it stands still."""
    if not structure.frame:
        return 0.0
    return float(rigid_rotation(structure)[structure.coordinates.index(structure.frame)])


def rolling(structure: Structure) -> FloatArray:
    """Return (n,): how far each coordinate turns per turn of the driver, both against the frame."""
    turning = rigid_rotation(structure)
    if not structure.frame:
        return turning
    # what does not turn in space, such as a ring, turns back against the frame
    against = np.array([name.startswith("theta") for name in structure.coordinates])
    frame = frame_turns(structure)
    return np.asarray((turning - frame * against) / (1.0 - frame))
