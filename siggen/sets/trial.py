"""A trial of a configuration: a short record of every state of some gearboxes, and which share of them is lost.

A record is lost where the motion leaves the model. It does so within the first turns: of three machines with 8
gearboxes each, records of 8 and of 60 turns lost the same number in all 15 states, 0 to 5 of 8.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, sqrt
from typing import TYPE_CHECKING

from siggen.columns.record import RecordFailure, non_finite
from siggen.planning.plan import record_ids_of
from siggen.sets import physics as contents

if TYPE_CHECKING:
    from siggen.columns.record import SimulatedRecord
    from siggen.config import Config

GEARBOXES, RECORDS = 10, 50
"""That are tried unless told otherwise: as many gearboxes as make so many records, at least two."""
TURNS = 8
"""Of the slower shaft that carries damage."""
NORMAL_95 = 1.96


@dataclass(frozen=True, slots=True)
class StateTrial:
    """What a trial found of one state: gearboxes tried, those that lost their record, and why the first one did."""

    state: str
    tried: int
    lost: int
    reason: str = ""

    @property
    def share(self) -> float:
        """Share of the records that is lost."""
        return self.lost / self.tried

    @property
    def interval(self) -> tuple[float, float]:
        """Where the share of all gearboxes lies with 95 % (Wilson's interval)."""
        n, z2 = self.tried, NORMAL_95**2
        middle = (self.share + 0.5 * z2 / n) / (1.0 + z2 / n)
        half = NORMAL_95 * sqrt(self.share * (1.0 - self.share) / n + 0.25 * z2 / n**2) / (1.0 + z2 / n)
        return max(middle - half, 0.0), min(middle + half, 1.0)


def default_gearboxes(config: Config) -> int:
    """Return how many gearboxes are tried: none where gears cannot tilt, which is what records are lost by."""
    if config.dynamics.shafts is None:
        return 0
    return min(GEARBOXES, max(2, RECORDS // config.state_count), config.specimens)


def trial(config: Config, gearboxes: int, progress: Callable[[int, int], None] | None = None) -> tuple[StateTrial, ...]:
    """Return what short records of the first gearboxes of a set lose, by state.

    Parameters
    ----------
    config : Config
    gearboxes : int
        At most as many as the set has; with several operating points each gearbox runs at one of them in turn.
    progress : callable, optional
        Called with (records done, records of the trial).
    """
    short, tried = shortened(config), min(gearboxes, config.specimens)
    found: dict[str, list[SimulatedRecord | RecordFailure]] = {name: [] for name in config.state_names}
    total = tried * len(found)
    for specimen in range(tried):
        if progress is not None:
            progress(specimen * len(found), total)
        results = contents.physics().simulate(short, _record_ids(short, specimen))
        for name, result in zip(found, results, strict=False):  # a gearbox may fail before its last inspection
            found[name].append(result)
    return tuple(_state_trial(name, results) for name, results in found.items() if results)


def shortened(config: Config) -> Config:
    """Return a configuration whose records are short and hold no internal quantities."""
    from siggen.keys.number import bounds

    slowest_hz = min(abs(bound) for point in config.operating_points for bound in bounds(point.speed_hz))
    on_gear = any(getattr(one, "gear", "pinion") != "pinion" for one in config.damages)
    ratio = config.gears.gear.teeth / config.gears.pinion.teeth if on_gear else 1.0
    wanted_s = TURNS * ratio / max(slowest_hz, TURNS / config.duration_s)
    duration_s = min(ceil(wanted_s * config.fs_hz) / config.fs_hz, config.duration_s)
    return config.model_copy(update={"duration_s": duration_s, "internals": None})


def _record_ids(config: Config, specimen: int) -> Sequence[int]:
    """Return one record of every state, all at one operating point."""
    each = len(config.operating_points) * config.repeats
    point = specimen % len(config.operating_points)
    return record_ids_of(config, specimen)[point * config.repeats :: each]


def _state_trial(name: str, results: Sequence[SimulatedRecord | RecordFailure]) -> StateTrial:
    reasons = [reason for result in results if (reason := _lost(result))]
    return StateTrial(name, len(results), len(reasons), reasons[0] if reasons else "")


def _lost(result: SimulatedRecord | RecordFailure) -> str:
    if isinstance(result, RecordFailure):
        return f"{result.status} ({result.reason})"
    return non_finite(result) or ""
