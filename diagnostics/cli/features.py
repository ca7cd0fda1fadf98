"""`siggen-diagnostics features`: the indicators of every record of a set as a table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.training_options import OwnIndicators


def features(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="FILE", help="Table to write, .parquet or .csv.", show_default=False)
    ],
    indicator: OwnIndicators = None,
) -> None:
    """Compute the indicators of every record and channel, and write them as one table.

    Example: siggen-diagnostics features data/quickstart --out features.parquet
    """
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.indicators.classifier_table import check_suffix, check_table, classifier_table, write_table
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.table import record_table
    from siggen.dataset.reading import open as open_set

    check_suffix(out)
    own = load_indicators(indicator)
    dataset = open_set(directory)
    with terminal_stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        table = record_table(dataset, own=own, advance=advance)
    notes = check_table(table, dataset)
    write_table(classifier_table(table, notes), out)
    for note in notes:
        typer.echo(f"note: {note}", err=True)
    typer.echo(str(out))
