"""`siggen inspect flank`: the damage on the flanks of one gearbox.specimen, as a table and drawn to scale."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.gearbox_choice import GearboxChoice
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions, check_wanted
from siggen.cli.working import working

if TYPE_CHECKING:
    from pyarrow import Table


@grouped
def flank(
    config: Annotated[
        Path, typer.Argument(metavar="CONFIG", help="YAML file of a set, or a preset such as quickstart.")
    ],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", help="Table to write: .csv or .parquet, one row per single damage.")
    ] = None,
    picture: PictureOptions,
    gearbox: GearboxChoice,
    state: Annotated[str | None, typer.Option("--state", help="Only this state; by default all with damage.")] = None,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.")
    ] = None,
) -> None:
    """Write the damage of one specimen, and draw its damaged flanks to scale with the zones of contact.

    Example: siggen inspect flank configs/paper_a.yaml --state severe --out flank.csv --png flank.png
    """
    from siggen.checks.loading import load_config
    from siggen.dataset.table_file import write_table_file
    from siggen.errors import UsageError
    from siggen.views.flank import flank_damage_table, flank_views

    png = picture.place("flank")
    check_wanted(out, png, "flank")
    with working("drawing damage"):
        drawn, mesh = gearbox.drawn(load_config(config, overrides or ()))
        of = None if gearbox.stage is None else mesh
        table = flank_damage_table(drawn, state, of)
        views = flank_views(drawn, state, of) if png is not None else []
    if png is not None and not views:
        where = "" if gearbox.stage is None else f" on {gearbox.stage}"
        other = "leave out --png and --open" if gearbox.stage is None else "leave out --stage for all meshes"
        raise UsageError(f"{png}: there is no damage to draw{where} in {state or 'any state'}; {other}")
    if out is not None:
        write_table_file(_without_lists(table) if out.suffix.lower() == ".csv" else table, out)
        echo(str(out))
    if png is not None:
        with working("drawing the picture", compiles=False):
            from siggen.views.flank import save_flank_figure

            save_flank_figure(views, png)
        picture.drawn(png)


def _without_lists(table: Table) -> Table:
    """Return the table with its lists written as text, such as [1.0, 2.5]: a CSV file holds none."""
    import json

    import pyarrow as pa

    for index, field in enumerate(table.schema):
        if pa.types.is_list(field.type):
            texts = [json.dumps(value) for value in table.column(index).to_pylist()]
            table = table.set_column(index, field.name, pa.array(texts, pa.string()))
    return table
