"""`siggen-diagnostics explore`: one page on which the records of a set are chosen, zoomed and compared."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.opened import Open, opened
from diagnostics.cli.training_options import OwnIndicators


def explore(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a finished set.", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="The page. Default: DIR_explore.html.", show_default=False),
    ] = None,
    model: Annotated[
        Path | None,
        typer.Option(
            metavar="MODEL",
            help="Folder of `train` or `report`: shows what its logistic regression names every record.",
            show_default=False,
        ),
    ] = None,
    indicator: OwnIndicators = None,
    limit: Annotated[
        int, typer.Option(min=1, help="Most records on the page; whole gearboxes beyond it are left out.")
    ] = 100,
    full: Annotated[
        bool,
        typer.Option("--full", help="Keep every sample: up to 30 MB instead of 5 MB for 100 records of two channels."),
    ] = False,
    serve: Annotated[
        bool,
        typer.Option(
            "--serve",
            help="Serve the page to this machine alone (127.0.0.1), with every sample of the record you look at, until "
            "Ctrl+C. Writes no file.",
        ),
    ] = False,
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of --serve; 0 takes a free one.")] = 0,
    show: Open = False,
    workers: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
) -> None:
    """Write one HTML page to look at the records of a set; it opens from disk, without server or network.

    A table to filter and sort; for the chosen record its signal, order and envelope spectra, averages by tooth and
    damaged flanks, laid over the healthy record of the same gearbox; indicators, and a scatter of any two.

    Example: siggen-diagnostics explore data/quickstart --out quickstart.html

    Example: siggen-diagnostics explore data/quickstart --model data/quickstart_report --serve --open
    """
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.explore.explorer import ExplorerOptions, explorer_of, write_explorer
    from diagnostics.indicators.own_indicator import load_indicators
    from siggen.dataset.reading import open as open_set
    from siggen.errors import UsageError

    folder = directory.resolve()
    path = out or folder.with_name(f"{folder.name}_explore.html")
    if path.is_dir():
        raise UsageError(f"--out {path}: received a folder; allowed is the name of a file, such as {path / 'set.html'}")
    if serve and (out or full):
        raise UsageError("--serve writes no file and gives every sample; leave out --out and --full")
    own = load_indicators(indicator)
    dataset = open_set(directory)
    options = ExplorerOptions(limit=limit, full=full, served=serve, workers=workers, model=model, own=own)
    if serve:
        _serve(*explorer_of(dataset, options, terminal_stage), dataset, port, show)
        return
    typer.echo(str(write_explorer(dataset, path, options, terminal_stage)))
    if show:
        opened(path)


def _serve(page: str, records: object, dataset: object, port: int, show: bool) -> None:
    """Serve until Ctrl+C."""
    from diagnostics.explore.server import page_server
    from siggen.errors import UsageError

    try:
        server = page_server(page, dataset, records, port)  # type: ignore[arg-type]
    except OSError as error:
        raise UsageError(f"--port {port}: {error.strerror}; allowed: a free port, or 0 for any") from error
    address = f"http://{server.server_address[0]!s}:{server.server_port}/"
    typer.echo(f"{address} (this machine alone; Ctrl+C ends it)")
    if show:
        opened(address)
    with server:
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            typer.echo("ended", err=True)
