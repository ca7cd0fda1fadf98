"""Damaged flanks of one specimen as they are drawn: outlines along the profile's arc, contact zones, area, table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.columns.damage import damage_columns
from siggen.damage.outlines import Outline
from siggen.damage.part import Damage, damaged_teeth, on_teeth, pits_of
from siggen.errors import UsageError
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair, contact_zones
from siggen.gears.spur_gear import SpurGear
from siggen.keys.problems import nearest
from siggen.mesh.damage_summary import flank_arc_m
from siggen.mesh.sections import union_area_m2
from siggen.names import Side
from siggen.record.damage_rows import damage_rows
from siggen.record.teeth import MeshTeeth
from siggen.views.pictures import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure


CORNERS = 181
"""Of the polygon on a smooth outline."""


def outline_mm(outline: Outline) -> FloatArray:
    """Return the corners of a closed outline (n, 2): face coordinate and height above the base circle [mm].

    The height is along the tooth's centre line, as in the configuration. Not clipped to the flank. A smooth outline is
    a polygon on it; the first corner is not repeated.

    Source: paper A, section 2.1 (ellipses); polygons derived.
    """
    return 1e3 * outline.drawn_m(CORNERS)[:, ::-1]


@dataclass(frozen=True, slots=True)
class FlankZone:
    """A stretch of the flank in which `pairs` tooth pairs carry the load, arcs above the base circle [mm]."""

    low_mm: float
    high_mm: float
    pairs: int


@dataclass(frozen=True, slots=True)
class FlankView:
    """One damaged flank; every height is the arc along the involute above the base circle, so that areas are true.

    Attributes
    ----------
    state, gear : names
    tooth : index from 0
    face_width_mm, foot_mm, start_mm, pitch_mm, tip_mm : face width; arcs of the rack-cut involute's foot, of the start
        of the active profile, of the pitch line and of the tip
    zones : zones of contact, upwards
    outlines_mm : one (n, 2) per damage, face coordinate and arc
    depths_mm : largest depth of each damage
    area_mm2, area_share : of the union of all damage; share of the involute flank from its foot to the tip
    """

    state: str
    gear: str
    tooth: int
    face_width_mm: float
    foot_mm: float
    start_mm: float
    pitch_mm: float
    tip_mm: float
    zones: tuple[FlankZone, ...]
    outlines_mm: tuple[FloatArray, ...]
    depths_mm: tuple[float, ...]
    area_mm2: float
    area_share: float


def flank_views(specimen: Specimen, state: str | None = None, mesh: int | None = None) -> list[FlankView]:
    """Return all damaged flanks of a specimen, state by state; of one state or mesh if it is named.

    Parameters
    ----------
    specimen : Specimen
    state : name of a state, or None for all
    mesh : int, from 0 in the order of power, or None for all

    Raises
    ------
    UsageError
        If there is no such state.
    ValueError
        If a height in the configuration lies below the base circle of the drawn gear.

    Source: outlines as in paper A, section 2.1; arcs R_b psi^2/2, derived.
    """
    meshes = [
        (MeshTeeth(specimen.law, one.teeth), name)
        for number, (one, name) in enumerate(zip(specimen.meshes, specimen.names.meshes, strict=True))
        if mesh in (None, number)
    ]
    return [
        replace(view, gear=name.gear(Side(view.gear)).word)
        for index in _state_ids(specimen, state)
        for teeth, name in meshes
        for view in _views(teeth.pair, specimen.states[index].name, on_teeth(teeth.damage(index)))
    ]


def flank_damage_table(specimen: Specimen, state: str | None = None, mesh: int | None = None) -> pa.Table:
    """Return one row per damage, state by state: the state's name, then the columns of `damage/`.

    Lengths are in mm. Parameters as in `flank_views`.

    Raises
    ------
    UsageError
        If there is no such state.
    """
    schema = pa.schema([column.field() for column in damage_columns(specimen)])
    fields = [pa.field("state", pa.string(), nullable=False), *(f for f in schema if f.name != "record_id")]
    number = specimen.specimen_id
    rows = [
        {"state": specimen.states[index].name, **row}
        for index in _state_ids(specimen, state)
        for row in damage_rows(specimen, [PlannedRecord(0, number, index, 0, 0, "")], mesh)
    ]
    return pa.Table.from_pylist(rows, schema=pa.schema(fields))


def _state_ids(specimen: Specimen, state: str | None) -> list[int]:
    names = [one.name for one in specimen.states]
    if state is not None and state not in names:
        raise UsageError(f"received the state '{state}'; allowed: {', '.join(names)}{nearest(state, names)}")
    return [index for index, name in enumerate(names) if state in (None, name)]


def _views(pair: GearPair, state: str, damage: Damage) -> Iterator[FlankView]:
    for side in Side:
        for tooth in damaged_teeth(damage, side):
            yield flank_view(pair, state, side, tooth, pits_of(damage, side, tooth))


def flank_view(pair: GearPair, state: str, side: Side, tooth: int, damage: Damage) -> FlankView:
    """Return the view of one flank with its damage, which may be none."""
    gear = pair.member(side)
    area_m2 = union_area_m2(gear, damage, pair.face_width_m)
    zones = _flank_zones(pair, side)
    shown = [(one.outline, one.depth_m) for one in damage if one.outline is not None]
    return FlankView(
        state=state,
        gear=side,
        tooth=tooth,
        face_width_mm=1e3 * pair.face_width_m,
        foot_mm=_arc_mm(gear, gear.involute_start_roll_rad),
        start_mm=zones[0].low_mm,
        pitch_mm=_arc_mm(gear, float(np.tan(pair.working_pressure_angle_rad))),
        tip_mm=_arc_mm(gear, gear.tip_roll_rad),
        zones=zones,
        outlines_mm=tuple(_along_the_arc(gear, outline_mm(outline)) for outline, _ in shown),
        depths_mm=tuple(1e3 * depth_m for _, depth_m in shown),
        area_mm2=1e6 * area_m2,
        area_share=area_m2 / (pair.face_width_m * flank_arc_m(gear)),
    )


def _flank_zones(pair: GearPair, side: Side) -> tuple[FlankZone, ...]:
    gear, length = pair.member(side), pair.line_of_action_m
    found = []
    for zone in contact_zones(pair):
        ends = (zone.start_m, zone.end_m) if side == Side.DRIVER else (length - zone.end_m, length - zone.start_m)
        low, high = (_arc_mm(gear, end / gear.base_radius_m) for end in ends)
        found.append(FlankZone(low, high, zone.pairs))
    return tuple(sorted(found, key=lambda zone: zone.low_mm))


def _along_the_arc(gear: SpurGear, outline: FloatArray) -> FloatArray:
    """Return an outline with heights along the tooth's centre line turned into arcs; clipped at base circle and tip."""
    highest_mm = 1e3 * float(gear.height_m(gear.tip_roll_rad))
    roll = gear.roll_at_height(np.clip(outline[:, 1], 0.0, highest_mm) / 1e3)
    return np.stack([outline[:, 0], 500.0 * gear.base_radius_m * roll**2], axis=1)


def _arc_mm(gear: SpurGear, roll: float) -> float:
    return 500.0 * gear.base_radius_m * roll**2


# The picture of `siggen inspect flank`: damaged flanks to scale, pitch line, ends of the active profile, zones.

MOST_FLANKS = 12
"""Flanks of one picture; more would be too small to see a pit."""
MARGIN_MM = 0.4
INCHES_PER_MM = 0.16


def flank_figure(views: Sequence[FlankView]) -> Figure:
    """Return the figure of the first flanks, at most `MOST_FLANKS`; says how many are left out."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    shown = list(views[:MOST_FLANKS])
    columns = 1 if len(shown) <= 4 else 2
    rows = ceil(len(shown) / columns)
    width_mm = max(view.face_width_mm for view in shown)
    height_mm = max(view.tip_mm - view.foot_mm for view in shown)
    size = (
        columns * (INCHES_PER_MM * width_mm * 1.5 + 2.2) + 1.0,
        rows * (INCHES_PER_MM * 1.5 * height_mm + 0.9) + 0.4,
    )
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    colours = ScalarMappable(
        Normalize(0.0, max((depth for view in shown for depth in view.depths_mm), default=0.0) or 1.0), "YlOrRd"
    )
    for axis, view in zip(axes, shown, strict=False):
        draw_flank(axis, view, colours)
    for axis in axes[len(shown) :]:
        axis.set_axis_off()
    figure.colorbar(colours, ax=list(axes), label="depth [mm]", shrink=0.8, aspect=30)
    if len(views) > len(shown):
        figure.suptitle(f"{len(shown)} of {len(views)} damaged flanks; choose others with --state")
    return figure


def draw_flank(axis: Axes, view: FlankView, colours: ScalarMappable) -> None:
    """Draw one flank on axes."""
    import numpy as np
    from matplotlib.patches import Polygon, Rectangle

    axis.set_aspect("equal")
    axis.set_xlim(-MARGIN_MM, view.face_width_mm + MARGIN_MM)
    axis.set_ylim(view.foot_mm - MARGIN_MM, view.tip_mm + MARGIN_MM)
    fewest = min(zone.pairs for zone in view.zones)
    for zone in view.zones:
        shade = "0.84" if zone.pairs == fewest else "0.94"
        axis.add_patch(Rectangle((0, zone.low_mm), view.face_width_mm, zone.high_mm - zone.low_mm, fc=shade, ec="none"))
    outline = Rectangle(
        (0, view.foot_mm), view.face_width_mm, view.tip_mm - view.foot_mm, fc="none", ec="black", lw=1.0
    )
    axis.add_patch(outline)
    # The deepest damage lies on top: where pits overlap, the union has the larger depth.
    for depth_mm, corners in sorted(zip(view.depths_mm, view.outlines_mm, strict=True), key=lambda item: item[0]):
        patch = Polygon(corners, closed=True, fc=colours.to_rgba(np.array([depth_mm]))[0], ec="0.25", lw=0.4)
        axis.add_patch(patch)
        patch.set_clip_path(outline)
    axis.hlines(view.pitch_mm, 0, view.face_width_mm, color="C2", lw=1.0, ls="-.")
    axis.hlines(view.start_mm, 0, view.face_width_mm, color="C5", lw=1.0, ls="--")
    _name_heights(axis, view)
    axis.set_xlabel("across the face [mm]")
    axis.set_ylabel("arc above the\nbase circle [mm]")
    axis.set_title(
        f"{view.state}: {view.gear} tooth {view.tooth}, {len(view.depths_mm)} "
        f"{'spot' if len(view.depths_mm) == 1 else 'spots'}, union {view.area_mm2:.2f} mm² ({view.area_share:.1%})",
        fontsize=10,
    )


def _name_heights(axis: Axes, view: FlankView) -> None:
    """Write what the lines and zones are beside the flank."""
    names = [(view.tip_mm, "tip", "black"), (view.pitch_mm, "pitch line", "C2")]
    names += [(view.start_mm, "start of active profile", "C5")]
    for zone in view.zones:
        names.append((0.5 * (zone.low_mm + zone.high_mm), f"{_NUMBERS.get(zone.pairs, zone.pairs)} contact", "0.45"))
    room = 0.075 * (view.tip_mm - view.foot_mm + 2 * MARGIN_MM)
    last = -float("inf")
    for height, text, colour in sorted(names):
        last = max(height, last + room)
        axis.annotate(
            text,
            (view.face_width_mm + MARGIN_MM, last),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
            color=colour,
            annotation_clip=False,
        )


_NUMBERS = {1: "single", 2: "double", 3: "triple"}


def save_flank_figure(views: Sequence[FlankView], path: Path) -> None:
    """Draw the flanks into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the file cannot be drawn.
    """
    save_figure(lambda: flank_figure(views), path, dpi=120)
