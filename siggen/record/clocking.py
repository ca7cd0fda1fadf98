"""How the teeth of further meshes stand to those in front: drawn with the gearbox, or by the geometry of an idler."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import floor, pi

from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair, idler_ahead_pitches


def clocked_pitches(pairs: Sequence[GearPair], specimen: Specimen, uniform: Callable[[str], float]) -> Iterator[float]:
    """Yield the base pitches that each further mesh has turned where the first one has turned none.

    `pairs` are those of all meshes. Which tooth of the gear behind an idler is called 0 is drawn.
    """
    turned = 0.0
    for number, (front, own) in enumerate(pairwise(pairs)):
        before, mesh = specimen.meshes[number : number + 2]
        drawn = uniform(f"machine.meshes.{mesh.inner}.clocking")
        if mesh.idler:
            # the first shaft turns forwards, every next one the other way
            sense = 1.0 if number % 2 else -1.0
            between_rad = sense * (pi + before.direction_rad - mesh.direction_rad)
            turned += idler_ahead_pitches(front, own, between_rad)
            turned += own.pinion.teeth * floor(drawn * own.gear.teeth)
        else:
            turned = drawn * own.pinion.teeth * own.gear.teeth
        yield turned
