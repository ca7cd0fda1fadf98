"""`siggen simulate`: one record of a set with its internal quantities."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.working import working


def simulate(
    source: Annotated[Path, typer.Argument(metavar="CONFIG|DIR", help="YAML file of a set, or the folder of a set.")],
    record: Annotated[int, typer.Option("--record", min=0, help="Index of the record (column record_id).")],
    out: Annotated[Path, typer.Option("--out", help="Table to write: .parquet or .csv.")],
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Replace a value, such as duration_s=0.5.")
    ] = None,
    internals: Annotated[
        bool, typer.Option("--internals/--signals", help="With what no sensor sees, or what is stored alone.")
    ] = True,
) -> None:
    """Simulate one record again and write it with mesh force, mesh stiffness, transmission error and bearing forces.

    Example: siggen simulate configs/paper_a.yaml --record 3 --out record.parquet
    """
    from siggen.cli.record_choice import chosen_record
    from siggen.dataset.table_file import check_table_file, write_table_file

    check_table_file(out)
    with working("simulating the record"):
        design, drawn, planned = chosen_record(source, record, overrides or ())
        from siggen.record.internals import internals_table

        table = internals_table(drawn, planned, internals=internals)
        table = table.replace_schema_metadata({**table.schema.metadata, "identity": design.identity})
    write_table_file(table, out)
    echo(str(out))
