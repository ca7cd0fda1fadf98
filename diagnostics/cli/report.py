"""`siggen-diagnostics report`: features, training and figures of a set on one page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.opened import Open, opened
from diagnostics.cli.training_options import OwnIndicators, Seed, TrainingOptions
from siggen.cli.option_groups import grouped

EXPLORER = "explorer.html"


@grouped
def report(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="DIR2", help="Folder for the report. Default: DIR_report.", show_default=False
        ),
    ] = None,
    indicator: OwnIndicators = None,
    training: TrainingOptions,
    explore: Annotated[
        bool,
        typer.Option(
            "--explore", help="Also write explorer.html, to which records and counts of the report then lead."
        ),
    ] = False,
    show: Open = False,
    seed: Seed = 0,
) -> None:
    """Compute indicators, train classifiers, and write report.html, metrics.json, tables, figures and models.

    Example: siggen-diagnostics report data/quickstart --studies
    """
    from diagnostics.base.beside import beside
    from diagnostics.base.extras import missing_packages
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.report.report import write_report
    from diagnostics.training.network_training import NetworkOptions, check_device
    from diagnostics.training.training_sets import open_sets

    if training.cnn and not missing_packages("torch"):
        check_device(training.device)
    own = load_indicators(indicator)
    dataset, second = open_sets(directory, training.test, training.channel or ())
    folder = out or beside(dataset.path, "_report")
    options = NetworkOptions(training.cnn, training.device, training.augment, training.studies)
    path = write_report(
        dataset,
        folder,
        seed,
        network=options,
        other=second,
        own=own,
        explorer=EXPLORER if explore else "",
        stage=terminal_stage,
    )
    if explore:
        from diagnostics.explore.explorer import ExplorerOptions, write_explorer
        from diagnostics.report.examples import reported_gearboxes

        model = folder / "models"
        known = model if (model / "model.json").is_file() else None
        write_explorer(
            dataset,
            folder / EXPLORER,
            ExplorerOptions(model=known, own=own, first=reported_gearboxes(dataset)),
            terminal_stage,
        )
    typer.echo(str(path))
    if show:
        opened(path)
