"""Deviations of the teeth of one specimen, as a measuring machine would list and draw them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.errors import UsageError
from siggen.gearbox.specimen import Specimen
from siggen.gearbox.teeth import MadeGear
from siggen.gears.errors import HELIX_POINTS, profiles_m
from siggen.gears.gear_pair import GearPair
from siggen.keys.problems import nearest
from siggen.names import Side


@dataclass(frozen=True, slots=True)
class GearChart:
    """One gear: `gear` names it, `made` is what was drawn, `profile_um` (z, points) runs from root end to tip.

    `helix_um` (points,) runs across the face, alike on all teeth; None where nothing is missing across it.
    """

    gear: str
    made: MadeGear
    profile_um: FloatArray
    helix_um: FloatArray | None


def gear_charts(specimen: Specimen, state: str | None = None, mesh: int = 0) -> tuple[GearChart, GearChart]:
    """Return pinion and gear of a mesh of a specimen in a state, the first one if none is named.

    Raises
    ------
    UsageError
        If it has perfect gears or no such state.
    """
    names = [one.name for one in specimen.states]
    if state is not None and state not in names:
        raise UsageError(f"received the state '{state}'; allowed: {', '.join(names)}{nearest(state, names)}")
    number = 0 if state is None else names.index(state)
    teeth = specimen.in_state(number).meshes[mesh].teeth
    errors = teeth.errors(teeth.drawn_for(number))
    if errors is None:
        raise UsageError("gears: received perfect ones; allowed: gears with errors, --set manufacture.accuracy_class=6")
    driver, driven = specimen.names.meshes[mesh].gears
    pair = teeth.pair
    return _chart(pair, Side.DRIVER, errors.pinion, driver.word), _chart(pair, Side.DRIVEN, errors.gear, driven.word)


def deviation_table(charts: tuple[GearChart, GearChart]) -> pa.Table:
    """Return one row per tooth: gear, tooth and its deviations [um], positive where material is missing.

    Where a gear misses material across the face, also its crowning, helix slope and form, alike for its teeth.
    """
    uneven = any(chart.helix_um is not None for chart in charts)
    return pa.Table.from_pylist(
        [{**row, **(_across(chart) if uneven else {})} for chart in charts for row in _rows(chart)]
    )


def _chart(pair: GearPair, side: Side, made: MadeGear, word: str) -> GearChart:
    place = np.linspace(0.0, 1.0, HELIX_POINTS)
    helix = None if made.helix.straight else 1e6 * made.helix.missing_m(place)
    return GearChart(word, made, 1e6 * profiles_m(pair, side, made.errors), helix)


def _across(chart: GearChart) -> dict[str, float]:
    helix = chart.made.helix
    found = {"crowning_um": helix.crowning_m, "helix_slope_um": helix.slope_m, "helix_form_um": np.ptp(helix.form_m)}
    return {name: 1e6 * float(value) for name, value in found.items()}


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
