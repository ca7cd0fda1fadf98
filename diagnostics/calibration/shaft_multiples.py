"""ShaftMultiples: how far each multiple of a shaft's order stands out of what errors of the teeth make there.

Every tooth differs, so a gear has lines at all multiples of its shaft. Two things are known of them: they change
slowly from one to the next beside the mesh lines, and what errors of z teeth do returns with every z multiples. So
the excess of a multiple is its level over the median of those around it, less the median excess of all multiples as
far from a mesh line.

A resonance of the housing lifts a few multiples too. It lifts the floor beside them, and the multiples of the slowest
shaft that lie nearest. So the excess is the least of three: of the level, of the level over the floor, and over those
nearest. Source: derived.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnostics.calibration.drivetrain import RigShaft, TrainOrders
from diagnostics.calibration.order_record import LEAST_SHARE, LINE_BINS, OrderRecord, line_places

BESIDE_MESH = 2
"""Multiples this near to a mesh line are its sidebands, which eccentric gears have as well: nothing is read there."""
AROUND = 12
NEAREST, FEWEST_NEAREST = 3.4, 3
"""Turns of the slowest shaft up to which its multiples are compared, and how many there must be."""
OFF_BINS = 0.5
"""A line further from the multiple than this turns with something else."""
FEWEST_BINS = 3.0 * LINE_BINS
"""Between two multiples: their lines are five bins wide."""
FEWEST_ALIKE = 3


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
        Mean level over the expected one, the least of three ways; NaN at mesh lines and beside them.
    """

    level_db: np.ndarray
    usual_db: np.ndarray
    excess_db: np.ndarray


def shaft_multiples(records: Sequence[OrderRecord], shaft: RigShaft, drive: TrainOrders) -> ShaftMultiples | None:
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
    mesh, also_of = (one(number, shaft, drive, told) for one in (_at_meshes, _also_of))

    def usual(level_db: np.ndarray) -> np.ndarray:
        expected_db = _around(level_db, number, mesh, also_of)
        for teeth in shaft.teeth:
            expected_db = expected_db + _returning(np.where(mesh, np.nan, level_db - expected_db), number, teeth)
        return expected_db

    mean = level.mean(axis=0)
    over_floor = mean - np.mean([_floor_db(record, number * shaft.step) for record in records], axis=0)
    expected = usual(mean)
    excess = np.minimum(mean - expected, over_floor - usual(over_floor))
    return ShaftMultiples(level, expected, np.where(mesh, np.nan, excess))


def _at_meshes(number: np.ndarray, shaft: RigShaft, drive: TrainOrders, told: float) -> np.ndarray:
    """Return which multiples (k,) are mesh lines or beside them by few turns of a shaft of theirs."""
    at_meshes = np.zeros(number.size, dtype=bool)
    for teeth in shaft.teeth:
        at_meshes |= np.abs(number - np.round(number / teeth) * teeth) <= BESIDE_MESH
    order = number * shaft.step
    for mesh in (one for one in drive.meshes if shaft not in one.shafts):
        beside = order - np.round(order / mesh.order) * mesh.order
        for step in (one.step for one in mesh.shafts):
            sideband = np.clip(np.round(beside / step), -BESIDE_MESH, BESIDE_MESH)
            at_meshes |= np.abs(beside - sideband * step) < told
    return at_meshes


def _also_of(number: np.ndarray, shaft: RigShaft, drive: TrainOrders, told: float) -> np.ndarray:
    """Return (k, other shafts) of which shafts each multiple is one too, so that it holds their errors as well."""
    order = number * shaft.step
    others = [other.step for other in drive.shafts if other != shaft]
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


def _floor_db(record: OrderRecord, orders: np.ndarray) -> np.ndarray:
    return np.asarray(10.0 * np.log10(record.floor[np.round(orders * record.revolutions).astype(int)]))


def _around(level_db: np.ndarray, number: np.ndarray, mesh: np.ndarray, also_of: np.ndarray) -> np.ndarray:
    """Return the median of the nearest multiples of the same kind (k,), without those at mesh lines and beside it."""
    median_db = np.full(number.size, math.inf)
    for k in range(number.size):
        alike = np.flatnonzero((also_of == also_of[k]).all(axis=1) & ~mesh & (np.abs(number - number[k]) > 1))
        if alike.size >= FEWEST_ALIKE:
            nearest = np.argsort(np.abs(alike - k), kind="stable")[:AROUND]
            median_db[k] = np.median(level_db[alike[nearest]])
    return median_db


def _returning(above_db: np.ndarray, number: np.ndarray, teeth: int) -> np.ndarray:
    """Return what all multiples as far from a mesh line have in common (k,) [dB], 0 at least."""
    common_db = np.zeros(number.size)
    for rest in range(teeth):
        alike = number % teeth == rest
        known = above_db[alike][np.isfinite(above_db[alike])]
        if known.size >= FEWEST_ALIKE:
            common_db[alike] = max(0.0, float(np.median(known)))
    return common_db


Multiples = Mapping[str, Mapping[str, ShaftMultiples]]
"""By shaft and channel."""


def machine_multiples(channels: Mapping[str, Sequence[OrderRecord]], drive: TrainOrders) -> Multiples:
    """Return the multiples of all shafts in every channel; a shaft is left out where recordings are too short."""
    multiples: dict[str, dict[str, ShaftMultiples]] = {}
    for shaft in drive.shafts:
        each = {name: shaft_multiples(records, shaft, drive) for name, records in channels.items()}
        known = {name: of_channel for name, of_channel in each.items() if of_channel is not None}
        if known:
            multiples[shaft.name] = known
    steps = {shaft.name: shaft.step for shaft in drive.shafts if shaft.name in multiples}
    return {
        name: {
            channel: _beside_nearest(of_channel, name, steps, multiples, channel)
            for channel, of_channel in each.items()
        }
        for name, each in multiples.items()
    }


def _beside_nearest(
    asked: ShaftMultiples, shaft: str, steps: Mapping[str, float], multiples: Multiples, channel: str
) -> ShaftMultiples:
    """Return the multiples of a shaft with no more excess than they have over those of the slowest shaft beside."""
    slowest = min((name for name in steps if channel in multiples[name]), key=lambda name: steps[name])
    other, step = multiples[slowest][channel], steps[slowest]
    level, known = other.level_db.mean(axis=0), np.isfinite(other.excess_db)
    order = step * np.arange(1, level.size + 1)
    least = (1.5 if slowest == shaft else 0.05) * step  # neither itself nor its sidebands
    over = np.full(asked.excess_db.size, np.nan)
    for k in np.flatnonzero(np.isfinite(asked.excess_db)):
        away = np.abs(order - (k + 1) * steps[shaft])
        near = known & (away > least) & (away < NEAREST * step)
        if np.count_nonzero(near) >= FEWEST_NEAREST:
            over[k] = asked.level_db[:, k].mean() - np.median(level[near])
    usual = np.nanmedian(over) if np.isfinite(over).any() else 0.0
    return replace(asked, excess_db=np.fmin(asked.excess_db, over - usual))
