"""Single gearboxes of a set of lives, with what first shows their damage, for figures and tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow.compute as pc

from diagnostics.report.life_figure import FlankPicture, UnitLife
from diagnostics.statistics.first_detection import Watch, rise, watched
from diagnostics.training.life_baselines import HISTORY, OUTLOOK, Inspections
from siggen.dataset.reading import Dataset

PICTURES, DEBRIS, FIVE, WITH_HISTORY = "pictures", "oil debris", "five indicators", "NA4 and NB4"


def watches(found: Inspections) -> dict[str, Watch]:
    """Return what shows damage: pictures from their first pit on, the others by their limits."""
    whole = found.worst_shares[:, 0] == 0.0
    five = np.concatenate(list(found.indicators.values()), axis=1)
    of = {
        DEBRIS: found.debris_mg,
        FIVE: rise(five, found.specimen, whole),
        WITH_HISTORY: rise(found.history, found.specimen, whole),
    }
    seen = {
        int(unit): int(np.flatnonzero((found.specimen == unit) & ~whole)[0])
        for unit in np.unique(found.specimen[~whole])
    }
    pictures = Watch(np.where(whole, 0.0, 1.0), seen)
    return {PICTURES: pictures, **{name: watched(index, found.specimen, whole) for name, index in of.items()}}


@dataclass(frozen=True, slots=True)
class FailureDetection:
    """What of the failed gearboxes is detected by one thing.

    Attributes
    ----------
    gearboxes, detected, early : int
        That failed; of these detected while a tooth is pitted; with an alarm that counts before any pit.
    share, left_h : float
        Medians over the detected ones: area of the worst tooth, and hours until the end; NaN without any.
    """

    gearboxes: int
    detected: int
    early: int
    share: float
    left_h: float

    def numbers(self) -> dict[str, float | int | None]:
        """Return it for JSON."""
        medians = {"worst_share": self.share, "left_h": self.left_h}
        counts = {"gearboxes": self.gearboxes, "detected": self.detected, "before_any_pit": self.early}
        return {**counts, **{name: value if np.isfinite(value) else None for name, value in medians.items()}}


def detections(found: Inspections, seen: Mapping[str, Watch]) -> dict[str, FailureDetection]:
    """Return what each watch detects of the gearboxes that failed."""
    failed = set(np.unique(found.specimen[np.isfinite(found.rul_h)]).tolist())
    return {name: _detection(found, one, failed) for name, one in seen.items()}


def _detection(found: Inspections, watch: Watch, failed: set[int]) -> FailureDetection:
    rows = np.array([row for unit, row in watch.detected.items() if unit in failed], dtype=int)
    pitted = found.worst_shares[rows, 0] > 0.0
    right = rows[pitted]
    share, left_h = found.worst_shares[right, 0], found.rul_h[right]
    medians = (float(np.median(values)) if right.size else float("nan") for values in (share, left_h))
    return FailureDetection(len(failed), int(right.size), int((~pitted).sum()), *medians)


def unit_lives(
    dataset: Dataset,
    found: Inspections,
    seen: Mapping[str, Watch],
    predicted: Mapping[str, np.ndarray],
    chosen: Sequence[int],
) -> dict[int, UnitLife]:
    """Return some gearboxes for figures; of predictions those that indicators with their history and the truth give."""
    units = {row["specimen_id"]: row for row in dataset.life("units").to_pylist()}
    shown = {name: values for name, values in predicted.items() if name in (HISTORY, OUTLOOK)}
    return {unit: _unit_life(dataset, found, seen, shown, units[unit]) for unit in chosen}


def _unit_life(
    dataset: Dataset,
    found: Inspections,
    seen: Mapping[str, Watch],
    predicted: Mapping[str, np.ndarray],
    row: Mapping[str, object],
) -> UnitLife:
    unit = int(str(row["specimen_id"]))
    own = np.flatnonzero(found.specimen == unit)
    at = {name: found.age_h[one.detected[unit]] if unit in one.detected else np.nan for name, one in seen.items()}
    ends = {"first pit": "first_pit_h", "rated": "rated_h"}
    marks = {name: float(str(row[column])) for name, column in ends.items()}
    ended = "failed" if row["event"] == "failed" else "taken out"
    observed_h = float(str(row["observed_h"]))
    return UnitLife(
        specimen=unit,
        age_h=found.age_h[own],
        watches={name: (one.index[own], float(at[name])) for name, one in seen.items() if name != PICTURES},
        marks_h={**{name: age for name, age in marks.items() if age < observed_h}, ended: observed_h},
        pictures=_pictures(dataset, unit, str(row["end_gear"]), int(str(row["end_tooth"])), found),
        end_h=float(str(row["failure_h"])),
        predicted_h={name: values[own] for name, values in predicted.items()},
    )


def _pictures(dataset: Dataset, unit: int, gear: str, tooth: int, found: Inspections) -> list[FlankPicture]:
    """Return the pictures of one tooth in order of age; that of a whole flank stands for those before its first pit."""
    table, shares = dataset.life("pictures"), dataset.life("teeth")
    own = table.filter(pc.equal(table.column("specimen_id"), unit)).to_pylist()
    of_teeth = shares.filter(pc.equal(shares.column("specimen_id"), unit)).to_pylist()
    share = {(row["inspection"], row["gear"], row["tooth"]): row["area_share"] for row in of_teeth}
    ages_h = dict(zip(found.record_id.tolist(), found.age_h.tolist(), strict=True))
    wanted = [row for row in own if row["gear"] == gear and (row["inspection"] == 0 or row["tooth"] == tooth)]
    return [
        FlankPicture(ages_h[row["record_id"]], share.get((row["inspection"], gear, tooth), 0.0), row["png"])
        for row in sorted(wanted, key=lambda one: one["inspection"])
        if row["record_id"] in ages_h
    ]
