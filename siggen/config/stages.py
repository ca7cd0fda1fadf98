"""Further meshes behind the first one, in the order of power: what the sections of a machine say of each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from siggen.config.dynamics import RotorSection
from siggen.config.gears import Pair
from siggen.config.machine import IDLER, Direction, Span
from siggen.keys.section import Section


class Stage(Section):
    """One further mesh: its pinion stands on the shaft of the gear in front or is that, its gear on a shaft of its own.

    Both gears on one shaft stand at a third and at two thirds between its bearings, which are those of the gear in
    front. The last gear drives the load. `gear` is its gear with that gear's shaft; its pinion is a solid steel disc.
    """

    name: str
    gears: Pair
    gear: RotorSection
    span_mm: Span
    direction_deg: Direction

    @property
    def idler(self) -> bool:
        """Whether its pinion is the gear in front itself."""
        return self.span_mm == IDLER


OF_BOTH_MESHES = (
    "module_mm", "pressure_angle_deg", "youngs_modulus_gpa",
)  # fmt: skip
"""Numbers of a gear that the section of its mesh holds; both meshes of an idler have them alike."""


def with_idlers(gears: Pair, stages: Iterable[Stage]) -> Iterator[Stage]:
    """Yield drawn stages; one whose pinion is the gear in front has the numbers that were drawn for that."""
    front = gears
    for stage in stages:
        pair = stage.gears
        if stage.idler:
            alike = {key: getattr(front, key) for key in OF_BOTH_MESHES}
            pair = pair.model_copy(update={**alike, "pinion": front.gear})
        front = pair
        yield stage.model_copy(update={"gears": pair}) if stage.idler else stage


def turned_teeth(gears: Pair, stages: tuple[Stage, ...]) -> tuple[Fraction, ...]:
    """Return the teeth of every further stage that mesh per turn of the first pinion."""
    return tuple(turns * stage.gears.pinion.teeth for turns, stage in zip(turned(gears, stages), stages, strict=False))


def turned(gears: Pair, stages: tuple[Stage, ...]) -> Iterator[Fraction]:
    """Yield the turns of each shaft behind the first one, per turn of that."""
    turns = Fraction(1)
    for pair in (gears, *(stage.gears for stage in stages)):
        turns *= Fraction(pair.pinion.teeth, pair.gear.teeth)
        yield turns


def shaft_orders(ratio: Fraction, stages: tuple[Stage, ...]) -> list[float]:
    """Return the turns of every shaft per turn of the first one, whose gear turns the second one by `ratio`."""
    orders = [Fraction(1), ratio]
    for stage in stages:
        orders.append(orders[-1] * Fraction(stage.gears.pinion.teeth, stage.gears.gear.teeth))
    return [float(order) for order in orders]
