"""`siggen-diagnostics explore`: one page on which the records of a set are chosen, zoomed and compared."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def explore(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="The page. Default: DIR_explore.html.", show_default=False),
    ] = None,
    limit: Annotated[
        int, typer.Option(min=1, help="Most records on the page; whole gearboxes beyond it are left out.")
    ] = 100,
    full: Annotated[
        bool,
        typer.Option("--full", help="Keep every sample: up to 30 MB instead of 5 MB for 100 records of two channels."),
    ] = False,
    workers: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
) -> None:
    """Write one HTML page to look at the records of a set; it opens from disk, without server or network.

    A table to filter and sort; for the chosen record its signal, order and envelope spectra, averages by tooth and
    damaged flanks, laid over the healthy record of the same gearbox; indicators, and a scatter of any two.

    Example: siggen-diagnostics explore data/quickstart --out quickstart.html
    """
    from diagnostics.base.beside import beside
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.explore.explorer import write_explorer
    from siggen.dataset.reading import open as open_set
    from siggen.errors import UsageError

    dataset = open_set(directory)
    path = out or beside(dataset.path, "_explore.html")
    if path.is_dir():
        raise UsageError(f"--out {path}: received a folder; allowed is the name of a file, such as {path / 'set.html'}")
    typer.echo(str(write_explorer(dataset, path, limit=limit, full=full, workers=workers, stage=terminal_stage)))
