"""FacePressure: load and pressure over one flank while its tooth goes through mesh in a record."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil, pi
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa

from siggen.arrays import FloatArray
from siggen.damage.part import damaged_teeth, has_extent, pits_of
from siggen.errors import UsageError
from siggen.gearbox.plan import PlannedRecord
from siggen.gearbox.specimen import OperatingPoint, Specimen
from siggen.keys.problems import nearest
from siggen.mesh.contact_names import PAIR_PREFIX
from siggen.mesh.contact_table import KindRow, TableSolver, kind_row, row_faces, table_solver
from siggen.mesh.face_force import loads_under_force, slice_pressures
from siggen.mesh.table_options import face_slices
from siggen.mesh.tooth_law import ToothLaw
from siggen.names import MeshName, Names, Side
from siggen.record.contact import face_options
from siggen.record.internals import record_internals
from siggen.record.specimen_state import SpecimenState, refused_as
from siggen.record.teeth import MeshTeeth, all_teeth
from siggen.views.flank import FlankView, flank_view
from siggen.views.pictures import save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


POSITIONS = 161
"""Along the path of contact: every 0.09 mm of arc on the flanks of a module of 3 mm."""


@dataclass(frozen=True, slots=True)
class FacePressure:
    """One engagement of a record.

    Attributes
    ----------
    view : the flank that is looked at, with its damage
    point : speed and torque of the record
    roll_deg : (k,) turn of the pinion since the pair entered contact
    arc_mm : (k,) of the contact above the base circle, on that flank
    face_mm : (n,) middles of the slices
    force_n, tilt_rad : (k,) of this pair, and of the flanks against each other, in the record
    line_load_n_per_mm, pressure_mpa : (k, n)
    at_edge : (k, n) whether edges of damage carry more than Hertz's pressure
    edge_radius_mm : of the damage, as drawn
    """

    view: FlankView
    point: OperatingPoint
    roll_deg: FloatArray
    arc_mm: FloatArray
    face_mm: FloatArray
    force_n: FloatArray
    tilt_rad: FloatArray
    line_load_n_per_mm: FloatArray
    pressure_mpa: FloatArray
    at_edge: FloatArray
    edge_radius_mm: float


def face_pressure(
    gearbox: Specimen, record: PlannedRecord, gear: str | None = None, tooth: int | None = None
) -> FacePressure:
    """Return load and pressure over a flank while its tooth goes through mesh, first in a record.

    Force of the pair and tilt are those of the motion; how they spread is solved across the face, with damage,
    crowning, helix and misalignment, whatever contact the record itself was simulated with.

    Parameters
    ----------
    gearbox : Specimen
    record : PlannedRecord
    gear, tooth : as damage names it, such as 'pinion', of a machine by its own name, and an index; None:
        the first damaged tooth, else tooth 0 of the first pinion

    Raises
    ------
    UsageError
        If there is no such tooth, it is not in mesh in the record, or the mesh law has no pairs.
    SolverFailure
        If the record cannot be simulated, or a contact cannot be solved.
    """
    if not gearbox.law.across_the_face:
        raise UsageError(
            "dynamics.mesh.law: received linear; allowed: pairs, whose tooth pairs have forces of their own"
        )
    if gearbox.planets is not None:
        raise UsageError(
            "planetary: received a section; allowed: null for pressures of a flank, which knows no carrier. "
            "`siggen show --internals` writes the forces of all meshes of a record"
        )
    called = None if gear is None else _gear_called(gearbox.names, gear)
    specimen = gearbox.in_state(record.state_id)
    torque_nm = specimen.points[record.operating_point_id].torque_nm
    if torque_nm < 0.0:
        raise UsageError(
            f"record {record.record_id} has a torque of {torque_nm:g} N m, under which the back flanks carry; allowed: "
            "a record with a torque from 0, which loads the drive flanks, where damage is"
        )
    state, point, angle_rad, found = record_internals(specimen, record)
    meshes = list(_meshes(specimen, state, point, angle_rad))
    mesh, side, tooth = _looked_at(meshes, called, tooth)
    engagement = _engagement(mesh, side, tooth)
    with refused_as("outside_model"):
        return _solved(specimen.law, mesh, record.state_id, (side, tooth, engagement), found)


def pressure_table(pressure: FacePressure) -> pa.Table:
    """Return one row per position and slice."""
    k, n = pressure.pressure_mpa.shape
    columns = {
        "roll_deg": np.repeat(pressure.roll_deg, n),
        "arc_mm": np.repeat(pressure.arc_mm, n),
        "face_mm": np.tile(pressure.face_mm, k),
        "pair_force_n": np.repeat(pressure.force_n, n),
        "tilt_rad": np.repeat(pressure.tilt_rad, n),
        "line_load_n_per_mm": pressure.line_load_n_per_mm.ravel(),
        "largest_pressure_mpa": pressure.pressure_mpa.ravel(),
        "at_edge": pressure.at_edge.ravel() > 0.0,
    }
    return pa.table(columns)


@dataclass(frozen=True, slots=True)
class _Mesh:
    """One mesh of a record, as if it were its only one.

    `prefix`: what quantities of its pairs begin with; `words`: what its pinion and its gear are called.
    """

    prefix: str
    teeth: MeshTeeth
    state: SpecimenState
    point: OperatingPoint
    angle_rad: FloatArray
    words: Mapping[Side, str]


def _meshes(specimen: Specimen, state: SpecimenState, point: OperatingPoint, angle_rad: FloatArray) -> Iterator[_Mesh]:
    """Yield every mesh of a record, each with the angle of its own pinion."""
    prefixes = [specimen.names.quantity(mesh, PAIR_PREFIX) for mesh in specimen.names.meshes]
    words, teeth = [_words(mesh) for mesh in specimen.names.meshes], all_teeth(specimen)
    yield _Mesh(prefixes[0], teeth[0], state, point, angle_rad, words[0])
    for number, (own, behind) in enumerate(zip(state.behind, state.mesh.behind, strict=True), start=1):
        turned = angle_rad * behind.turning + behind.turned_pitches * 2.0 * pi / own.pair.pinion.teeth
        yield _Mesh(prefixes[number], teeth[number], own, behind.at(point), turned, words[number])


def _words(mesh: MeshName) -> Mapping[Side, str]:
    return dict(zip(Side, (gear.word for gear in mesh.gears), strict=True))


def _gear_called(names: Names, gear: str) -> str:
    """Return what a user calls a gear if there is one of that name."""
    called = [one.word for one in names.gears]
    if gear not in called:
        raise UsageError(f"--tooth {gear}; allowed: {', '.join(called)}{nearest(gear, called)}")
    return gear


def _looked_at(meshes: Sequence[_Mesh], called: str | None, tooth: int | None) -> tuple[_Mesh, Side, int]:
    """Return the mesh, which of its gears, and the tooth that are looked at."""
    gears = [(mesh, side) for mesh in meshes for side in Side]
    teeth = [(mesh, side, index) for mesh, side in gears for index in damaged_teeth(mesh.state.damage, side)]
    if called is None:
        mesh, side = teeth[0][:2] if teeth and tooth is None else gears[0]
    else:
        mesh, side = next(one for one in gears if one[0].words[one[1]] == called)
    if tooth is None:
        tooth = next((index for one, gear, index in teeth if one is mesh and gear == side), 0)
    count = mesh.state.pair.member(side).teeth
    if not 0 <= tooth < count:
        raise UsageError(f"--tooth {tooth}: {mesh.words[side]} has {count} teeth; allowed: 0 to {count - 1}")
    return mesh, side, tooth


def _engagement(mesh: _Mesh, side: Side, tooth: int) -> int:
    """Return the number of the first engagement of a tooth that lies within the record."""
    pair, angle_rad = mesh.state.pair, mesh.angle_rad
    pitch, teeth = 2.0 * pi / pair.pinion.teeth, pair.member(side).teeth
    first = ceil(float(angle_rad[0]) / pitch)
    number = first + (tooth - first) % teeth
    last = number * pitch + (pair.contact_end_m - pair.contact_start_m) / pair.pinion.base_radius_m
    if last > angle_rad[-1]:
        turns = (angle_rad[-1] - angle_rad[0]) / (2.0 * pi)
        raise UsageError(
            f"{mesh.words[side]} tooth {tooth} goes through mesh nowhere within the record, {turns:.2f} turns of the "
            f"{mesh.words[Side.DRIVER]}; allowed: another --tooth, or a longer record (--set duration_s=...)"
        )
    return number


def _solved(
    law: ToothLaw, mesh: _Mesh, state_id: int, looked_at: tuple[Side, int, int], found: Mapping[str, FloatArray]
) -> FacePressure:
    gear, tooth, number = looked_at
    state, pair, angle_rad = mesh.state, mesh.state.pair, mesh.angle_rad
    options = face_options(law, mesh.teeth.teeth.largest_force_n, pair)
    errors = mesh.teeth.errors(state_id)
    slices = face_slices(pair, options)
    lead = np.zeros(slices) if errors is None else errors.lead_m(slices)
    solver = table_solver(pair, state.options, options, lead - lead.min())
    shown = tuple(one for one in state.damage if has_extent(one))
    pits = tuple(pits_of(shown, side, number % pair.member(side).teeth) for side in Side)
    row = kind_row(pair, state.options, options, POSITIONS, (pits[0], pits[1]))
    entered = number * 2.0 * pi / pair.pinion.teeth
    roll = (row.position_m - pair.contact_start_m) / pair.pinion.base_radius_m
    slot = number % sum(name.endswith("_force_n") and name.startswith(mesh.prefix) for name in found)
    # a back flank that is met on the way is another flank
    force = np.interp(entered + roll, angle_rad, np.maximum(found[f"{mesh.prefix}{slot}_force_n"], 0.0))
    tilt = np.interp(entered + roll, angle_rad, found.get("mesh_tilt_rad", np.zeros(angle_rad.size)))
    load, pressure, at_edge = _over_positions(solver, row, force, tilt)
    member = pair.member(gear)
    along = row.position_m if gear == Side.DRIVER else pair.line_of_action_m - row.position_m
    view = flank_view(pair, str(state.labels["state"]), gear, tooth, pits_of(shown, gear, tooth))
    return FacePressure(
        view=replace(view, gear=mesh.words[gear]),
        point=mesh.point,
        roll_deg=np.degrees(roll),
        arc_mm=1e3 * along**2 / (2.0 * member.base_radius_m),
        face_mm=1e3 * pair.face_width_m * (np.arange(slices) + 0.5) / slices,
        force_n=force,
        tilt_rad=tilt,
        line_load_n_per_mm=1e-3 * load,
        pressure_mpa=1e-6 * pressure,
        at_edge=at_edge,
        edge_radius_mm=1e3 * row.edge_radius_m,
    )


def _over_positions(
    solver: TableSolver, row: KindRow, force_n: FloatArray, tilt_rad: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return load [N/m], pressure [Pa] and whether edges press hardest, (k, n) each."""
    faces = row_faces(solver, row, np.arange(row.position_m.size))
    answers = [
        slice_pressures(slices, loads_under_force(slices, float(force), float(tilt)))
        for slices, force, tilt in zip(faces, force_n, tilt_rad, strict=True)
    ]
    load, pressure, at_edge = (np.stack(values) for values in zip(*answers, strict=True))
    return load, pressure, at_edge


# The picture of `siggen inspect pressure`: pressure over a flank with its damage, load per length across the face.

COLOURS = ("C2", "C3", "tab:purple", "tab:brown", "tab:pink", "tab:cyan")
"""Of the positions that are drawn one by one; as many of them at most."""


def chosen_positions(pressure: FacePressure) -> list[int]:
    """Return a quarter of the engagement, three quarters, and where the pressure is largest."""
    worst = int(np.argmax(_finite(pressure).max(axis=1)))
    count = pressure.roll_deg.size
    return sorted({count // 4, worst, 3 * count // 4})


def pressure_figure(pressure: FacePressure, positions: Sequence[int]) -> Figure:
    """Return the figure; the lines across the face are those of the positions."""
    from matplotlib.figure import Figure

    view = pressure.view
    figure = Figure(figsize=(12.5, 7.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(2.1, 1.0), height_ratios=(1.15, 1.0))
    flank = figure.add_subplot(grid[0, 0])
    along = figure.add_subplot(grid[0, 1], sharey=flank)
    across = figure.add_subplot(grid[1, 0], sharex=flank)
    course = figure.add_subplot(grid[1, 1])
    _draw_flank(figure, flank, pressure, positions)
    _draw_along(along, pressure, positions)
    _draw_across(across, pressure, positions)
    _draw_course(course, pressure, positions)
    figure.suptitle(
        f"{view.state}: {view.gear} tooth {view.tooth} at {pressure.point.torque_nm:.3g} N m, "
        f"{pressure.point.speed_hz:.3g} Hz\n{largest_text(pressure)}",
        fontsize=10,
    )
    return figure


def largest_text(pressure: FacePressure) -> str:
    """Return the largest elastic pressures in words: Hertz's, and that at the edges of damage with their radius."""
    plain = float(pressure.pressure_mpa[pressure.at_edge == 0.0].max(initial=0.0))
    text = f"largest Hertz pressure {plain:,.0f} MPa"
    if not pressure.at_edge.any():
        return text
    worst = float(pressure.pressure_mpa[pressure.at_edge > 0.0].max())
    if np.isinf(worst):
        return f"{text}; edges of damage are sharp, so elastic pressure has no bound there"
    return (
        f"{text}; largest elastic pressure at edges of {pressure.edge_radius_mm:.3g} mm radius {worst:,.0f} MPa "
        "(steel yields below)"
    )


def save_pressure_figure(pressure: FacePressure, positions: Sequence[int], path: Path) -> None:
    """Draw the pressure into a file.

    Raises
    ------
    UsageError
        If matplotlib is missing or the file cannot be drawn.
    """
    save_figure(lambda: pressure_figure(pressure, positions), path, dpi=120)


def _finite(pressure: FacePressure) -> np.ndarray:
    return np.where(np.isfinite(pressure.pressure_mpa), pressure.pressure_mpa, 0.0)


def _draw_flank(figure: Figure, axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    from matplotlib.colors import PowerNorm
    from matplotlib.patches import Polygon

    view, values = pressure.view, _finite(pressure)
    # Edges press several times harder than land: the root keeps both readable.
    norm = PowerNorm(0.5, 0.0, values.max() or 1.0)
    loaded = np.ma.masked_equal(values, 0.0)
    image = axis.pcolormesh(
        pressure.face_mm, pressure.arc_mm, loaded, norm=norm, cmap="magma_r", shading="nearest", rasterized=True
    )
    figure.colorbar(image, ax=axis, label="largest pressure [MPa]", location="top", aspect=45, shrink=0.9)
    for corners in view.outlines_mm:
        axis.add_patch(Polygon(corners, closed=True, fc="none", ec="C5", lw=1.4))
    axis.axhline(view.pitch_mm, color="tab:cyan", lw=1.0, ls="-.")
    axis.annotate("pitch line", (0.1, view.pitch_mm), fontsize=8, color="C2", va="bottom")
    for colour, at in zip(COLOURS, positions, strict=False):
        axis.axhline(float(pressure.arc_mm[at]), color=colour, lw=1.0, ls="--")
    axis.set_xlim(0.0, view.face_width_mm)
    axis.set_ylim(float(pressure.arc_mm.min()), float(pressure.arc_mm.max()))
    axis.set_xlabel("across the face [mm]")
    axis.set_ylabel("arc above the base circle [mm]")
    axis.set_title("pressure while the tooth goes through mesh; white: no load; green: damage", fontsize=10)


def _draw_along(axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    values = _finite(pressure)
    axis.plot(np.where(pressure.at_edge > 0.0, 0.0, values).max(axis=1), pressure.arc_mm, color="0.3", label="Hertz")
    if pressure.at_edge.any():
        edges = np.where(pressure.at_edge > 0.0, values, np.nan)
        worst = np.where(pressure.at_edge.any(axis=1), np.nan_to_num(edges).max(axis=1), np.nan)
        label = f"edges of {pressure.edge_radius_mm:.3g} mm"
        axis.plot(worst, pressure.arc_mm, color="C6", label=label)
    for colour, at in zip(COLOURS, positions, strict=False):
        axis.axhline(float(pressure.arc_mm[at]), color=colour, lw=1.0, ls="--")
    axis.set_xlim(left=0.0)
    axis.set_xlabel("largest pressure across the face [MPa]")
    axis.set_ylabel("arc above the base circle [mm]")
    axis.locator_params(axis="x", nbins=5)
    axis.legend(fontsize=8, loc="best")


def _draw_across(axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    for colour, at in zip(COLOURS, positions, strict=False):
        label = f"{pressure.roll_deg[at]:.1f}°, {pressure.force_n[at]:,.0f} N"
        label += f", tilt {1e6 * pressure.tilt_rad[at]:+.1f} µrad" if np.any(pressure.tilt_rad) else ""
        axis.plot(pressure.face_mm, pressure.line_load_n_per_mm[at], color=colour, label=label)
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("across the face [mm]")
    axis.set_ylabel("load per length [N/mm]")
    axis.legend(fontsize=8, title_fontsize=8, title="angle of the driving gear since first contact, force of the pair")


def _draw_course(axis: Axes, pressure: FacePressure, positions: Sequence[int]) -> None:
    axis.plot(pressure.roll_deg, pressure.force_n, color="0.3")
    for colour, at in zip(COLOURS, positions, strict=False):
        axis.axvline(float(pressure.roll_deg[at]), color=colour, lw=1.0, ls="--")
    axis.set_ylim(bottom=0.0)
    axis.set_xlabel("angle of the driving gear since first contact [°]")
    axis.set_ylabel("force of the pair in the record [N]")
