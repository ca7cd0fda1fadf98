"""Table of cracks that fall from one end of the face: slices on springs beside finite elements in three dimensions.

The slices take the compliances of the sound tooth and of the crack through the whole face from the finite elements, so
that what the run across the face does is compared. `added`: to the mean deflection under an even load; `tilt`: mean of
the deflection times cos(π y/b) under it; `rigid`: added where the flank sinks evenly, and the centre of the load then,
from the middle of the face to the sound side, over the face.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import radians

import numpy as np

from siggen.gears.contact.tooth_kernel import tooth_matrix, unit_tooth
from siggen.gears.contact.uneven_teeth import UnevenTeeth
from siggen.gears.damage.crack_law import unit_compliance
from siggen.gears.geometry.spur_gear import SpurGear
from siggen.gears.stiffness.body_coupling import ring_torsion
from tests.reference.finite_elements.face_kernel import rule_length
from tests.reference.finite_elements.part_crack import part_crack
from tests.reference.finite_elements.spatial_pair import bench_pair

WIDTH, MODES, SLICES = 20 / 3, 4, 100
"""Face width in modules, cosines across the face, slices."""
RUNS = (0.25, 0.5, 0.75, 1.0)
CRACKS = ((0.25, 45), (0.4, 60))


def depth_at(deepest: float, run: float, y: np.ndarray) -> np.ndarray:
    """Return the depth share (n,) at places y/b, falling from `deepest` to 0 at `run`."""
    return np.asarray(deepest * np.sqrt(np.maximum(1.0 - y / run, 0.0)))


def slice_modes(sound: float, twist: float, added: np.ndarray) -> np.ndarray:
    """Return the compliance in cosines (MODES, MODES) of slices with what a crack adds (n,), times E b."""
    y = (np.arange(added.size) + 0.5) / added.size
    teeth = UnevenTeeth(np.array([[sound - twist], [0.0]]), np.stack([added, 0.0 * added])[:, None])
    matrix = tooth_matrix(teeth.kernel(unit_tooth(added.size, WIDTH, rule_length(WIDTH)), 0, 1.0, 1.0))
    waves = np.cos(np.pi * np.arange(MODES)[:, None] * y)
    found = waves @ matrix @ waves.T / added.size
    found[0, 0] += twist
    return np.asarray(found)


def evenly_sunk(modes: np.ndarray) -> tuple[float, float]:
    """Return the compliance of a flank that sinks evenly, and the load's centre over the face, towards its last end."""
    load = np.linalg.solve(0.5 * (modes + modes.T), np.eye(MODES)[0])
    return float(1.0 / load[0]), float(np.sum(load[1::2] * -2.0 / (np.pi * np.arange(1, MODES, 2)) ** 2) / load[0])


def _columns(modes: np.ndarray, sound: np.ndarray) -> tuple[float, ...]:
    sunk, centre = evenly_sunk(modes)
    tilt = 0.5 * (modes[0, 1] + modes[1, 0])
    return float(modes[0, 0] - sound[0, 0]), float(tilt), sunk - evenly_sunk(sound)[0], centre


def _rows(gear: SpurGear, roll: np.ndarray, deepest: float, angle_deg: float) -> Iterator[str]:
    angle, twist = radians(angle_deg), ring_torsion(gear, 0.3)
    sound = part_crack(gear, roll, WIDTH, deepest, angle, None, modes=MODES).modes[0]
    whole = part_crack(gear, roll, WIDTH, deepest, angle, lambda y: deepest + 0.0 * y, modes=MODES).modes[0]
    most, y = whole[0, 0] - sound[0, 0], (np.arange(SLICES) + 0.5) / SLICES
    law = [float(unit_compliance(gear, roll, share, angle)[0]) for share in depth_at(deepest, 1.0, y).tolist()]
    scale = most / float(unit_compliance(gear, roll, deepest, angle)[0])
    yield f"| {gear.teeth}, {deepest}, {angle_deg} | whole | {most:.2f} of {sound[0, 0]:.2f} | | | |"
    plain = slice_modes(float(sound[0, 0]), twist, np.zeros(SLICES))
    for run in RUNS:
        added = scale * np.interp(y / run, y, law, right=0.0)
        depth = lambda place, run=run: depth_at(deepest, run, place)  # noqa: E731
        found = part_crack(gear, roll, WIDTH, deepest, angle, depth, modes=MODES).modes[0]
        own = _columns(slice_modes(float(sound[0, 0]), twist, added), plain)
        pairs = zip(own, _columns(found, sound), strict=True)
        yield (
            f"| {gear.teeth}, {deepest}, {angle_deg} | {run} | "
            + " | ".join(f"{a:.3f}, {b:.3f}" for a, b in pairs)
            + " |"
        )


def part_crack_table() -> Iterator[str]:
    """Lines of what a crack over a part of the face adds, slices and finite elements (times E b); five minutes."""
    pair = bench_pair()
    yield "| z, depth share, angle [deg] | run over the face | added | tilt | rigid, added | rigid, centre |"
    yield "|---" * 6 + "|"
    for gear, (low, high) in zip((pair.pinion, pair.gear), pair.active_flank, strict=True):
        for deepest, angle_deg in CRACKS:
            yield from _rows(gear, np.array([0.5 * (low + high)]), deepest, angle_deg)
