"""Deviations of the teeth of one specimen, as a measuring machine would list and draw them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.config import Config
from siggen.errors import UsageError
from siggen.gears.errors.gear_errors import profiles_m
from siggen.gears.geometry.gear_pair import GearPair
from siggen.planning.specimen import draw_specimen
from siggen.specimen.errors import MadeGear, specimen_errors
from siggen.specimen.gears import gear_pair


@dataclass(frozen=True, slots=True)
class GearChart:
    """One gear: `gear` names it, `made` is what was drawn, `profile_um` (z, points) runs from root end to tip."""

    gear: str
    made: MadeGear
    profile_um: FloatArray


def gear_charts(config: Config, specimen_id: int = 0, state: str | None = None) -> tuple[GearChart, GearChart]:
    """Return pinion and gear of a specimen in a state, the first one if none is named.

    Raises
    ------
    UsageError
        If the set has perfect gears or no such state.
    """
    names = [one.name for one in config.states]
    if state is not None and state not in names:
        raise UsageError(f"received the state '{state}'; allowed: {', '.join(names)}")
    pair = gear_pair(draw_specimen(config, specimen_id).gears)
    errors = specimen_errors(config, pair, specimen_id, 0 if state is None else names.index(state))
    if errors is None:
        raise UsageError(
            f"{config.name}: its gears are perfect; give them errors, such as --set manufacture.accuracy_class=6"
        )
    return _chart(pair, "pinion", errors.pinion), _chart(pair, "gear", errors.gear)


def deviation_table(charts: tuple[GearChart, GearChart]) -> pa.Table:
    """Return one row per tooth: gear, tooth and its deviations [um], positive where material is missing."""
    return pa.Table.from_pylist([row for chart in charts for row in _rows(chart)])


def _chart(pair: GearPair, which: str, made: MadeGear) -> GearChart:
    return GearChart(which, made, 1e6 * profiles_m(pair, which, made.errors))


def _rows(chart: GearChart) -> Iterator[dict[str, object]]:
    found = chart.made.found
    for tooth in range(len(chart.profile_um)):
        yield {
            "gear": chart.gear,
            "tooth": tooth,
            "cumulative_pitch_um": 1e6 * float(found.cumulative_pitch_m[tooth]),
            "pitch_um": 1e6 * float(found.pitch_m[tooth]),
            "profile_slope_um": 1e6 * float(found.profile_slope_m[tooth]),
            "profile_form_um": 1e6 * float(found.profile_form_m[tooth]),
            "profile_um": 1e6 * float(found.profile_m[tooth]),
        }
