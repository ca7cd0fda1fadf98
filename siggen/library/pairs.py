"""A pair of gears with damage: its mesh stiffness over the angle, and pictures of its flanks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from math import pi
from typing import Any

import numpy as np

from siggen.arrays import FloatArray
from siggen.damage.growth import Growth
from siggen.damage.heights import flank_heights
from siggen.damage.lost_shape import POINTS, LostShape
from siggen.damage.on_flank import with_outlines
from siggen.damage.part import Parts, on_teeth, pits_of
from siggen.errors import ConfigError, Problem
from siggen.gearbox.mesh_damage import damage_sections
from siggen.gearbox.teeth import typical_tooth_law
from siggen.gears.gear_pair import GearPair
from siggen.library.arguments import finite, of_kind, one_of, refused, saying
from siggen.library.axes import drawing, legend_above, new_axes
from siggen.library.damage import Damage, DamagedPlace, all_damages, entries
from siggen.library.gearbox import Gearbox
from siggen.library.shape_fault import ShapeFault
from siggen.mesh.mesh_stiffness import mesh_stiffness as by_potential_energy
from siggen.mesh.mesh_tables import TABLE_POINTS
from siggen.mesh.stiffness_options import TOOTH_MODELS, StiffnessOptions
from siggen.names import SECTIONS, Side
from siggen.record.contact import tooth_tables
from siggen.record.static_mesh import static_mesh
from siggen.record.teeth import load_at_rest
from siggen.rig.rating import bearable_torque_nm, rated_torque_nm
from siggen.views.chosen_mesh import chosen_mesh
from siggen.views.flank import draw_flank, flank_view
from siggen.views.stiffness import (
    BY_ENERGY,
    POINTS_PER_PITCH,
    damaged_engagements,
    pitches_shown,
    static_torque_nm,
    stiffness_curves,
    stiffness_meaning,
)

__all__ = ["Curve", "flank_picture", "mesh_stiffness"]

LAWS = ("pairs", "linear")


@dataclass(frozen=True, repr=False)
class Curve:
    """Mesh stiffness over the angle of the driving gear.

    Attributes
    ----------
    angle_rad : (points,)
        From one pitch before the first damaged tooth enters contact, at 0, to two pitches after the last one does.
    stiffness_n_per_m : (points,)
    meaning : str
        What it is, with the torque.
    """

    angle_rad: FloatArray
    stiffness_n_per_m: FloatArray
    meaning: str

    def __repr__(self) -> str:
        """One line."""
        low, high = self.stiffness_n_per_m.min(), self.stiffness_n_per_m.max()
        return f"Curve({self.angle_rad.size} points, {low:.3g} to {high:.3g} N/m; {self.meaning})"

    def plot(self, ax: Any = None, *, label: str = "") -> Any:
        """Draw it and return the axes; None: those that are current, or of a new figure."""
        with drawing() as plt:
            ax = (plt.gca() if plt.get_fignums() else new_axes(plt)) if ax is None else ax
            ax.plot(np.degrees(self.angle_rad), self.stiffness_n_per_m / 1e8, label=label or None)
            ax.set(xlabel="angle of the driving gear [°]", ylabel="mesh stiffness [10⁸ N/m]")
            ax.margins(x=0)
            if label:
                legend_above(ax)
        return ax


def mesh_stiffness(
    of: GearPair | Gearbox,
    damages: Iterable[Damage] | str = (),
    *,
    law: str | None = None,
    torque_nm: float | None = None,
    tooth: str | None = None,
    mesh: str | None = None,
    points_per_pitch: int = POINTS_PER_PITCH,
) -> Curve:
    """Return the mesh stiffness of a pair with damage on its teeth, or of a gearbox in a state.

    Parameters
    ----------
    of : GearPair or Gearbox
        Gears of a pair are `pinion` and `gear`. A gearbox has its errors, tooth model and law.
    damages : iterable of Damage, or str
        On teeth of the pair. Of a gearbox the name of a state; default `healthy`.
    law : str
        Of a pair; default 'pairs': force over approach at rest under a torque, the contact solved across the face.
        'linear': by potential energy, the contact as long as damage leaves it (paper A, section 2.2).
    torque_nm : float
        On the driving gear, for `pairs` [N m]; default what the pair is rated for (ISO 6336-5, case-hardened), of a
        gearbox its first point above 0.
    tooth : str
        Of a pair, the tooth that bends; default 'calibrated' (finite elements). 'base_circle' (paper A),
        'root_circle', 'rack_trochoid'.
    mesh : str
        Of a gearbox with several; default the first.
    points_per_pitch : int
        1 to 100000 of them over one angular pitch of the driving gear.

    Returns
    -------
    Curve
        All states of a gearbox have the same angles.

    Raises
    ------
    UsageError
        If an argument or a damage cannot be: names it, what came and what is allowed.
    """
    allowed = "1 to 100000"
    finite("points_per_pitch", of_kind("points_per_pitch", points_per_pitch, int, allowed), allowed, 1, 100_000)
    if isinstance(of, Gearbox):
        for argument, value in (("law", law), ("tooth", tooth)):
            if value is not None:
                raise refused(argument, repr(value), "nothing for a gearbox, which has its own")
        return _of_gearbox(of, damages or "healthy", torque_nm, mesh, points_per_pitch)
    if mesh is not None:
        raise refused("mesh", repr(mesh), "nothing for a pair, which is one mesh")
    return _of_pair(of, damages, law or LAWS[0], torque_nm, tooth or "calibrated", points_per_pitch)


def _of_gearbox(
    gearbox: Gearbox, state: object, torque_nm: float | None, mesh: str | None, points_per_pitch: int
) -> Curve:
    name = one_of("damages", state, [one.name for one in gearbox.states])
    design = gearbox._with_passed(gearbox._design)
    with saying({"torque": "torque_nm"}):
        specimen = design.gearbox(gearbox.number)
        number = chosen_mesh(specimen, mesh, "mesh")
        torque = static_torque_nm(specimen, number)
        torque = torque if torque_nm is None else finite("torque_nm", torque_nm, "a number above 0", 1e-9)
        (curve,) = stiffness_curves(specimen, points_per_pitch, torque_nm=torque, states=(name,), mesh=number)
    return Curve(
        curve.angle_rad,
        curve.mesh_stiffness_n_per_m,
        stiffness_meaning(across_the_face=specimen.law.across_the_face, torque_nm=torque),
    )


def _of_pair(
    pair: GearPair, damages: Iterable[Damage] | str, law: str, torque_nm: float | None, tooth: str, points: int
) -> Curve:
    one_of("law", law, LAWS)
    options = StiffnessOptions(one_of("tooth", tooth, TOOTH_MODELS), coupling="body" if law == "pairs" else "none")
    teeth = typical_tooth_law()
    parts = _parts(pair, damages, law, partial(load_at_rest, teeth, pair, options))
    on_tooth = on_teeth(parts)
    shown = damaged_engagements(pair, tuple(with_outlines(parts, pair)) or on_tooth)
    # in the middle of steps: at a whole pitch, where pairs come and go, rounding would decide how many there are
    pitches = pitches_shown(shown, points)[:-1] + 0.5 / points
    angle = pitches * 2.0 * pi / pair.pinion.teeth
    if law == "linear":
        try:
            stiffness = by_potential_energy(pair, angle + shown[0] * 2.0 * pi / pair.pinion.teeth, options, on_tooth)
        except ValueError as error:
            raise refused("damages", str(error), "pits that leave contact and section, or law='pairs'") from None
        return Curve(angle, stiffness, BY_ENERGY)
    sizes = (pair.pinion.teeth, pair.gear.teeth), 1e3 * pair.driver.module_m, 1e3 * pair.face_width_m
    most = bearable_torque_nm(*sizes)
    torque = rated_torque_nm(*sizes) if torque_nm is None else torque_nm
    torque = finite("torque_nm", torque, f"above 0 up to {most:.4g}, which the teeth bear", 1e-9, most)
    force = torque / pair.pinion.base_radius_m
    tables = tooth_tables(teeth, pair, on_tooth, options, TABLE_POINTS, force)
    static = static_mesh(teeth, pair, tables, TABLE_POINTS, parts)
    stiffness = static.stiffness_n_per_m(torque, pitches + shown[0])
    return Curve(angle, stiffness, stiffness_meaning(across_the_face=True, torque_nm=torque))


def flank_picture(pair: GearPair, damages: Iterable[Damage], ax: Any = None, *, on: str = "", tooth: int = -1) -> Any:
    """Draw a damaged flank to scale, and return the axes.

    Parameters
    ----------
    pair : GearPair
    damages : iterable of Damage
        On teeth of its gears.
    ax : axes of matplotlib; None: those of a new figure
    on, tooth : str, int
        Which flank; default that of the first damage.

    Raises
    ------
    UsageError
        If a damage cannot be, or matplotlib is missing.
    """
    parts = with_outlines(_parts(pair, damages, "pairs", None), pair)
    finite("tooth", tooth, "an index from 0")
    on = on or next((one.gear for one in parts), Side.DRIVER)
    tooth = next((one.tooth for one in parts if one.gear == on), 0) if tooth < 0 else tooth
    own = pits_of(parts, Side(one_of("on", on, SECTIONS)), tooth)
    view = flank_view(pair, "", Side(on), tooth, own)
    with drawing() as plt:
        if ax is None:
            height = view.tip_mm - view.foot_mm
            size = 1.5 + 6.0, 1.2 + 6.0 * height / view.face_width_mm
            ax = plt.subplots(figsize=size, layout="constrained")[1]
        shades = plt.cm.ScalarMappable(plt.Normalize(0.0, max(view.depths_mm, default=0.0) or 1.0), "YlOrRd")
        draw_flank(ax, view, shades)
        shapes = [one for one in own if isinstance(one, LostShape)]
        if shapes:
            _draw_shapes(ax, pair, shapes, shades)
        ax.set_title(
            f"{on}, tooth {tooth}: union of outlines {view.area_mm2:.2f} mm² ({view.area_share:.1%})"
            if view.area_mm2
            else f"{on}, tooth {tooth}"
        )
        ax.figure.colorbar(shades, ax=ax, label="depth [mm]", shrink=0.8)
    return ax


def _draw_shapes(ax: Any, pair: GearPair, shapes: Sequence[LostShape], shades: Any) -> None:
    gear, slices = pair.member(shapes[0].gear), 200
    depth_mm = 1e3 * np.max([one.depths_m(pair, slices) for one in shapes], axis=0)
    roll = gear.roll_at_height(np.linspace(*flank_heights(gear), POINTS))
    face_mm = 1e3 * pair.face_width_m / slices * (np.arange(slices) + 0.5)
    shades.set_clim(0.0, max(shades.norm.vmax if shades.norm.vmax != 1.0 else 0.0, float(depth_mm.max())))
    ax.pcolormesh(face_mm, 500.0 * gear.base_radius_m * roll**2, np.ma.masked_less(depth_mm, 1e-4),
                  cmap=shades.cmap, norm=shades.norm, shading="nearest", rasterized=True)  # fmt: skip


def _seat(pair: GearPair, damage: Damage) -> DamagedPlace:
    side = one_of("on", damage.on, SECTIONS)
    return DamagedPlace(pair, Side(side), side)


def _parts(pair: GearPair, damages: Iterable[Damage] | str, law: str, loads: Any) -> Parts:
    """Return damages on the teeth of a pair."""
    of_kind("pair", pair, GearPair, "a GearPair, such as GearPair.of(teeth=(18, 47), module_mm=3.5, face_width_mm=20)")
    damages = all_damages(damages)
    written, arguments = entries(damages, partial(_seat, pair))
    shapes = [(number, one) for number, one in enumerate(damages) if one.is_shape]
    arguments |= {str(len(written) + i): f"damages[{number}]" for i, (number, _) in enumerate(shapes)}
    with saying({f"damages.{place}.": f"{argument}." for place, argument in arguments.items()}):
        sections = damage_sections(written)
        sections += tuple(ShapeFault(gear=one.on, number=i, damage=one) for i, (_, one) in enumerate(shapes))
        problems: list[Problem] = []
        for i, section in enumerate(sections):
            with saying({"missing_m": f"damages.{i}.missing_m"}):
                found_here = list(section.place_problems(pair))
            problems += [Problem(f"damages.{i}.{one.path}", one.received, one.allowed) for one in found_here]
        if problems:
            raise ConfigError(problems)
    if law == "linear" and any(one.needs_pairs for one in sections):
        raise refused("law", "'linear' with damage that is a shape of the flank", "pairs")
    growth = Growth(0, 0, 0, pair) if loads is None else Growth(0, 0, 0, pair, load_at_rest=loads)
    found = [part for section in sections for part in section.drawn(growth)]
    return tuple(found)
