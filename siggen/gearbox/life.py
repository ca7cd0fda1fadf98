"""The life of one gearbox: its law on its own flanks, when it is looked at, and what it shows then as states.

Everything is drawn for the gearbox by name. So neither other gearboxes nor the schedule change what is true at an age.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from siggen.config import Config, GearsSection, StateSection
from siggen.config.life import FUNCTIONAL_SHARE, JITTER, Life
from siggen.damage.registry import HEALTHY
from siggen.gearbox.drivetrain import drawn_gears
from siggen.gearbox.teeth import gear_pair
from siggen.keys.drawing import draw
from siggen.keys.number import at
from siggen.life.clock import Clock, LoadBlock
from siggen.life.debris import counted_mg
from siggen.life.flank import flanks
from siggen.life.law import LifeCourse, Named, Wearing
from siggen.life.pitting import TORQUE_EXPONENT, PittingCourse
from siggen.names import Names, Side
from siggen.seeding import Stream, named_generator, named_uniforms

Event = Literal["failed", "suspended"]
PHASES = ("no pit", "pitted", "rated")
SEVERITIES: tuple[Literal["healthy", "slight", "severe"], ...] = ("healthy", "slight", "severe")
"""Of the states in these phases."""


@dataclass(frozen=True, slots=True)
class Lived:
    """One gearbox over its life.

    Attributes
    ----------
    course : Course
        Its damage over damage time.
    named : callable
        Its generators by what they draw.
    clock : Clock
        Ages and damage times.
    functional_share : float
        Drawn share of a flank at which it fails.
    ages_h : tuple of float
        Of its inspections, none after what ends them [h].
    observed_h : float
        Age at which it fails or is taken out [h]; of one that outlives the schedule, that of the last inspection.
    event : str
        'failed' or 'suspended'.
    """

    course: LifeCourse
    named: Named
    clock: Clock
    functional_share: float
    ages_h: tuple[float, ...]
    observed_h: float
    event: Event

    def phase(self, time: float) -> str:
        """Return the phase of its life at a damage time."""
        ends = self.course.ends
        return PHASES[(time >= ends.first_pit) + (time >= ends.rated)]

    def debris_mg(self, age_h: float) -> float:
        """Return what a counter in the oil has counted by an age [mg]."""
        return counted_mg(self.course.removed_m3(self.clock.time(age_h)), age_h, self.named)


def lived_states(life: Life, found: Lived, names: Names) -> tuple[StateSection, ...]:
    """Return the inspections of a gearbox as states."""
    return tuple(_state(life, found, number, names) for number in range(len(found.ages_h)))


def _state(life: Life, found: Lived, number: int, names: Names) -> StateSection:
    time = found.clock.time(found.ages_h[number])
    pits = found.course.damage(time)
    damage = None if pits is None else pits.with_gears(lambda side: names.first.gear(Side(side)).word)
    severity = SEVERITIES[PHASES.index(found.phase(time))] if damage is not None else "healthy"
    fault = HEALTHY if damage is None else damage.words[0]
    return StateSection(name=life.name_of(number), fault=fault, severity=severity, damage=damage)


def lived(config: Config, nominal: GearsSection, specimen_id: int) -> Lived:
    """Return the life of a gearbox by its own configuration; `nominal` are the gears that the law's numbers hold for.

    Raises
    ------
    ValueError
        If the gearbox never fails.
    """
    life = config.life
    assert life is not None
    uniform = named_uniforms(config.seed, Stream.LIFE, specimen_id)
    drawn, *_ = drawn_gears(config, specimen_id)
    middle: GearsSection = draw(nominal, lambda _: 0.5, "gears")
    wearing = Wearing(
        flanks(gear_pair(drawn)),
        flanks(gear_pair(middle)),
        lambda name: named_generator(config.seed, Stream.LIFE, specimen_id, name=name),
    )
    point = config.operating_points[0]
    of_point = named_uniforms(config.seed, Stream.OPERATING_POINT, specimen_id, 0)
    steady = at(point.speed_hz, of_point("speed_hz")), at(point.torque_nm, of_point("torque_nm"))
    exponent = at(TORQUE_EXPONENT, uniform("damage.torque_exponent"))
    clock = Clock(_blocks(life, *steady), exponent, at(life.scale, uniform("scale")))
    share = at(FUNCTIONAL_SHARE, uniform("functional_share"))
    course = PittingCourse(exponent, wearing, share)
    ages_h, observed_h, event = _observed(life, uniform, clock.age_h(course.ends.functional))
    return Lived(course, wearing.named, clock, share, ages_h, observed_h, event)


def _blocks(life: Life, speed_hz: float, torque_nm: float) -> tuple[LoadBlock, ...]:
    """Return the blocks of load; without a history that of an operating point all the time."""
    ratio, found = torque_nm / life.reference_torque_nm, []
    for hours, torque, *speed in life.history or ((1.0, 1.0),):
        own = (speed[0], torque / life.reference_torque_nm) if speed else (speed_hz, ratio * torque)
        found.append(LoadBlock(hours, *own))
    return tuple(found)


def _observed(life: Life, uniform: Callable[[str], float], failure_h: float) -> tuple[tuple[float, ...], float, Event]:
    """Return the ages of the inspections, the age at which a gearbox goes, and why."""
    planned = [_age_h(life, number, uniform) for number in range(life.most)]
    removed = uniform("removed") < life.removed_share
    leaves_h = planned[-1] * uniform("removal") if removed else planned[-1]
    ends_h = min(failure_h, leaves_h)
    ages = tuple(age for age in planned if age < failure_h and age <= leaves_h)
    return ages, ends_h, "failed" if failure_h <= leaves_h else "suspended"


def _age_h(life: Life, number: int, uniform: Callable[[str], float]) -> float:
    """Return the planned age of an inspection by its number alone [h]; the first is of the new gearbox."""
    late = JITTER * (uniform(f"inspection/{number}") - 0.5) if number else 0.0
    return life.interval_h * (number + late)
