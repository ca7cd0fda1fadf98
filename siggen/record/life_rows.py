"""Rows of the tables of `life/` of one gearbox."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict

import numpy as np

from siggen.gearbox.life import Lived

Row = dict[str, object]
RUNS = 200
"""Continuations of an outlook."""


def life_rows(found: Lived, specimen_id: int, firsts: Sequence[int]) -> dict[str, list[Row]]:
    """Return the rows of one gearbox by table, without their split; lengths in mm, ages in hours and turns.

    `firsts` are the first records of its inspections.
    """
    heads: list[Row] = [
        {"record_id": first, "specimen_id": specimen_id, "inspection": number} for number, first in enumerate(firsts)
    ]
    seen = list(zip(heads, found.ages_h, strict=True))
    return {
        "units": [{"specimen_id": specimen_id, **_unit(found)}],
        "inspections": [{**head, **_inspection(found, age_h)} for head, age_h in seen],
        "teeth": [{**head, **row} for head, age_h in seen for row in _teeth(found, age_h)],
        "pits": [{"specimen_id": specimen_id, **row} for row in _pits(found)],
        "outlook": [{**head, **_outlook(found, age_h)} for head, age_h in seen],
        "debris": [{**head, "debris_mg": found.debris_mg(age_h)} for head, age_h in seen],
        "pictures": [{**head, **row} for head, age_h in seen for row in _pictures(found, age_h)],
    }


def _turns(found: Lived, time: float) -> float:
    """Return the turns of the pinion at a damage time."""
    return found.clock.turns(found.clock.age_h(time))


def _unit(found: Lived) -> Row:
    ends, clock = found.course.ends, found.clock
    times = {"first_pit": ends.first_pit, "rated": ends.rated, "failure": ends.functional}
    return {
        "event": found.event,
        "observed_h": found.observed_h,
        "inspections": len(found.ages_h),
        **{f"{name}_h": clock.age_h(time) for name, time in times.items()},
        **{f"{name}_rev": _turns(found, time) for name, time in times.items()},
        "end_gear": ends.gear,
        "end_tooth": ends.tooth,
        "functional_share": found.functional_share,
        "scale": found.clock.scale,
    }


def _inspection(found: Lived, age_h: float) -> Row:
    ends, clock = found.course.ends, found.clock
    rated_h, failure_h = clock.age_h(ends.rated), clock.age_h(ends.functional)
    failed = found.event == "failed"
    return {
        "age_h": age_h,
        "age_rev": clock.turns(age_h),
        "damage_time_rev": clock.time(age_h),
        "phase": found.phase(clock.time(age_h)),
        "life_used": age_h / failure_h,
        "rul_rated_h": rated_h - age_h if failed else None,
        "rul_h": failure_h - age_h if failed else None,
        "rul_at_least_h": found.observed_h - age_h,
    }


def _teeth(found: Lived, age_h: float) -> Iterator[Row]:
    for tooth in found.course.teeth(found.clock.time(age_h)):
        yield {
            "gear": tooth.gear,
            "tooth": tooth.tooth,
            "first_pit_rev": _turns(found, tooth.begun),
            "pit_count": tooth.count,
            "area_mm2": 1e6 * tooth.area_m2,
            "area_share": tooth.share,
        }


def _outlook(found: Lived, age_h: float) -> Row:
    ends = found.course.outlook(found.clock.time(age_h), RUNS)
    left_h = [found.clock.age_h(time) - age_h for time in np.quantile(ends, (0.1, 0.5, 0.9)).tolist()]
    return dict(zip(("rul_q10_h", "rul_q50_h", "rul_q90_h"), left_h, strict=True))


def _pictures(found: Lived, age_h: float) -> Iterator[Row]:
    """Yield pictures of pitted flanks; of whole ones, which all look alike, at age 0 alone."""
    time = found.clock.time(age_h)
    if age_h == 0.0 or time >= found.course.ends.first_pit:
        yield from (asdict(picture) for picture in found.course.pictures(time))


def _pits(found: Lived) -> Iterator[Row]:
    for pit in found.course.parts:
        yield {
            "gear": pit.gear,
            "tooth": pit.tooth,
            "pit": pit.number,
            "begun_rev": _turns(found, pit.begun),
            "first_share": pit.first_share,
            "rate_per_rev": pit.rate,
            "face_mm": 1e3 * pit.face_m,
            "height_mm": 1e3 * pit.arc_m,
        }
