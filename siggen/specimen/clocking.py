"""How the teeth of further meshes stand to those in front: drawn with the gearbox, or by the geometry of an idler."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import floor, pi, radians

from siggen.gears.geometry.gear_pair import GearPair
from siggen.gears.geometry.idler import idler_ahead_pitches
from siggen.keys.number import constant
from siggen.planning.specimen import Specimen


def clocked_pitches(pairs: Sequence[GearPair], specimen: Specimen, uniform: Callable[[str], float]) -> Iterator[float]:
    """Yield the base pitches that each further mesh has turned where the first one has turned none.

    `pairs` are those of all meshes. Which tooth of the gear behind an idler is called 0 is drawn.
    """
    turned, directions = 0.0, [0.0, *(radians(constant(stage.direction_deg)) for stage in specimen.stages)]
    for number, (front, own) in enumerate(pairwise(pairs)):
        stage = specimen.stages[number]
        drawn = uniform(f"stages.{stage.name}.clocking")
        if stage.idler:
            # the first shaft turns forwards, every next one the other way
            sense = 1.0 if number % 2 else -1.0
            between_rad = sense * (pi + directions[number] - directions[number + 1])
            turned += idler_ahead_pitches(front, own, between_rad)
            turned += own.pinion.teeth * floor(drawn * own.gear.teeth)
        else:
            turned = drawn * own.pinion.teeth * own.gear.teeth
        yield turned
