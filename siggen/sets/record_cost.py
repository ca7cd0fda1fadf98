"""CPU time of a set of lives, by proportion from a few records of one gearbox."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Any

from siggen.planning.gearbox import gearbox_life
from siggen.planning.plan import record_ids_of
from siggen.sets import physics as contents
from siggen.sets.trial import shortened

if TYPE_CHECKING:
    from siggen.config import Config

LONGER_S = 2.0
"""By which a record is longer that tells what a second of signal costs."""
LOOKED_THROUGH = 20
"""Gearboxes, at most, among which one is sought that shows both whole and pitted teeth."""


@dataclass(frozen=True, slots=True)
class LifeCost:
    """CPU seconds on this machine.

    Attributes
    ----------
    gearbox_s : float
        Of a gearbox: its gears, its housing, the tables of its life.
    record_s : float
        Of a record, without its signal.
    damage_s : float
        Of tables for teeth that no earlier record had, in the middle of a pitted life.
    signal_s : float
        Of a second of signal.
    """

    gearbox_s: float
    record_s: float
    damage_s: float
    signal_s: float

    def hours(self, gearboxes: int, records: int, pitted: int, duration_s: float) -> float:
        """Return the CPU hours of a set of which so many inspections see a pitted tooth."""
        of_records = records * (self.record_s + duration_s * self.signal_s) + pitted * self.damage_s
        return (gearboxes * self.gearbox_s + of_records) / 3600.0


def life_cost(config: Config) -> LifeCost:
    """Return what records of one gearbox cost, behind a trial that has loaded what they need."""
    specimen, pitted = _tried(config)
    each = len(config.operating_points) * config.repeats
    ids = record_ids_of(config, specimen)[::each]
    first, whole, damaged = ids[0], ids[: max(1, min(2, pitted))], ids[pitted]
    short = shortened(config)
    longer = _lasting(short, min(short.duration_s + LONGER_S, config.duration_s))
    physics = contents.physics()

    def cost_s(of: Config, *records: int) -> float:
        return _cpu_s(lambda: list(physics.simulate(of, sorted(set(records)))))

    once, both, with_damage = cost_s(short, first), cost_s(short, *whole), cost_s(short, first, damaged)
    longer_by_s = longer.duration_s - short.duration_s
    signal_s = max((cost_s(longer, first) - once) / longer_by_s, 0.0) if longer_by_s > 0.0 else 0.0
    record_s = max(both - once - short.duration_s * signal_s, 0.0)
    own_s = max(once - record_s - short.duration_s * signal_s, 0.0)
    tables_s = _cpu_s(lambda: physics.life_rows(config, specimen))
    return LifeCost(own_s + tables_s, record_s, max(with_damage - both, 0.0), signal_s)


def _lasting(config: Config, duration_s: float) -> Config:
    return config.model_copy(update={"duration_s": ceil(duration_s * config.fs_hz) / config.fs_hz})


def _tried(config: Config) -> tuple[int, int]:
    """Return a gearbox and an inspection in the middle of its pitted ones; of gearboxes without, their last."""
    for specimen in range(min(config.specimens, LOOKED_THROUGH)):
        found = gearbox_life(config, specimen)
        pitted = [k for k, age in enumerate(found.ages_h) if found.clock.time(age) >= found.course.ends.first_pit]
        if pitted and pitted[0] > 1:
            return specimen, pitted[len(pitted) // 2]
    return 0, len(gearbox_life(config, 0).ages_h) - 1


def _cpu_s(work: Callable[[], Any]) -> float:
    begun_s = time.process_time()
    work()
    return time.process_time() - begun_s
