"""`siggen-diagnostics report`: classifiers of a set, trained and judged on unseen gearboxes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.set_options import OwnIndicators, ReportOptions, Seed, TrainingOptions, opened
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.indicators.own_indicator import OwnIndicator
    from diagnostics.judging.of_split import NetworkOptions
    from siggen.dataset.reading import Dataset


@grouped
def report(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="DIR2",
            help="Folder for the report, DIR_report unless told.",
            show_default=False,
        ),
    ] = None,
    models_only: Annotated[
        bool, typer.Option("--models-only", help="Write models and metrics.json alone; DIR_models unless told.")
    ] = False,
    indicator: OwnIndicators = None,
    training: TrainingOptions,
    pages: ReportOptions,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Write the page of a set: which damage is found, how sure that is, and all its records; and train models.

    Classifiers are judged on gearboxes that they have not seen. The page opens from disk, without a network. Of
    gearboxes that run to failure it says how well baselines tell their remaining life. Beside it lie metrics.json,
    evaluation.csv with all indicators, figures and models.

    Example: siggen-diagnostics report runs/quickstart

    Example: siggen-diagnostics report runs/quickstart --models-only --out models --test runs/other_gears
    """
    if models_only:
        of_page = {"--open": pages.show, "--predictions": pages.predictions, "--state": pages.state}
        _refuse(of_page, "--models-only writes no page")
    from diagnostics.base.beside import beside
    from diagnostics.base.extras import missing_packages, require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators

    if models_only:
        require_packages("training", "sklearn", "skops", *(("torch", "safetensors") if training.cnn else ()))
    from diagnostics.explore.set_page import LookOptions
    from diagnostics.judging.of_split import NetworkOptions, check_device
    from diagnostics.judging.sets import open_sets
    from diagnostics.records.record_classes import check_kind
    from diagnostics.report.life_report import write_life_report
    from diagnostics.scoring.truth import is_lives

    if training.cnn and not missing_packages("torch"):
        check_device(training.device)
    own = load_indicators(indicator)
    classes = check_kind(training.classes, "--classes")
    dataset, second = open_sets(directory, training.test, training.channel or (), classes)
    options = NetworkOptions(training.cnn, training.device, training.augment, classes)
    if is_lives(dataset):
        of_states = {"--models-only": models_only, "--test": second}
        of_pages = {"--predictions": pages.predictions, "--state": pages.state}
        _refuse({**of_states, "--indicator": own, **of_pages}, "for sets of states; this one has lives")
        folder = out or beside(dataset.path, "_report")
        amount = LookOptions(pages.limit, pages.full, workers=pages.workers)
        path = write_life_report(dataset, folder, seed, terminal_stage, network=training.cnn, amount=amount)
    else:
        folder = out or beside(dataset.path, "_models" if models_only else "_report")
        if models_only:
            path = _models((dataset, second), folder, seed, options, own)
        else:
            path = _page((dataset, second), folder, seed, options, own, pages)
            metrics = json.loads((path.parent / "metrics.json").read_text(encoding="utf-8"))
            echo(metrics["headline"], err=True)
    if as_json:
        echo_json(json.loads(((path if models_only else path.parent) / "metrics.json").read_text(encoding="utf-8")))
    else:
        echo(str(path))
    if pages.show:
        opened(path)


def _refuse(given: Mapping[str, object], why: str) -> None:
    if wrong := [name for name, said in given.items() if said]:
        raise UsageError(f"{', '.join(wrong)}: {why}; leave out one or the other")


def _page(
    sets: tuple[Dataset, Dataset | None],
    folder: Path,
    seed: int,
    options: NetworkOptions,
    own: tuple[OwnIndicator, ...],
    pages: ReportOptions,
) -> Path:
    """Write the report and return its path."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.report.report import PageOptions, write_report

    dataset, second = sets
    page = PageOptions(
        predictions=pages.predictions,
        states=pages.state or (),
        limit=pages.limit,
        full=pages.full,
        workers=pages.workers,
    )
    return write_report(dataset, folder, seed, network=options, other=second, own=own, page=page, stage=terminal_stage)


def _models(
    sets: tuple[Dataset, Dataset | None],
    folder: Path,
    seed: int,
    options: NetworkOptions,
    own: tuple[OwnIndicator, ...],
) -> Path:
    """Train, and write the models and what they reach; return their folder."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.judging.of_split import train_models, training_metrics
    from diagnostics.judging.sets import other_table, set_table
    from diagnostics.prediction.saved_models import class_text, save_models
    from siggen.errors import DatasetError
    from siggen.file_writing import write_file

    dataset, second = sets
    table = set_table(dataset, terminal_stage, own=own)
    other = other_table(second, terminal_stage, own) if second else None
    try:
        trained = train_models(dataset, table, seed, network=options, other=other, stage=terminal_stage)
    except DatasetError as error:
        raise DatasetError(f"{dataset.path}: {error}") from error
    with terminal_stage("saving the models", 1):
        notes = save_models(trained, table, dataset, folder)
    metrics = {**training_metrics(trained), "seed": seed, "file_notes": notes}
    write_file(folder / "metrics.json", json.dumps(metrics, indent=1, allow_nan=False) + "\n")
    echo(class_text(trained.split, dataset), err=True)
    for note in (*trained.notes, *notes):
        echo(f"note: {note}", err=True)
    return folder
