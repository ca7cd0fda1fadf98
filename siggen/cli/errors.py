"""`siggen inspect errors`: the manufacturing errors of one specimen, tooth by tooth, as a table and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.gearbox_choice import GearboxChoice
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions, check_wanted
from siggen.cli.working import working


@grouped
def errors(
    config: Annotated[
        Path, typer.Argument(metavar="CONFIG", help="YAML file of a set, or a preset such as quickstart.")
    ],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", help="Table to write: .csv or .parquet, one row per tooth.")
    ] = None,
    picture: PictureOptions,
    gearbox: GearboxChoice,
    state: Annotated[
        str | None, typer.Option("--state", help="Which state, where states have gears of their own.")
    ] = None,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as manufacture.accuracy_class=6.")
    ] = None,
) -> None:
    """Write pitch and profile deviations of every tooth, as a machine would measure them about the shaft's axis.

    Deviations are positive where material is missing.

    Example: siggen inspect errors set.yaml --out e.csv --png e.png
    """
    from siggen.checks.loading import load_config
    from siggen.dataset.table_file import write_table_file
    from siggen.views.errors import deviation_table, gear_charts

    png = picture.place("errors")
    check_wanted(out, png, "errors")
    with working("drawing the errors of the teeth"):
        drawn, mesh = gearbox.drawn(load_config(config, overrides or ()))
        charts = gear_charts(drawn, state, mesh)
    if out is not None:
        write_table_file(deviation_table(charts), out)
        echo(str(out))
    if png is not None:
        with working("drawing the picture", compiles=False):
            from siggen.views.errors import save_error_figure

            save_error_figure(charts, png)
        picture.drawn(png)
