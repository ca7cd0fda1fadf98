"""Deviations of the teeth of one specimen, as a measuring machine would list and draw them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

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
from siggen.views.pictures import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


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


# The picture of `siggen inspect errors`: cumulative pitch and profiles of both gears within their tolerances.


def error_figure(charts: Sequence[GearChart]) -> Figure:
    """Return the figure: a row per gear, cumulative pitch, the profiles of all teeth, a helix that is not straight."""
    from matplotlib.figure import Figure

    columns = 3 if any(chart.helix_um is not None for chart in charts) else 2
    figure = Figure(figsize=(5.5 * columns, 3.4 * len(charts)), layout="constrained")
    axes = figure.subplots(len(charts), columns, squeeze=False)
    for row, chart in zip(axes, charts, strict=True):
        _draw_pitch(row[0], chart)
        _draw_profiles(row[1], chart)
        if columns > 2:
            _draw_helix(row[2], chart)
    figure.suptitle("deviations about the shaft's axis, positive where material is missing", fontsize=10)
    return figure


def save_error_figure(charts: Sequence[GearChart], path: Path) -> None:
    """Draw the charts into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the file cannot be drawn.
    """
    save_figure(lambda: error_figure(charts), path, dpi=120)


def _draw_pitch(axis: Axes, chart: GearChart) -> None:
    from matplotlib.ticker import MaxNLocator

    cumulative = 1e6 * chart.made.found.cumulative_pitch_m
    middle = 0.5 * float(cumulative.max() + cumulative.min())
    _band(axis, middle, 1e6 * chart.made.tolerances.cumulative_pitch_m, chart, "$F_p$")
    axis.bar(range(cumulative.size), cumulative, color="C2", width=0.8)
    largest = {name: 1e6 * value for name, value in chart.made.found.largest.items()}
    limits = chart.made.tolerances
    axis.set_title(
        f"{chart.gear}, class {chart.made.accuracy_class}: $F_p$ {largest['cumulative_pitch_m']:.1f} of "
        f"{1e6 * limits.cumulative_pitch_m:.1f} µm, $f_p$ {largest['pitch_m']:.1f} of {1e6 * limits.pitch_m:.1f} µm, "
        f"$F_r$ {largest['runout_m']:.1f} of {1e6 * limits.runout_m:.1f} µm",
        fontsize=9,
    )
    axis.set_xlabel("tooth")
    axis.xaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set_ylabel("cumulative pitch [µm]")
    axis.legend(loc="upper right", fontsize=8, frameon=True, facecolor="white", framealpha=1.0)


def _draw_profiles(axis: Axes, chart: GearChart) -> None:
    import numpy as np

    _band(axis, 0.0, 1e6 * chart.made.tolerances.profile_m, chart, r"$F_\alpha$")
    place = np.linspace(0.0, 1.0, chart.profile_um.shape[1])
    for profile in chart.profile_um:
        axis.plot(place, profile - 0.5 * (profile.max() + profile.min()), lw=0.6, color="C2", alpha=0.6)
    largest, limits = chart.made.found.largest, chart.made.tolerances
    parts = (
        (r"$F_\alpha$", "profile_m"),
        (r"$f_{H\alpha}$", "profile_slope_m"),
        (r"$f_{f\alpha}$", "profile_form_m"),
    )
    text = ", ".join(f"{name} {1e6 * largest[key]:.1f} of {1e6 * getattr(limits, key):.1f} µm" for name, key in parts)
    axis.set_title(f"{len(chart.profile_um)} profiles: {text}", fontsize=9)
    axis.set_xlabel("root end to tip of the active flank")
    axis.set_ylabel("profile about its middle [µm]")
    axis.legend(loc="upper right", fontsize=8, frameon=True, facecolor="white", framealpha=1.0)


def _draw_helix(axis: Axes, chart: GearChart) -> None:
    import numpy as np

    helix, limits = chart.made.helix, chart.made.tolerances
    points = helix.form_m.size
    place = np.linspace(0.0, 1.0, points)
    errors = 1e6 * (helix.missing_m(place) - helix.crowning_m * (2.0 * place - 1.0) ** 2)
    _band(axis, 0.0, 1e6 * limits.helix_m, chart, r"$F_\beta$")
    axis.plot(place, errors, color="C2", label="errors")
    if helix.crowning_m > 0.0:
        axis.plot(
            place,
            np.zeros(points) if chart.helix_um is None else chart.helix_um,
            color="C6",
            label="with crowning",
        )
    form = 1e6 * float(np.ptp(helix.form_m))
    axis.set_title(
        rf"helix: $f_{{H\beta}}$ {1e6 * helix.slope_m:+.1f} of {1e6 * limits.helix_slope_m:.1f} µm, "
        rf"$f_{{f\beta}}$ {form:.1f} of {1e6 * limits.helix_form_m:.1f} µm, $C_\beta$ {1e6 * helix.crowning_m:.1f} µm",
        fontsize=9,
    )
    axis.set_xlabel("near to far end of the face")
    axis.set_ylabel("missing across the face [µm]")
    axis.legend(loc="best", fontsize=8, frameon=True, facecolor="white", framealpha=1.0)


def _band(axis: Axes, middle_um: float, height_um: float, chart: GearChart, name: str) -> None:
    share = chart.made.tolerance_share
    for part, colour, label in ((1.0, "0.93", f"{name} allowed"), (share, "0.82", f"{share:.0%} of it, to be used")):
        half = 0.5 * part * height_um
        axis.axhspan(middle_um - half, middle_um + half, color=colour, lw=0, label=label, zorder=0)
