"""Housings of plates against three-dimensional solid finite elements of the same geometry: five drawn boxes."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from siggen.dynamics.housing.box import SIDES, Axis, Box, Rib, plane_axes
from siggen.dynamics.housing.housing_modes import WAVES, HousingModes, housing_modes
from siggen.dynamics.housing.layout import bosses_meet
from siggen.dynamics.housing.motion import Motion, Place, box_motions, motion_at
from tests.reference.housing.drawn_boxes import drawn_box
from tests.reference.housing.solid_box import SolidBox, seat_row, solid_box, surface_row
from tests.reference.housing.solid_mesh import frames
from tests.reference.housing.third_octaves import DAMPING, bands_db, centres_hz, distance, lines_hz

FIVE = (20, 5)
TEN_MORE = (22, 10)
"""Seed and number of boxes; the ten were looked at after the numbers of functions were settled."""
ELEMENT_M = 0.012
HIGHEST_HZ = 8000.0
FORCES = (("gear", "front", Axis.X), ("gear", "front", Axis.Y), ("pinion", "back", Axis.X), ("pinion", "back", Axis.Y))
SENSORS = (
    ("lid", (0.62, 0.36)), ("lid", (0.2, 0.7)), ("pinion_end", (0.55, 0.6)), ("gear_end", (0.7, 0.4)),
    ("front", (0.9, 0.85)), ("back", (0.45, 0.9)),
)  # fmt: skip
"""Plates and places on them, over their sizes; each looks along the normal."""

HEAD = (
    "box | kg | wall [mm] | within 6 dB | median | 95 % | most | bias [dB] | six lowest modes | seventh | "
    "seats' flexibility | s"
)


def apart_boxes(seed: int, count: int) -> list[Box]:
    """Return the first drawn boxes whose bosses do not meet: the mesh has round bosses only."""
    rng = np.random.default_rng(seed)
    found: list[Box] = []
    while len(found) < count:
        box = drawn_box(rng)
        if not bosses_meet(box):
            found.append(replace(box, ribs=tuple(_shorter(box, rib) for rib in box.ribs)))
    return found


def _shorter(box: Box, rib: Rib) -> Rib:
    """Return a rib that ends below the rings of the mesh."""
    return replace(rib, y_m=(rib.y_m[0], next(iter(frames(box).values())).y[0]))


def solid_table(seed: int = FIVE[0], count: int = FIVE[1]) -> Iterator[str]:
    """Yield rows: third octaves of 50 Hz to 5 kHz at six sensors and four seats under four forces."""
    yield HEAD
    everything = []
    for number, box in enumerate(apart_boxes(seed, count)):
        start = time.process_time()
        modes = housing_modes(box, 1.5 * HIGHEST_HZ)
        solid = solid_box(box, ELEMENT_M, int((modes.frequency_hz < HIGHEST_HZ).sum()) + 8)
        plates, solids = both_levels(box, modes, solid)
        everything.append((plates, solids))
        lowest, seventh = np.split(100.0 * (modes.frequency_hz[:7] / solid.frequency_hz[:7] - 1.0), [6])
        seats = elastic_ratios(box, modes, solid)
        yield " | ".join(
            (
                f"{number} | {solid.mass_kg:.1f} ({box.mass_kg:.1f})",
                f"{1e3 * box.thickness.walls_m:.1f}",
                distance(plates, solids).text,
                f"{lowest.min():+.1f} to {lowest.max():+.1f} %",
                f"{seventh[0]:+.1f} %",
                f"{seats.min():.2f} to {seats.max():.2f}",
                f"{time.process_time() - start:.0f}",
            )
        )
    plates, solids = (np.concatenate([pair[side].ravel() for pair in everything]) for side in (0, 1))
    yield f"all | | | {distance(plates, solids).text} | | | |"


def ten_more_table() -> Iterator[str]:
    """Yield the same rows of ten other boxes."""
    yield from solid_table(*TEN_MORE)


def both_levels(box: Box, modes: HousingModes, solid: SolidBox) -> tuple[np.ndarray, np.ndarray]:
    """Return third octaves (outputs, inputs, bands) [dB] of plates and of solid elements."""
    frequency = lines_hz(centres_hz(50.0, 5000.0))
    inputs, rows = _forces(box, modes, solid)
    sensors = [_sensor(box, modes, solid, plate, shares) for plate, shares in SENSORS]
    outputs = [motion for motion, _ in sensors] + inputs
    damping = np.full(modes.frequency_hz.size, DAMPING)
    plates = modes.accelerance(outputs, inputs, frequency, damping)
    solids = solid.accelerance([row for _, row in sensors] + rows, rows, frequency, DAMPING)
    return bands_db(plates), bands_db(solids)


def elastic_ratios(box: Box, modes: HousingModes, solid: SolidBox) -> np.ndarray:
    """Return what each seat gives way beyond the six lowest modes under its own force, plates over solid elements."""
    inputs, rows = _forces(box, modes, solid)
    static = np.array([row @ solid.solve(row) for row in rows])
    of_modes = ((np.array(rows) @ solid.shapes[:, :6]) ** 2 / solid.omega_squared[:6]).sum(axis=1)
    return np.diag(modes.flexibility_beyond(6, inputs, inputs)) / (static - of_modes)


def _forces(box: Box, modes: HousingModes, solid: SolidBox) -> tuple[list[Motion], list[np.ndarray]]:
    motions = box_motions(box, modes.halves)
    own = [motions[f"{shaft}/{wall}/{axis.name.lower()}"] for shaft, wall, axis in FORCES]
    return own, [seat_row(solid.mesh, box, box.seats[shaft], wall, axis) for shaft, wall, axis in FORCES]


def _sensor(
    box: Box, modes: HousingModes, solid: SolidBox, plate: str, shares: tuple[float, float]
) -> tuple[Motion, np.ndarray]:
    """Return a sensor on the outer surface: where the next node of the mesh stands, for both."""
    normal, end = SIDES[plate]
    axes = plane_axes(normal)
    place = np.zeros(3)
    for axis, share in zip(axes, shares, strict=True):
        place[axis] = share * box.size_m[axis]
    place[normal] = end * box.size_m[normal] + (end - 0.5) * box.thickness.of(plate)
    row, at = surface_row(solid.mesh, (place[0], place[1], place[2]), normal)
    first, second = (float(np.clip(at[axis], 0.0, box.size_m[axis])) for axis in axes)
    return motion_at(modes.halves, Place(plate, first, second, normal)), row


def refinement_table() -> Iterator[str]:
    """Yield rows: the same plates with more and finer waves against twice as many, same boxes."""
    yield "waves | within 6 dB | median | 95 % | most | bias [dB]"
    frequency = lines_hz(centres_hz(50.0, 5000.0))
    levels: dict[float, list[np.ndarray]] = {}
    for waves in (WAVES, 1.4 * WAVES, 2.0 * WAVES):
        levels[waves] = [
            refinement_levels(box, housing_modes(box, 1.5 * HIGHEST_HZ, waves), frequency) for box in apart_boxes(*FIVE)
        ]
    for waves in list(levels)[:-1]:
        one, other = (np.concatenate([found.ravel() for found in levels[w]]) for w in (waves, 2.0 * WAVES))
        yield f"{waves:.1f} | {distance(one, other).text}"


def refinement_levels(box: Box, modes: HousingModes, frequency_hz: np.ndarray) -> np.ndarray:
    """Return third octaves at all sensors and seats under all forces."""
    motions = box_motions(box, modes.halves)
    inputs = [motions[f"{shaft}/{wall}/{axis.name.lower()}"] for shaft, wall, axis in FORCES]
    outputs = [*sensors(box, modes), *inputs]
    return bands_db(modes.accelerance(outputs, inputs, frequency_hz, np.full(modes.frequency_hz.size, DAMPING)))


def sensors(box: Box, modes: HousingModes) -> list[Motion]:
    """Return the sensors' motions at their shares of the plates."""
    found = []
    for plate, shares in SENSORS:
        first, second = (s * box.size_m[axis] for s, axis in zip(shares, plane_axes(SIDES[plate][0]), strict=True))
        found.append(motion_at(modes.halves, Place(plate, first, second, SIDES[plate][0])))
    return found
