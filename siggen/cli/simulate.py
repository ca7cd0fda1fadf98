"""`siggen simulate`: one record of a set with its internal quantities."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def simulate(
    source: Annotated[Path, typer.Argument(metavar="CONFIG|DIR", help="YAML file of a set, or the folder of a set.")],
    record: Annotated[int, typer.Option("--record", min=0, help="Index of the record (column record_id).")],
    out: Annotated[Path, typer.Option("--out", help="Table to write: .parquet or .csv.")],
    overrides: Annotated[
        list[str] | None, typer.Option("--set", help="Override a key, such as duration_s=0.5.")
    ] = None,
) -> None:
    """Simulate one record again and write it with mesh force, mesh stiffness, transmission error and bearing forces.

    Example: siggen simulate configs/paper_a.yaml --record 3 --out record.parquet
    """
    from siggen.dataset.table_file import check_table_file, write_table_file
    from siggen.errors import UsageError
    from siggen.loading import load_config

    check_table_file(out)
    config = load_config(source / "config.yaml" if source.is_dir() else source, overrides or ())
    count = config.specimens * config.records_per_specimen
    if record >= count:
        raise UsageError(f"--record {record}: {source} has {count} records, 0 to {count - 1}")
    from siggen.record_internals import internals_table

    write_table_file(internals_table(config, record), out)
    typer.echo(str(out))
