"""`siggen-diagnostics features`: the indicators of every record of a set as a table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def features(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a finished set.", show_default=False)],
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="FILE", help="Table to write: .parquet or .csv.", show_default=False)
    ],
) -> None:
    """Write the indicators of every record and channel.

    Example: siggen-diagnostics features data/quickstart --out features.parquet
    """
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.indicators.feature_table import check_suffix, feature_table, with_notes, write_table
    from diagnostics.records.usable_records import check_records
    from siggen.dataset.reading import open as open_set

    check_suffix(out)
    dataset = open_set(directory)
    notes = check_records(dataset)
    with terminal_stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        table = feature_table(dataset, advance=advance)
    write_table(with_notes(table, notes), out)
    for note in notes:
        typer.echo(f"note: {note}", err=True)
    typer.echo(str(out))
