"""`siggen inspect tvms`: the time-varying mesh stiffness of one specimen in all its states, as table and picture."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.gearbox_choice import GearboxChoice
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions, check_wanted
from siggen.cli.working import working


@dataclass(frozen=True, slots=True)
class FurtherCurves:
    """Further curves."""

    parts: Annotated[
        bool,
        typer.Option(
            "--parts",
            help="Add the compliances that the damaged tooth's pair is made of: contact and tooth. With "
            "dynamics.mesh.law: pairs the contact is that of the pair alone under the torque, sink included.",
        ),
    ] = False
    potential_energy: Annotated[
        bool,
        typer.Option(
            "--potential-energy",
            help="Where damage acts as geometry: add the curve by potential energy, which is not used.",
        ),
    ] = False


@dataclass(frozen=True, slots=True)
class KeyStudy:
    """A study of one key."""

    vary: Annotated[
        str,
        typer.Option(
            "--vary",
            metavar="KEY=VALUES",
            help="Curves of one state at values of a key, such as states.moderate.damage.first_height_mm=1,1.9,2.8, "
            "beside the first state's. The state is that of the key, else the last; it grows from no other then.",
        ),
    ] = ""


@grouped
def tvms(
    config: Annotated[
        Path, typer.Argument(metavar="CONFIG", help="YAML file of a set, or a preset such as quickstart.")
    ],
    *,
    out: Annotated[Path | None, typer.Option("--out", help="Table to write: .csv or .parquet.")] = None,
    picture: PictureOptions,
    gearbox: GearboxChoice,
    further: FurtherCurves,
    study: KeyStudy,
    torque_nm: Annotated[
        float | None,
        typer.Option(
            "--torque",
            min=1e-6,
            help="Torque on the pinion [N m] where damage acts as geometry; by default of the first operating point.",
        ),
    ] = None,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.")
    ] = None,
) -> None:
    """Write the mesh stiffness of every state against the pinion angle (0: the first damaged tooth enters contact).

    The curves begin one pitch before that angle. Where damage acts as geometry (dynamics.mesh.law: pairs)
    the stiffness is force over approach at rest, at a torque; then with sink and land of the damaged pair.

    Example: siggen inspect tvms paper_a --vary states.moderate.damage.first_height_mm=1,1.9,2.8 --png heights.png
    """
    from siggen.checks.loading import load_config
    from siggen.cli.key_variation import varied, varied_curves
    from siggen.dataset.table_file import write_table_file
    from siggen.views.stiffness import (
        curve_table,
        save_stiffness_figure,
        static_torque_nm,
        stiffness_curves,
        stiffness_meaning,
    )

    png = picture.place("tvms")
    check_wanted(out, png, "tvms")
    with working("computing the mesh stiffness of every state"):
        usable = load_config(config, overrides or ())
        drawn, mesh = gearbox.drawn(usable)
        torque = static_torque_nm(drawn, mesh) if torque_nm is None else torque_nm
        if study.vary:
            loaded = (
                (label, load_config(config, [*(overrides or ()), *changes]), state)
                for label, changes, state in varied(study.vary, usable)
            )
            curves = varied_curves(loaded, gearbox.specimen, torque, mesh)
        else:
            curves = stiffness_curves(drawn, torque_nm=torque, mesh=mesh)
        meaning = stiffness_meaning(across_the_face=drawn.law.across_the_face, torque_nm=torque)
    if out is not None:
        table = curve_table(curves, **asdict(further))
        write_table_file(table, out)
    if png is not None:
        with working("drawing the picture", compiles=False):
            save_stiffness_figure(curves, png, **asdict(further), title=meaning)
    echo(meaning, err=True)
    possible = usable.possible
    for note in possible.meshes[mesh].stiffness_notes(possible.bending):
        echo(f"note: {note}", err=True)
    if out is not None:
        echo(str(out))
    if png is not None:
        picture.drawn(png)
