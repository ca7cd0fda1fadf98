"""SecondStage: another pair of gears on one of the shafts, where its lines stand out of the errors of the teeth.

A stage of Z teeth on a shaft has its lines at Z, 2 Z, 3 Z ... turns of that shaft, where errors of the known teeth have
lines too. So single lines say nothing: Z is the comb whose first lines stand out most together. Source: derived.

ShaftMultiples: how far each multiple of a shaft's order stands out of what errors of the teeth make there.

Every tooth differs, so a gear has lines at all multiples of its shaft. Two things are known of them: they change
slowly from one to the next beside the mesh lines, and what errors of z teeth do returns with every z multiples. So
the excess of a multiple is its level over the median of those around it, less the median excess of all multiples as
far from a mesh line. Source: derived.

Lines at whole orders of a shaft that stand out one by one: waves that a machine left on the flanks (ghost lines).

A wave of k periods round a gear has a line at k, with sidebands. Errors that differ from tooth to tooth have lines at
all orders of a shaft. The power of these is exponential where errors are independent: 2^-4 = 6 % of them lie 6 dB above
the median too, and are taken for waves. Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import gcd

import numpy as np

from diagnostics.calibration.drivetrain import Drivetrain, Shaft
from diagnostics.calibration.healthy_blocks import FEWEST_RECORDINGS, Fitted, jackknife
from diagnostics.calibration.order_record import LEAST_SHARE, LINE_BINS, SAME_ORDER, OrderRecord, line_places
from diagnostics.calibration.own_lines import LEAST_SPREAD, SHAFT_ORDERS, UNKNOWN_SPREAD, OwnLine

WAVE_EXCESS_DB = 6.0
"""Chosen on one simulated machine, from 10 and 6 dB: docs/understand/calibration.md."""

BESIDE_MESH = 2
"""Multiples this near to a mesh line are its sidebands, which eccentric gears have as well: nothing is read there."""
AROUND = 12
OFF_BINS = 0.5
"""A line further from the multiple than this turns with something else."""
FEWEST_BINS = 3.0 * LINE_BINS
"""Between two multiples: their lines are five bins wide."""
FEWEST_ALIKE = 3

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


def wave_lines(multiples: Multiples, drive: Drivetrain, channel: str, known: tuple[float, ...]) -> tuple[OwnLine, ...]:
    """Return these lines of a channel.

    Parameters
    ----------
    multiples : mapping
        By shaft and channel.
    drive : Drivetrain
    channel : str
    known : tuple of float
        Orders that are taken already: those of a second stage.
    """
    found: dict[float, OwnLine] = {}
    for shaft in drive.shafts:
        if channel not in multiples.get(shaft.name, {}):
            continue
        own, step = multiples[shaft.name][channel], shaft.step
        for number in (np.flatnonzero(own.excess_db >= WAVE_EXCESS_DB) + 1).tolist():
            order = number * step
            if number > SHAFT_ORDERS and all(abs(order - other) > SAME_ORDER for other in (*known, *found)):
                found[order] = shaft_line("", number, step, own).line
    return tuple(found.values())


@dataclass(frozen=True, slots=True)
class ShaftMultiples:
    """Multiples 1, 2, ... of a shaft in one channel.

    Attributes
    ----------
    level_db : (recordings, k) float64
        Energy of the line [dB re 1 unit²]; where none stands out, a fifth of what its bins hold.
    usual_db : (k,) float64
        Mean over recordings that errors of the teeth lead to expect.
    excess_db : (k,) float64
        Mean level over the expected one; NaN at mesh lines and beside them.
    """

    level_db: np.ndarray
    usual_db: np.ndarray
    excess_db: np.ndarray


def shaft_multiples(records: Sequence[OrderRecord], shaft: Shaft, drive: Drivetrain) -> ShaftMultiples | None:
    """Return the multiples of a shaft of a machine; None where recordings are too short to tell them apart.

    Parameters
    ----------
    records : sequence of OrderRecord
        Of one channel.
    """
    told = OFF_BINS / min(record.revolutions for record in records)
    if shaft.step < FEWEST_BINS / OFF_BINS * told:
        return None
    count = int(min((record.power.size - 4 * LINE_BINS) / record.revolutions for record in records) / shaft.step) - 1
    number = np.arange(1, count + 1)
    level = np.array([_levels_db(record, number * shaft.step) for record in records])
    mean = level.mean(axis=0)
    mesh = _at_meshes(number, shaft, drive, told)
    usual = _around(mean, number, mesh, _also_of(number * shaft.step, shaft, drive, told))
    for teeth in shaft.teeth:
        usual = usual + _returning(np.where(mesh, np.nan, mean - usual), number, teeth)
    return ShaftMultiples(level, usual, np.where(mesh, np.nan, mean - usual))


def _at_meshes(number: np.ndarray, shaft: Shaft, drive: Drivetrain, told: float) -> np.ndarray:
    """Return which multiples (k,) are mesh lines or beside them by few turns of a shaft of theirs."""
    found = np.zeros(number.size, dtype=bool)
    for teeth in shaft.teeth:
        found |= np.abs(number - np.round(number / teeth) * teeth) <= BESIDE_MESH
    order = number * shaft.step
    for mesh in (one for one in drive.meshes if shaft not in one.shafts):
        beside = order - np.round(order / mesh.order) * mesh.order
        for step in (one.step for one in mesh.shafts):
            sideband = np.clip(np.round(beside / step), -BESIDE_MESH, BESIDE_MESH)
            found |= np.abs(beside - sideband * step) < told
    return found


def _also_of(order: np.ndarray, shaft: Shaft, drive: Drivetrain, told: float) -> np.ndarray:
    """Return (k, other shafts) of which shafts each order is a multiple too, so that it holds their errors as well."""
    others = [one.step for one in drive.shafts if one != shaft]
    return np.stack([np.abs(order - np.round(order / step) * step) < told for step in others], axis=1)


def _levels_db(record: OrderRecord, orders: np.ndarray) -> np.ndarray:
    """Return the levels of lines at these orders (k,); a line beside counts as none."""
    centre = np.round(orders * record.revolutions).astype(int)
    near = centre[:, None] + np.arange(-LINE_BINS, LINE_BINS + 1)
    total, floor = record.power[near].sum(axis=1), record.floor[near].sum(axis=1)
    place = line_places(record.power, near[np.arange(near.shape[0]), record.power[near].argmax(axis=1)])
    least = LEAST_SHARE * np.minimum(total, floor)
    energy = np.where(np.abs(place - orders * record.revolutions) < OFF_BINS, total - floor, 0.0)
    return np.asarray(10.0 * np.log10(np.maximum(np.maximum(energy, least), 1e-30)))


def _around(level_db: np.ndarray, number: np.ndarray, mesh: np.ndarray, also_of: np.ndarray) -> np.ndarray:
    """Return the median of the nearest multiples of the same kind (k,), without those at mesh lines and beside it."""
    found = np.full(number.size, math.inf)
    for k in range(number.size):
        alike = np.flatnonzero((also_of == also_of[k]).all(axis=1) & ~mesh & (np.abs(number - number[k]) > 1))
        if alike.size >= FEWEST_ALIKE:
            nearest = np.argsort(np.abs(alike - k), kind="stable")[:AROUND]
            found[k] = np.median(level_db[alike[nearest]])
    return found


def _returning(above_db: np.ndarray, number: np.ndarray, teeth: int) -> np.ndarray:
    """Return what all multiples as far from a mesh line have in common (k,) [dB], 0 at least."""
    found = np.zeros(number.size)
    for rest in range(teeth):
        alike = number % teeth == rest
        known = above_db[alike][np.isfinite(above_db[alike])]
        if known.size >= FEWEST_ALIKE:
            found[alike] = max(0.0, float(np.median(known)))
    return found


@dataclass(frozen=True, slots=True)
class SecondStage:
    """Teeth on the shaft that both stages share, its name and order, and the comb's score [dB]."""

    shaft: str
    teeth: int
    step: float
    score_db: float

    @property
    def order(self) -> float:
        """Mesh order of the stage per turn of the first shaft."""
        return self.teeth * self.step


@dataclass(frozen=True, slots=True)
class StageLine:
    """A line at a whole order of a shaft: name, level [dB re 1 unit²] and how it is drawn."""

    name: str
    level_db: Fitted
    line: OwnLine


Multiples = Mapping[str, Mapping[str, ShaftMultiples]]
"""By shaft and channel."""


def machine_multiples(channels: Mapping[str, Sequence[OrderRecord]], drive: Drivetrain) -> Multiples:
    """Return the multiples of all shafts in every channel; a shaft is left out where recordings are too short."""
    found: dict[str, dict[str, ShaftMultiples]] = {}
    for shaft in drive.shafts:
        each = {name: shaft_multiples(records, shaft, drive) for name, records in channels.items()}
        known = {name: one for name, one in each.items() if one is not None}
        if known:
            found[shaft.name] = known
    return found


def second_stage(multiples: Multiples, drive: Drivetrain) -> SecondStage | None:
    """Return the stage that recordings show; None where no comb stands out clearly."""
    steps = {shaft.name: shaft.step for shaft in drive.shafts}
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
