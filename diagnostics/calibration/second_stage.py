"""SecondStage: another pair of gears on one of the shafts, where its lines stand out of the errors of the teeth.

A stage of Z teeth on a shaft has its lines at Z, 2 Z, 3 Z ... turns of that shaft, where errors of the known teeth have
lines too. So single lines say nothing: Z is the comb whose first lines stand out most together. Source: derived.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np

from diagnostics.calibration.jackknife import FEWEST_RECORDINGS, Fitted, jackknife
from diagnostics.calibration.order_record import OrderRecord
from diagnostics.calibration.own_lines import LEAST_SPREAD, UNKNOWN_SPREAD, OwnLine
from diagnostics.calibration.shaft_multiples import ShaftMultiples, shaft_multiples

TEETH = range(12, 120)
COMPARED, MOST_DB, LINE_DB = 8, 15.0, 4.5
"""A comb is judged by its first lines: what each has above LINE_DB, up to MOST_DB, may be less than nothing."""
LEAST_SCORE = 28.0
"""Sum over a comb. Of 56 shafts of simulated machines without a stage the best comb had 20 at most; with stages of 1.6
to 4 % of the mesh force 37 to 74, with two of about 1 % 21 and less."""
LEAD = 1.3
"""Over the next comb that has not the same lines."""
DIVISOR_SHARE = 0.6
"""A comb of half the teeth has every second line beside those of the true one, and a comb of twice the teeth only every
second line. The fewest teeth win that score so much of the best."""
LINE_EXCESS_DB = 6.0
"""From which a line is taken: errors of the teeth make less than a quarter of it."""
HIGHEST_LINE = 20


@dataclass(frozen=True, slots=True)
class SecondStage:
    """Teeth on the shaft that both stages share, `pinion` or `gear`, that shaft's order, and the comb's score [dB]."""

    shaft: str
    teeth: int
    step: float
    score_db: float

    @property
    def order(self) -> float:
        """Mesh order of the stage per turn of the pinion."""
        return self.teeth * self.step


@dataclass(frozen=True, slots=True)
class StageLine:
    """A line at a whole order of a shaft: name, level [dB re 1 unit²] and how it is drawn."""

    name: str
    level_db: Fitted
    line: OwnLine


Multiples = Mapping[str, Mapping[str, ShaftMultiples]]
"""By shaft and channel."""


def machine_multiples(channels: Mapping[str, Sequence[OrderRecord]], teeth: tuple[int, int]) -> Multiples:
    """Return the multiples of both shafts in every channel; a shaft is left out where recordings are too short."""
    common = gcd(*teeth)
    steps = {"pinion": (1.0, teeth[0]), "gear": (teeth[0] / teeth[1], teeth[1])}
    found: dict[str, dict[str, ShaftMultiples]] = {}
    for shaft, (step, own) in steps.items():
        each = {name: shaft_multiples(records, step, own, own // common) for name, records in channels.items()}
        known = {name: one for name, one in each.items() if one is not None}
        if known:
            found[shaft] = known
    return found


def second_stage(multiples: Multiples, teeth: tuple[int, int]) -> SecondStage | None:
    """Return the stage that the recordings show; None where no comb stands out clearly."""
    steps = {"pinion": 1.0, "gear": teeth[0] / teeth[1]}
    found = [
        SecondStage(shaft, count, steps[shaft], score)
        for shaft, channels in multiples.items()
        for count, score in _scores(channels.values())
    ]
    best = max(found, key=lambda one: one.score_db, default=None)
    if best is None or best.score_db < LEAST_SCORE:
        return None
    rivals = [one for one in found if not _same_lines(one, best)]
    if any(best.score_db < LEAD * one.score_db for one in rivals):
        return None
    family = [one for one in found if one.shaft == best.shaft and best.teeth % one.teeth == 0]
    return min((one for one in family if one.score_db >= DIVISOR_SHARE * best.score_db), key=lambda one: one.teeth)


def _scores(channels: Iterable[ShaftMultiples]) -> list[tuple[int, float]]:
    """Return teeth and score of every comb of a shaft, from the mean excess over channels."""
    each = [one.excess_db for one in channels]
    excess = np.mean([one[: min(map(len, each))] for one in each], axis=0)
    found = []
    for count in TEETH:
        lines = excess[count - 1 :: count]
        lines = lines[np.isfinite(lines)][:COMPARED]
        found.append((count, float(np.sum(np.clip(lines, 0.0, MOST_DB) - LINE_DB))))
    return found


def _same_lines(one: SecondStage, other: SecondStage) -> bool:
    """Return whether two combs share a third of their lines or more: a few teeth divide both."""
    if one.shaft != other.shaft:
        return False
    common = gcd(one.teeth, other.teeth)
    return max(one.teeth, other.teeth) <= 6 * common


def stage_lines(stage: SecondStage, multiples: ShaftMultiples) -> tuple[StageLine, ...]:
    """Return the lines of a stage that stand out in a channel, less what errors of the teeth add there."""
    found = []
    for h in range(1, HIGHEST_LINE + 1):
        for side in (-1, 0, 1):
            number = h * stage.teeth + side
            if number <= multiples.excess_db.size and multiples.excess_db[number - 1] >= LINE_EXCESS_DB:
                name = f"line {h}" + (f", sideband {side:+d}" if side else "")
                found.append(shaft_line(name, number, stage.step, multiples))
    return tuple(found)


def shaft_line(name: str, number: int, step: float, multiples: ShaftMultiples) -> StageLine:
    """Return the line at a multiple of a shaft's order (step), less what errors of the teeth add there."""
    power = 10.0 ** (0.1 * multiples.level_db[:, number - 1])
    usual = 10.0 ** (0.1 * multiples.usual_db[number - 1])
    own = np.maximum(power - usual, 0.1 * power)
    amplitude = np.sqrt(2.0 * own)
    least = LEAST_SPREAD if own.size >= FEWEST_RECORDINGS else UNKNOWN_SPREAD
    spread = max(float(np.sqrt(amplitude.max() / amplitude.min())), least)
    line = OwnLine(number * step, 0.0, float(np.median(amplitude)), spread)
    return StageLine(name, jackknife(10.0 * np.log10(own)), line)
