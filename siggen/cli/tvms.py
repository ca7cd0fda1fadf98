"""`siggen inspect tvms` and `parts`: the time-varying mesh stiffness of one gearbox in all its states."""

from __future__ import annotations

from siggen.cli.echo import echo
from siggen.cli.inspection import Inspection
from siggen.cli.working import working


def tvms(asked: Inspection) -> None:
    """Write the mesh stiffness of every state against the pinion angle.

    The curves begin one pitch before the first damaged tooth enters contact. Where damage acts as geometry
    (dynamics.mesh.law: pairs) the stiffness is force over approach at rest, at a torque; then with sink and land of the
    damaged pair.
    """
    _curves(asked, further=False)


def parts(asked: Inspection) -> None:
    """Write the same with the compliances of the damaged tooth's pair, and the curve by potential energy."""
    _curves(asked, further=True)


def _curves(asked: Inspection, *, further: bool) -> None:
    from siggen.cli.key_variation import varied, varied_curves
    from siggen.views.stiffness import (
        curve_table,
        save_stiffness_figure,
        static_torque_nm,
        stiffness_curves,
        stiffness_meaning,
    )

    png = asked.png()
    with working("computing the mesh stiffness of every state"):
        usable = asked.design()
        drawn, mesh = asked.drawn(usable)
        torque = static_torque_nm(drawn, mesh) if asked.torque_nm is None else asked.torque_nm
        if asked.vary:
            loaded = ((label, asked.design(changes), state) for label, changes, state in varied(asked.vary, usable))
            curves = varied_curves(loaded, asked.gearbox, torque, mesh)
        else:
            curves = stiffness_curves(drawn, torque_nm=torque, mesh=mesh)
        meaning = stiffness_meaning(across_the_face=drawn.law.across_the_face, torque_nm=torque)
    table = curve_table(curves, parts=further, potential_energy=further)
    echo(meaning, err=True)
    possible = usable.possible
    for note in possible.meshes[mesh].stiffness_notes(possible.bending):
        echo(f"note: {note}", err=True)
    asked.hand_over(
        table,
        lambda file: save_stiffness_figure(curves, file, parts=further, potential_energy=further, title=meaning),
        png,
        lambda: {"meaning": meaning, "curves": table.to_pydict()},
    )
