"""`siggen inspect modes`: natural frequencies of one specimen and what they consist of, as a table and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions
from siggen.cli.working import working

if TYPE_CHECKING:
    from rich.table import Table

    from siggen.views.modes import SpecimenModes


@grouped
def modes(
    config: Annotated[
        Path, typer.Argument(metavar="CONFIG", help="YAML file of a set, or a preset such as quickstart.")
    ],
    *,
    out: Annotated[Path | None, typer.Option("--out", help="Table to write: .csv or .parquet.")] = None,
    picture: PictureOptions,
    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Number of the gearbox in the set, from 0.")] = 0,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as dynamics.model=casing.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Print the undamped natural modes at the mean mesh stiffness; the one at 0 Hz is free rotation.

    Example: siggen inspect modes configs/paper_b.yaml --out modes.csv --png modes.png
    """
    from siggen.checks.loading import load_config
    from siggen.dataset.table_file import check_table_file, write_table_file

    if out is not None:
        check_table_file(out)
    from siggen.views.modes import specimen_modes

    png = picture.place("modes")
    with working("computing natural modes"):
        found = specimen_modes(load_config(config, overrides or ()).gearbox(specimen))
    if as_json:
        echo_json({"mesh_stiffness_n_per_m": found.mesh_stiffness_n_per_m, "modes": found.table.to_pylist()})
    else:
        from rich.console import Console

        Console().print(_printed(found))
    if out is not None:
        write_table_file(found.table, out)
        echo(str(out), err=as_json)
    if png is not None:
        with working("drawing the picture", compiles=False):
            from siggen.views.modes import save_modes_figure

            save_modes_figure(found, png)
        picture.drawn(png, err=as_json)


def _printed(found: SpecimenModes) -> Table:
    """Return frequency, share of the mesh and the two degrees of freedom that hold most of the kinetic energy."""
    from rich.table import Table

    from siggen.views.modes import kinetic_shares

    means = found.mesh_stiffness_n_per_m.items()
    stiffness = ", ".join(f"{value:.3g}{f' ({mesh})' if len(means) > 1 else ''}" for mesh, value in means)
    table = Table(title=f"natural modes at a mean mesh stiffness of {stiffness} N/m")
    for name in ("mode", "frequency [Hz]", "mesh strain energy [%]"):
        table.add_column(name, justify="right")
    table.add_column("moves most (share of kinetic energy)")
    shares = kinetic_shares(found)
    for i, frequency in enumerate(found.modes.frequency_hz):
        first, second = sorted(range(len(found.coordinates)), key=lambda j, i=i: -shares[i, j])[:2]  # type: ignore[misc]
        moving = ", ".join(f"{found.coordinates[j]} {100 * shares[i, j]:.0f} %" for j in (first, second))
        table.add_row(str(i), f"{frequency:.1f}", f"{100 * found.modes.mesh_share[i]:.1f}", moving)
    return table
