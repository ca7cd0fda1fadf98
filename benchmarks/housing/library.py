"""What a library of housings would cost: the nearest of many stored boxes in place of the box itself.

Stored boxes are scaled exactly (length, material); all other ratios of the nearest one are what they are.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.housing.drawn_boxes import drawn_box
from benchmarks.housing.solid_comparison import FORCES, sensors
from benchmarks.housing.third_octaves import DAMPING, bands_db, centres_hz, distance, lines_hz
from siggen.dynamics.housing.box import Box
from siggen.dynamics.housing.housing_modes import housing_modes
from siggen.dynamics.housing.motion import box_motions

STORED = (30, 120, 480)
"""120 boxes with 120 modes at 220 places are 3 MB of one byte each, 60 of two bytes."""
USERS = 24


def library_table() -> Iterator[str]:
    """Yield rows: third octaves of a user's box by the nearest of a library, 50 Hz to 5 kHz."""
    rng = np.random.default_rng(100)
    users = [drawn_box(rng) for _ in range(USERS)]
    own = [levels(box, 1.0, 1.0) for box in users]
    stored = [drawn_box(np.random.default_rng([7, n])) for n in range(max(STORED))]
    yield "stored boxes | within 6 dB | median | 95 % | most | bias [dB]"
    for count in STORED:
        found = [_from_library(box, stored[:count]) for box in users]
        yield f"{count} | {distance(np.array(found), np.array(own)).text}"


def _from_library(box: Box, stored: list[Box]) -> np.ndarray:
    """Return levels of the nearest stored box, scaled to the size and the material of a box."""
    ratios = np.array([_ratios(one) for one in stored])
    spread = ratios.std(axis=0) + 1e-9
    nearest = stored[int((((ratios - _ratios(box)) / spread) ** 2).sum(axis=1).argmin())]
    size = np.prod(np.array(box.size_m) / np.array(nearest.size_m)) ** (1.0 / 3.0)
    speed = np.sqrt(_stiffness(box) / _stiffness(nearest))
    density = box.material.density_kg_m3 / nearest.material.density_kg_m3
    return levels(nearest, float(speed / size), float(1.0 / (density * size**3)))


def levels(box: Box, frequency_ratio: float, mobility_ratio: float) -> np.ndarray:
    """Return third octaves of a box whose frequencies and squared shapes are multiplied by these ratios."""
    modes = housing_modes(box, 10_000.0 / min(1.0, frequency_ratio))
    motions = box_motions(box, modes.halves)
    inputs = [motions[f"{shaft}/{wall}/{axis.name.lower()}"] for shaft, wall, axis in FORCES]
    frequency = lines_hz(centres_hz(50.0, 5000.0)) / frequency_ratio
    damping = np.full(modes.frequency_hz.size, DAMPING)
    found = modes.accelerance([*sensors(box, modes), *inputs], inputs, frequency, damping)
    return bands_db(mobility_ratio * found)


def _stiffness(box: Box) -> float:
    return box.material.youngs_modulus_pa / box.material.density_kg_m3


def _ratios(box: Box) -> np.ndarray:
    """Return what a choice can go by, in logarithms."""
    length, height, width = box.size_m
    gear, pinion = box.seats["gear"], box.seats["pinion"]
    wall = box.thickness.walls_m
    bolt = box.bolts[0]
    return np.log(
        [
            height / length, width / length, wall / length, box.thickness.lid_m / wall, box.thickness.floor_m / wall,
            gear.x_m / length, gear.boss_radius_m / length, pinion.boss_radius_m / length,
            gear.boss_thickness_m / wall, bolt.x_m / length, bolt.z_m / width,
            bolt.stiffness_n_per_m[1] / (box.material.youngs_modulus_pa * length), 1.0 + len(box.ribs),
        ]
    )  # fmt: skip
