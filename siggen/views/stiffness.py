"""Mesh stiffness curves of one specimen in all its states, over the engagement of the damaged teeth."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from siggen.arrays import FloatArray
from siggen.damage.part import Damage, on_teeth, pits_of
from siggen.errors import UsageError
from siggen.gearbox.specimen import Specimen
from siggen.gears.gear_pair import GearPair
from siggen.mesh.mesh_stiffness import mesh_stiffness, pair_compliance
from siggen.mesh.stiffness_options import StiffnessOptions
from siggen.names import Side
from siggen.record.friction import light_force_n
from siggen.record.specimen_state import static_state
from siggen.record.teeth import MeshTeeth
from siggen.views.pictures import check_picture_file, save_figure
from siggen.views.simulated_contact import SimulatedContact, simulated_contact

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


TOOTH_PARTS = ("foundation", "bending", "shear", "axial")
POINTS_PER_PITCH = 400
BY_ENERGY = "mesh stiffness by potential energy"


@dataclass(frozen=True, slots=True)
class StiffnessCurve:
    """Mesh stiffness of one state against the pinion angle; angle 0: the first damaged tooth enters contact.

    Attributes
    ----------
    state : name of the state
    angle_rad : (k,)
    mesh_stiffness_n_per_m : (k,) as simulated, see `stiffness_meaning`
    parts_m_per_n : name of a part -> (k,) compliance of the pair of the first damaged tooth, NaN where it is not in
        contact; the parts of both teeth from the root to the contact, in the order in which they are drawn. With
        `law: pairs` the contact is that of a pair alone under the torque's force, with what the flanks sink
    simulated : what the simulation makes of the damage, where it acts as geometry; else None
    """

    state: str
    angle_rad: FloatArray
    mesh_stiffness_n_per_m: FloatArray
    parts_m_per_n: Mapping[str, FloatArray]
    simulated: SimulatedContact | None = None


def damaged_engagements(pair: GearPair, damage: Damage) -> tuple[int, int]:
    """Return first and last engagement, counted from angle 0, that meets damage; (0, 0) without any.

    Engagement n is pinion tooth n mod z1 with gear tooth n mod z2; damage of the pinion counts before that of the
    gear.
    """
    teeth = sorted({p.tooth for p in damage if p.gear == Side.DRIVER}) or sorted({p.tooth for p in damage})
    count = pair.pinion.teeth if any(p.gear == Side.DRIVER for p in damage) else pair.gear.teeth
    if not teeth:
        return 0, 0
    # Neighbours may run over the index 0: start behind the widest gap, so that they stay together.
    gaps = [(b - a) % count for a, b in zip(teeth, [*teeth[1:], teeth[0] + count], strict=True)]
    start = int(np.argmax(gaps)) + 1
    ordered = [*teeth[start:], *(t + count for t in teeth[:start])]
    return ordered[0], ordered[-1]


def pitches_shown(engagements: tuple[int, int], points_per_pitch: int) -> FloatArray:
    """Return places in pitches from the first damaged engagement, from one before it to two behind the last (k,)."""
    count = engagements[1] - engagements[0] + 3
    return np.arange(-points_per_pitch, (count - 1) * points_per_pitch + 1) / points_per_pitch


def stiffness_curves(
    specimen: Specimen,
    points_per_pitch: int = POINTS_PER_PITCH,
    torque_nm: float | None = None,
    states: Container[str] | None = None,
    mesh: int = 0,
) -> list[StiffnessCurve]:
    """Return the curve of a mesh in every state, from one pitch before the damage to two pitches behind it.

    Parameters
    ----------
    specimen : Specimen
    points_per_pitch : int, samples over one angular pitch of the pinion
    torque_nm : float, on the mesh's pinion, for damage that acts as geometry; None: that of the first operating point
    states : names of those wanted; None: all. The angles are the same for all
    mesh : int, from 0 in the order of power

    Raises
    ------
    ValueError
        If the drawn damage cannot be computed by the stiffness model (the message names it).
    SolverFailure
        If what was drawn cannot be built.
    UsageError
        If the teeth do not carry the torque.

    Source: paper A, section 2.2, by `siggen.mesh.mesh_stiffness`; where damage acts as geometry, force over
    approach at rest by `siggen.mesh.static_mesh`.
    """
    teeth = MeshTeeth(specimen.law, specimen.meshes[mesh].teeth)
    pair = teeth.pair
    damages = [on_teeth(teeth.damage(i)) for i in range(len(specimen.states))]
    hit = [damaged_engagements(pair, one) for one in damages if one] or [(0, 0)]
    shown = min(first for first, _ in hit), max(last for _, last in hit)
    angle = pitches_shown(shown, points_per_pitch) * 2 * pi / pair.pinion.teeth
    wanted = [i for i, state in enumerate(specimen.states) if states is None or state.name in states]
    words = [gear.column for gear in specimen.names.meshes[mesh].gears]
    across = specimen.law.across_the_face
    curves = [_curve(teeth, words, specimen.states[i].name, damages[i], angle, shown[0], across) for i in wanted]
    if not across:
        return curves
    torque = static_torque_nm(specimen, mesh) if torque_nm is None else torque_nm
    return [
        _as_simulated(specimen.in_state(i), mesh, i, curve, shown[0], torque)
        for i, curve in zip(wanted, curves, strict=True)
    ]


def static_torque_nm(specimen: Specimen, mesh: int = 0) -> float:
    """Return the torque [N m] at which static curves of a mesh are taken: that of the first point above 0.

    Curves are those of drive flanks; without such a point they are taken at a light contact.
    """
    pair, turning = specimen.meshes[mesh].pair, float(specimen.shaft_turns[mesh])
    light = light_force_n(pair) * pair.pinion.base_radius_m
    return next((point.torque_nm / turning for point in specimen.points if point.torque_nm > 0.0), light)


def stiffness_meaning(*, across_the_face: bool, torque_nm: float) -> str:
    """Return in words what a curve of mesh stiffness is."""
    if across_the_face:
        return f"quasi-static mesh stiffness at {torque_nm:.3g}\u00a0N\u00a0m: force over approach, as simulated"
    return BY_ENERGY


def _as_simulated(
    specimen: Specimen, mesh: int, state_id: int, curve: StiffnessCurve, engagement: int, torque_nm: float
) -> StiffnessCurve:
    teeth = MeshTeeth(specimen.law, specimen.meshes[mesh].teeth)
    state, static = static_state(specimen, teeth, state_id)
    pair, angle, contact = state.pair, curve.angle_rad, static.contact
    if contact is None:
        return curve
    most = teeth.teeth.largest_force_n * pair.pinion.base_radius_m
    if torque_nm > most:
        raise UsageError(
            f"torque: received {torque_nm:g} N m; allowed: up to {most:.4g} N m, where the tables of the contact "
            "across the face end: three times the largest torque of the set, or 1.4 GPa on steel"
        )
    stiffness = static.stiffness_n_per_m(torque_nm, angle * pair.pinion.teeth / (2 * pi) + engagement)
    position = pair.engagement_start_m + pair.pinion.base_radius_m * angle
    energy = curve.mesh_stiffness_n_per_m
    found = simulated_contact(static, contact, state.damage, engagement, position, energy, torque_nm)
    of_teeth = {name: value for name, value in curve.parts_m_per_n.items() if name != "contact"}
    parts = {**of_teeth, "contact": found.pair_m_per_n - sum(of_teeth.values())}
    return replace(curve, mesh_stiffness_n_per_m=stiffness, simulated=found, parts_m_per_n=parts)


def _curve(
    teeth: MeshTeeth,
    words: Sequence[str],
    state: str,
    damage: Damage,
    angle: FloatArray,
    engagement: int,
    open_face: bool,
) -> StiffnessCurve:
    pair, options = teeth.pair, teeth.options
    offset = engagement * 2 * pi / pair.pinion.teeth
    stiffness = mesh_stiffness(pair, angle + offset, options, damage, through_face=open_face)
    return StiffnessCurve(state, angle, stiffness, _parts(pair, words, options, damage, angle, engagement, open_face))


def _parts(
    pair: GearPair,
    gears: Sequence[str],
    options: StiffnessOptions,
    damage: Damage,
    angle: FloatArray,
    engagement: int,
    open_face: bool,
) -> dict[str, FloatArray]:
    """Return the compliances of one engagement's pair over the angle since it entered contact, (k,) each [m/N].

    With `open_face` the contact's may be infinite: damage through the face leaves none.
    """
    position = pair.engagement_start_m + pair.pinion.base_radius_m * angle
    inside = (angle >= 0.0) & (position >= pair.contact_start_m) & (position <= pair.contact_end_m)
    on_pinion = pits_of(damage, Side.DRIVER, engagement % pair.pinion.teeth)
    on_gear = pits_of(damage, Side.DRIVEN, engagement % pair.gear.teeth)
    found = pair_compliance(pair, position[inside], options, on_pinion, on_gear, through_face=open_face)
    parts = {
        f"{name}_{part}": getattr(getattr(found, side), part)
        for side, name in zip(Side, gears, strict=True)
        for part in TOOTH_PARTS
    }
    return {name: _spread(inside, values) for name, values in {**parts, "contact": found.contact}.items()}


def _spread(inside: NDArray[np.bool_], values: FloatArray) -> FloatArray:
    out = np.full(inside.size, np.nan)
    out[inside] = values
    return out


def curve_table(curves: list[StiffnessCurve], *, parts: bool = False, potential_energy: bool = False) -> pa.Table:
    """Return the curves as a table: the angle in degrees, and one column `<state>_n_per_m` for every state.

    Where damage acts as geometry also `<state>_sink_um` and `<state>_land_share` of the first damaged tooth's pair,
    null where that pair is not in contact, and with `potential_energy` also `<state>_potential_energy_n_per_m`.
    With `parts` also `<state>_<part>_m_per_n` for every part of the compliance of the first damaged tooth's pair,
    null where that pair is not in contact.
    """
    columns = {"angle_deg": pa.array(np.degrees(curves[0].angle_rad))}
    columns |= {f"{curve.state}_n_per_m": pa.array(curve.mesh_stiffness_n_per_m) for curve in curves}
    for curve in curves:
        if curve.simulated is not None:
            found = {"sink_um": curve.simulated.sink_um, "land_share": curve.simulated.land_share}
            if potential_energy:
                found["potential_energy_n_per_m"] = curve.simulated.potential_energy_n_per_m
            columns |= {f"{curve.state}_{name}": pa.array(v, mask=np.isnan(v)) for name, v in found.items()}
        if parts:
            for name, values in curve.parts_m_per_n.items():
                columns[f"{curve.state}_{name}_m_per_n"] = pa.array(values, mask=np.isnan(values))
    return pa.table(columns)


# The picture of `siggen inspect tvms`: mesh stiffness of all states, its loss, and the parts of one pair.

__all__ = ["check_picture_file", "save_stiffness_figure", "stiffness_figure"]

COLOURS, DASHES = 10, ("-", "--", ":")
"""Each ten states have a dash of their own, so that no two of thirty look alike."""
NOT_USED = "by potential energy,\nnot used by this set"
SHADES = ("Blues", "Greens")
"""Of the driver and of the driven gear."""


def stiffness_figure(
    curves: Sequence[StiffnessCurve], *, parts: bool = False, potential_energy: bool = False, title: str = ""
) -> Figure:
    """Return the figure; the loss is drawn against the first curve, which is the healthy one where there is one.

    Where damage acts as geometry, panels show sink and land of the first damaged tooth's pair, and `potential_energy`
    adds the dotted curves that the simulation does not use. With `parts` the last panel stacks the compliances of the
    pair that carries the first damaged tooth, in the last state.
    """
    from matplotlib.figure import Figure

    simulated = any(curve.simulated is not None for curve in curves)
    has_land = any(c.simulated is not None and np.isfinite(c.simulated.land_share).any() for c in curves)
    panels = {"stiffness": 3, "loss": 2} | ({"sink": 2} if simulated else {})
    panels |= ({"land": 2} if has_land else {}) | ({"parts": 3} if parts else {})
    figure = Figure(figsize=(8.0, 1.0 + sum(panels.values())), layout="constrained")
    axes = dict(
        zip(panels, figure.subplots(len(panels), 1, sharex=True, height_ratios=list(panels.values())), strict=True)
    )
    for depth, curve in enumerate(curves):  # milder states lie on top: where curves agree, the mildest is seen
        style: dict[str, Any] = {"color": f"C{depth % COLOURS}", "ls": DASHES[depth // COLOURS % len(DASHES)]}
        style |= {"lw": 1.2, "zorder": 2 + len(curves) - depth}
        _draw_curve(axes, curve, curves[0], style)
    axes["stiffness"].set_ylabel("mesh stiffness [10⁸ N/m]")
    axes["stiffness"].set_title(title, fontsize=10)
    figure.legend(
        *axes["stiffness"].get_legend_handles_labels(),
        loc="outside upper center", frameon=False, ncols=min(len(curves), 5),
    )  # fmt: skip
    if potential_energy and simulated:
        _draw_potential_energy(axes["stiffness"], curves)
    axes["loss"].set_ylabel(f"loss against {curves[0].state} [%]")
    axes["loss"].margins(x=0)
    if simulated:
        axes["sink"].set_ylabel("sink of the\ndamaged pair [µm]")
    if has_land:
        axes["land"].set_ylabel("land of the\ndamaged pair [% of face]")
    if parts:
        _stack(axes["parts"], curves[-1])
    list(axes.values())[-1].set_xlabel("angle of the driving gear since the first damaged tooth entered contact [°]")
    return figure


def _draw_potential_energy(axis: Axes, curves: Sequence[StiffnessCurve]) -> None:
    for depth, curve in enumerate(curves):
        if curve.simulated is not None:
            energy = curve.simulated.potential_energy_n_per_m / 1e8
            (line,) = axis.plot(
                np.degrees(curve.angle_rad), energy, color=f"C{depth % COLOURS}", ls=":", lw=0.9, zorder=1.9
            )
    axis.legend([line], [NOT_USED], loc="lower left", frameon=False, fontsize=8)


def _draw_curve(
    axes: Mapping[str, Axes], curve: StiffnessCurve, reference: StiffnessCurve, style: Mapping[str, Any]
) -> None:
    degrees = np.degrees(curve.angle_rad)
    axes["stiffness"].plot(degrees, curve.mesh_stiffness_n_per_m / 1e8, label=curve.state, **style)
    if curve is not reference:
        loss = 1.0 - curve.mesh_stiffness_n_per_m / reference.mesh_stiffness_n_per_m
        axes["loss"].plot(degrees, 100.0 * loss, **style)
    if curve.simulated is not None:
        axes["sink"].plot(degrees, curve.simulated.sink_um, **style)
        if "land" in axes:
            axes["land"].plot(degrees, 100.0 * curve.simulated.land_share, **style)


def _stack(axis: Axes, curve: StiffnessCurve) -> None:
    from matplotlib import colormaps

    inside = ~np.isnan(curve.parts_m_per_n["contact"])
    names = list(curve.parts_m_per_n)  # those of both teeth, and the contact
    shades = [0.75, 0.55, 0.4, 0.25]
    colours = [*(colormaps[colour](shade) for colour in SHADES for shade in shades), "C6"]
    layers = [1e9 * curve.parts_m_per_n[name][inside] for name in names]
    axis.stackplot(np.degrees(curve.angle_rad[inside]), layers, labels=names, colors=colours)
    axis.set_ylabel(f"compliance of the damaged\ntooth's pair, {curve.state} [10⁻⁹ m/N]")
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=8)


def save_stiffness_figure(curves: Sequence[StiffnessCurve], path: Path, **options: Any) -> None:
    """Draw the curves into a file; options as those of `stiffness_figure`.

    Raises
    ------
    UsageError
        If matplotlib is missing or the ending is none that it draws.
    """
    save_figure(lambda: stiffness_figure(curves, **options), path)
