"""`siggen tvms`: the time-varying mesh stiffness of one specimen in all its states, as a table and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def tvms(
    config: Annotated[Path, typer.Argument(metavar="CONFIG", help="YAML file of a set.")],
    out: Annotated[Path, typer.Option("--out", help="Table to write: .csv or .parquet.")],
    png: Annotated[Path | None, typer.Option("--png", help="Picture to draw as well.")] = None,
    specimen: Annotated[int, typer.Option("--specimen", min=0, help="Which gearbox of the set.")] = 0,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Override a key, such as gears.module_mm=3.5.")
    ] = None,
) -> None:
    """Write the mesh stiffness of every state against the pinion angle (0: the first damaged tooth enters contact).

    Example: siggen tvms configs/paper_a.yaml --out tvms.csv --png tvms.png
    """
    from siggen.dataset.table_file import check_table_file, write_table_file
    from siggen.loading import load_config
    from siggen.stiffness_curves import curve_table, stiffness_curves

    check_table_file(out)
    curves = stiffness_curves(load_config(config, overrides or ()), specimen)
    write_table_file(curve_table(curves), out)
    if png is not None:
        from siggen.cli.stiffness_figure import save_stiffness_figure

        save_stiffness_figure(curves, png)
    typer.echo(str(out))
