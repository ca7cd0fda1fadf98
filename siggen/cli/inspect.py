"""`siggen inspect WHAT`: one gearbox, seen in one of ten ways."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.errors import errors
from siggen.cli.flank import flank
from siggen.cli.inspection import Inspection
from siggen.cli.json_output import AsJson
from siggen.cli.life import life
from siggen.cli.modes import modes
from siggen.cli.option_groups import grouped
from siggen.cli.path import housing, path
from siggen.cli.picture_option import PictureOptions
from siggen.cli.pressure import pressure
from siggen.cli.spectrum import spectrum
from siggen.cli.tvms import parts, tvms
from siggen.errors import UsageError


class View(StrEnum):
    """What is looked at."""

    TVMS = "tvms"
    PARTS = "parts"
    FLANK = "flank"
    PRESSURE = "pressure"
    ERRORS = "errors"
    MODES = "modes"
    PATH = "path"
    HOUSING = "housing"
    SPECTRUM = "spectrum"
    LIFE = "life"


DRAWN = {"--out", "--png", "--open"}
SHOWN: dict[View, tuple[Callable[[Inspection], None], set[str]]] = {
    View.TVMS: (tvms, {*DRAWN, "--mesh", "--torque", "--vary"}),
    View.PARTS: (parts, {*DRAWN, "--mesh", "--torque", "--vary"}),
    View.FLANK: (flank, {*DRAWN, "--mesh", "--state"}),
    View.PRESSURE: (pressure, {*DRAWN, "--state", "--tooth"}),
    View.ERRORS: (errors, {*DRAWN, "--mesh", "--state"}),
    View.MODES: (modes, DRAWN),
    View.PATH: (path, DRAWN),
    View.HOUSING: (housing, {"--out"}),
    View.SPECTRUM: (spectrum, {"--png", "--open", "--state"}),
    View.LIFE: (life, {"--out"}),
}
"""How each is shown, and which options it takes beside --gearbox, --set and --json."""


@grouped
def inspect(
    what: Annotated[View, typer.Argument(help="What to look at; see above.", metavar="WHAT")],
    source: Annotated[
        Path,
        typer.Argument(
            metavar="CONFIG|DIR", help="YAML file of a set, a preset such as quickstart, or the folder of a set."
        ),
    ],
    *,
    gearbox: Annotated[int, typer.Option("--gearbox", min=0, help="Number of the gearbox in the set, from 0.")] = 0,
    states: Annotated[
        list[str] | None,
        typer.Option(
            "--state",
            help="Name of a state; of spectrum several, over each other. By default of flank all, of pressure the "
            "last, else the first.",
        ),
    ] = None,
    mesh: Annotated[
        str | None, typer.Option("--mesh", help="Which mesh, by its name; by default the first one, of flank all.")
    ] = None,
    tooth: Annotated[
        str | None,
        typer.Option(
            "--tooth", metavar="[GEAR:]INDEX", help="Tooth of pressure, such as gear:4; else the first damaged one."
        ),
    ] = None,
    torque_nm: Annotated[
        float | None,
        typer.Option(
            "--torque",
            min=1e-6,
            help="Torque on the pinion [N m] where damage acts as geometry; else of the first operating point.",
        ),
    ] = None,
    vary: Annotated[
        str,
        typer.Option(
            "--vary",
            metavar="KEY=VALUES",
            help="Curves of one state at values of a key, such as "
            "states.moderate.damage.first_height_mm=1,1.9,2.8, with the first state's. The state is that "
            "of the key, else the last; it grows from no other then.",
        ),
    ] = "",
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.", metavar="PATH=VALUE"),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="Table to write, .csv or .parquet; of housing .csv, of life the YAML file."),
    ] = None,
    picture: PictureOptions,
    as_json: AsJson = False,
) -> None:
    """Look at one gearbox: stiffness, flanks, pressure, errors, modes, path, spectrum, life.

    tvms: mesh stiffness of every state against the pinion angle (0: the first damaged tooth enters contact).

    parts: the same with the compliances of the damaged tooth's pair, contact and tooth, and, where damage acts as
    geometry, with the curve by potential energy, which is not used.

    flank: the damage, a row each, and the damaged flanks to scale with the zones of contact.

    pressure: how the force of a tooth spreads over its flank in the first record of a state.

    errors: pitch and profile deviations of every tooth as a machine would measure them, positive where material is
    missing.

    modes: undamped natural modes at the mean mesh stiffness; the one at 0 Hz is free rotation.

    path: transfer paths from bearing forces to channels: modes, damping, level. Its table is what a measured path of
    a sensor reads.

    housing: modes of a housing of plates, for housing.kind: modal.

    spectrum: order spectra of simulated records, with mesh lines and sidebands marked.

    life: what the gearbox shows at each inspection. --out writes the same configuration with these inspections as
    states in place of life: its records have the same bytes.

    Example: siggen inspect tvms quickstart --png tvms.png

    Example: siggen inspect tvms paper_a --vary states.moderate.damage.first_height_mm=1,1.9,2.8 --png heights.png

    Example: siggen inspect flank paper_a --state severe --out flank.csv --png flank.png

    Example: siggen inspect modes paper_b --out modes.csv --png modes.png

    Example: siggen inspect spectrum quickstart --state healthy --state severe --png spectrum.png

    Example: siggen inspect life fleet --gearbox 3 --out gearbox_3.yaml
    """
    show, used = SHOWN[what]
    given = {
        "--state": states, "--mesh": mesh, "--tooth": tooth, "--torque": torque_nm, "--vary": vary, "--out": out,
        "--png": picture.png, "--open": picture.show,
    }  # fmt: skip
    for option, value in given.items():
        if value and option not in used:
            raise UsageError(f"{option}: siggen inspect {what} has no use for it; it takes {', '.join(sorted(used))}")
    show(
        Inspection(
            what=what.value,
            options=used,
            source=source,
            gearbox=gearbox,
            states=tuple(states or ()),
            mesh=mesh,
            tooth=tooth,
            torque_nm=torque_nm,
            vary=vary,
            overrides=tuple(overrides or ()),
            out=out,
            picture=picture,
            as_json=as_json,
        )
    )
