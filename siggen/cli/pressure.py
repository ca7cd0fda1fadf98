"""`siggen inspect pressure`: load and pressure over one flank while its tooth goes through mesh in a record."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped
from siggen.cli.picture_option import PictureOptions, check_wanted
from siggen.cli.working import working


@grouped
def pressure(
    source: Annotated[Path, typer.Argument(metavar="CONFIG|DIR", help="YAML file of a set, or the folder of a set.")],
    record: Annotated[int, typer.Option("--record", min=0, help="Index of the record (column record_id).")],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", help="Table to write: .csv or .parquet, a row per position and slice.")
    ] = None,
    picture: PictureOptions,
    gear: Annotated[
        str | None,
        typer.Option("--gear", help="Whose flank: pinion, gear, or a gear's own name; by default the damaged one's."),
    ] = None,
    tooth: Annotated[
        int | None, typer.Option("--tooth", min=0, help="Index of the tooth; by default the first damaged one.")
    ] = None,
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as duration_s=0.5.")
    ] = None,
) -> None:
    """Simulate one record and write how the force of a tooth spreads over its flank: load per length and pressure.

    Force and tilt are those of the motion. How they spread is solved across the face, with damage, crowning, helix and
    misalignment, and with the elastic pressure at the edges of damage as round as they were drawn.

    Example: siggen inspect pressure configs/quickstart.yaml --record 2 --out pressure.parquet --png pressure.png
    """
    from siggen.cli.record_choice import chosen_record
    from siggen.dataset.table_file import write_table_file
    from siggen.views.pressure import (
        chosen_positions,
        face_pressure,
        largest_text,
        pressure_table,
        save_pressure_figure,
    )

    png = picture.place("pressure")
    check_wanted(out, png, "pressure")
    with working("simulating the record and solving the pressure across the face"):
        _, drawn, planned = chosen_record(source, record, overrides or ())
        found = face_pressure(drawn, planned, gear, tooth)
    positions = chosen_positions(found)
    if out is not None:
        write_table_file(pressure_table(found), out)
    if png is not None:
        with working("drawing the picture", compiles=False):
            save_pressure_figure(found, positions, png)
    echo(f"{found.view.state}, {found.view.gear} tooth {found.view.tooth}: {largest_text(found)}", err=True)
    if out is not None:
        echo(str(out))
    if png is not None:
        picture.drawn(png)
