"""SecondStage: another pair of gears on one of the shafts, where its lines stand out of the errors of the teeth.

A stage of Z teeth on a shaft has its lines at Z, 2 Z, 3 Z ... turns of that shaft, with sidebands of the shaft, where
errors of the known teeth have lines too. So single lines say nothing: Z is the comb whose lines and sidebands stand
out most together. Each adds the logarithm of how much likelier its excess is with a line there than without. A channel
may show few of them, so what it shows is read from the first line up to where the sum is largest; the housing may hide
the others. A wave that a machine left on the flanks has one line with sidebands, so two lines of a comb must show.
Source: derived.

Lines at whole orders of a shaft that stand out one by one: waves that a machine left on the flanks (ghost lines).

A wave of k periods round a gear has a line at k, with sidebands. Errors that differ from tooth to tooth have lines at
all orders of a shaft. The power of these is exponential where errors are independent: 2^-4 = 6 % of them lie 6 dB above
the median too, and are taken for waves. Source: derived.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import gcd

import numpy as np

from diagnostics.calibration.drivetrain import TrainOrders
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS, jackknife
from diagnostics.calibration.order_record import SAME_ORDER
from diagnostics.calibration.own_lines import LEAST_SPREAD, SHAFT_ORDERS, UNKNOWN_SPREAD, OwnLine
from diagnostics.calibration.shaft_multiples import Multiples, ShaftMultiples
from diagnostics.statistics.evaluation import Interval

WAVE_EXCESS_DB = 6.0
"""Chosen on one simulated machine, from 10 and 6 dB: docs/understand/calibration.md."""

TEETH = range(12, 120)
COMPARED = 8
"""Lines of a comb."""
SHOWN, SIDEBAND_SHOWN = 0.6, 0.3
"""Share of the lines and sidebands that a channel shows (assumed), at an excess of 0 to LARGEST_DB."""
LARGEST_DB, SURE_DB, BELOW_DB = 40.0, 30.0, 6.0
"""Beyond SURE_DB an excess says no more. A sideband stands BELOW_DB under its line at least, or counts as less."""
LEAST_TAIL_DB = 3.0
MOST_OF_ONE = 4.5
"""What one line, or both of its sidebands, may add: e^4.5 is 90 to 1."""
LEAST_SCORE, LEAST_OF_OTHERS = 4.0, 0.5
"""Of a comb, and of it without its best line. Chosen on 24 machines of quickstart: 21 of their combs had both, and none
that was not theirs beat them; docs/understand/calibration.md judges on others."""
LEAD = 1.3
"""Over the next comb that has not the same lines."""
LINE_EXCESS_DB = 6.0
"""From which a line is taken: errors of the teeth make less than a quarter of it."""
HIGHEST_LINE = 20


def wave_lines(multiples: Multiples, drive: TrainOrders, channel: str, known: tuple[float, ...]) -> tuple[OwnLine, ...]:
    """Return these lines of a channel.

    Parameters
    ----------
    multiples : mapping
        By shaft and channel.
    drive : TrainOrders
    channel : str
    known : tuple of float
        Orders that are taken already: those of a second stage.
    """
    waves: dict[float, OwnLine] = {}
    for shaft in drive.shafts:
        if channel not in multiples.get(shaft.name, {}):
            continue
        of_channel, step = multiples[shaft.name][channel], shaft.step
        for number in (np.flatnonzero(of_channel.excess_db >= WAVE_EXCESS_DB) + 1).tolist():
            order = number * step
            if number > SHAFT_ORDERS and all(abs(order - other) > SAME_ORDER for other in (*known, *waves)):
                waves[order] = shaft_line("", number, step, of_channel).line
    return tuple(waves.values())


@dataclass(frozen=True, slots=True)
class SecondStage:
    """Teeth on the shaft that both stages share, its name and order; logarithm of the evidence."""

    shaft: str
    teeth: int
    step: float
    score: float

    @property
    def order(self) -> float:
        """Mesh order of the stage per turn of the first shaft."""
        return self.teeth * self.step


@dataclass(frozen=True, slots=True)
class StageLine:
    """A line at a whole order of a shaft: name, level [dB re 1 unit²] and how it is drawn."""

    name: str
    level_db: Interval
    line: OwnLine


def second_stage(multiples: Multiples, drive: TrainOrders) -> SecondStage | None:
    """Return the stage that recordings show; None where no comb stands out clearly."""
    steps = {shaft.name: shaft.step for shaft in drive.shafts}
    stages = [
        SecondStage(shaft, count, steps[shaft], score)
        for shaft, channels in multiples.items()
        for count, score, of_others in _scores(tuple(channels.values()))
        if score >= LEAST_SCORE and of_others >= LEAST_OF_OTHERS
    ]
    best = max(stages, key=lambda stage: stage.score, default=None)
    if best is None or any(best.score < LEAD * stage.score for stage in stages if not _same_lines(stage, best)):
        return None
    channels = tuple(multiples[best.shaft].values())
    family = [stage for stage in stages if stage.shaft == best.shaft and best.teeth % stage.teeth == 0]
    return min(
        (stage for stage in family if stage == best or _shows_others(channels, stage, best)),
        key=lambda stage: stage.teeth,
    )


def _shows_others(channels: tuple[ShaftMultiples, ...], one: SecondStage, best: SecondStage) -> bool:
    """Return whether a comb shows lines that one of a multiple of its teeth has not, which is why that is no better."""
    numbers = np.array([k for k in range(one.teeth, 2 * best.teeth, one.teeth) if k % best.teeth])
    lines = np.sum([_likelier(each.excess_db[numbers - 1], _tail_db(each), SHOWN) for each in channels], axis=0)
    return bool(np.minimum(lines, MOST_OF_ONE).sum() >= LEAST_OF_OTHERS)


def _scores(channels: tuple[ShaftMultiples, ...]) -> Iterable[tuple[int, float, float]]:
    """Yield teeth, score, and score without the best line, of every comb of a shaft."""
    size = min(one.excess_db.size for one in channels)
    for count in TEETH:
        numbers = np.arange(count, size, count)[:COMPARED]
        if numbers.size < 2:
            return
        lines, sidebands = np.sum([_evidence(one, numbers) for one in channels], axis=0)
        each = np.minimum(lines, MOST_OF_ONE) + np.minimum(sidebands, MOST_OF_ONE)
        yield count, float(each.sum()), float(each.sum() - each.max())


def _tail_db(channel: ShaftMultiples) -> float:
    """Return how fast excesses fall off, from what one in twenty exceeds."""
    return max(float(np.nanquantile(channel.excess_db, 0.95) / np.log(10.0)), LEAST_TAIL_DB)


def _evidence(channel: ShaftMultiples, numbers: np.ndarray) -> np.ndarray:
    """Return what lines at these multiples and their sidebands say in a channel (2, lines), up to the last shown."""
    tail_db, line = _tail_db(channel), channel.excess_db[numbers - 1]
    beside = (np.minimum(channel.excess_db[numbers - 1 + side], line - BELOW_DB) for side in (-1, 1))
    evidence = np.array(
        [_likelier(line, tail_db, SHOWN), np.sum([_likelier(one, tail_db, SIDEBAND_SHOWN) for one in beside], axis=0)]
    )
    total = np.cumsum(evidence.sum(axis=0))
    last = int(np.argmax(total))
    evidence[:, last + 1 if total[last] > 0.0 else 0 :] = 0.0
    return evidence


def _likelier(excess_db: np.ndarray, tail_db: float, shown: float) -> np.ndarray:
    """Return the logarithm of the likelihood of excesses (k,) with a line that may show, over that without one.

    Without one an excess of either sign falls off as exp(-|e|/tail); 0 where nothing is known.
    """
    without = 0.5 / tail_db * np.exp(-np.clip(excess_db, 0.0, SURE_DB) / tail_db)
    log_ratio = np.log(1.0 - shown + np.where(excess_db >= 0.0, shown / LARGEST_DB / without, 0.0))
    return np.where(np.isfinite(excess_db), log_ratio, 0.0)


def _same_lines(one: SecondStage, other: SecondStage) -> bool:
    """Return whether combs share a third of their lines, or lines of one are sidebands of the other."""
    if one.shaft != other.shaft:
        return False
    common, (few, many) = gcd(one.teeth, other.teeth), sorted((one.teeth, other.teeth))
    return many <= 6 * common or min(many % few, -many % few) <= 1


def stage_lines(stage: SecondStage, multiples: ShaftMultiples) -> tuple[StageLine, ...]:
    """Return the lines of a stage that stand out in a channel, less what errors of the teeth add there."""
    lines = []
    for h in range(1, HIGHEST_LINE + 1):
        for side in (-1, 0, 1):
            number = h * stage.teeth + side
            if number <= multiples.excess_db.size and multiples.excess_db[number - 1] >= LINE_EXCESS_DB:
                name = f"line {h}" + (f", sideband {side:+d}" if side else "")
                lines.append(shaft_line(name, number, stage.step, multiples))
    return tuple(lines)


def shaft_line(name: str, number: int, step: float, multiples: ShaftMultiples) -> StageLine:
    """Return the line at a multiple of a shaft's order (step), less what errors of the teeth add there."""
    power = 10.0 ** (0.1 * multiples.level_db[:, number - 1])
    usual = 10.0 ** (0.1 * multiples.usual_db[number - 1])
    above = np.maximum(power - usual, 0.1 * power)
    amplitude = np.sqrt(2.0 * above)
    least = LEAST_SPREAD if above.size >= FEWEST_RECORDINGS else UNKNOWN_SPREAD
    spread = max(float(np.sqrt(amplitude.max() / amplitude.min())), least)
    line = OwnLine(number * step, 0.0, float(np.median(amplitude)), spread)
    return StageLine(name, jackknife(10.0 * np.log10(above)), line)
