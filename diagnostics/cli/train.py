"""`siggen-diagnostics train`: classifiers of a set, judged on specimens they have not seen."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.training_options import OwnIndicators, Seed, TrainingOptions
from siggen.cli.option_groups import grouped


@grouped
def train(
    directory: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="DIR2", help="Folder for the models.", show_default=False)
    ],
    *,
    indicator: OwnIndicators = None,
    training: TrainingOptions,
    seed: Seed = 0,
) -> None:
    """Train classifiers on the training specimens, judge them on the test specimens, and save them.

    Example: siggen-diagnostics train data/quickstart --out models --test data/other_gears
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.indicators.classifier_table import feature_matrix
    from diagnostics.indicators.own_indicator import load_indicators

    require_packages("training", "sklearn", "skops", *(("torch", "safetensors") if training.cnn else ()))
    from diagnostics.release.saved_models import save_models
    from diagnostics.training.network_training import NetworkOptions, check_device
    from diagnostics.training.studies import run_studies, studies_metrics
    from diagnostics.training.training import train_models, training_metrics
    from diagnostics.training.training_sets import open_sets, other_table, set_table
    from siggen.errors import DatasetError

    if training.cnn:
        check_device(training.device)
    own = load_indicators(indicator)
    dataset, second = open_sets(directory, training.test, training.channel or ())
    table = set_table(dataset, terminal_stage, own=own)
    other = other_table(second, terminal_stage, own) if second else None
    options = NetworkOptions(training.cnn, training.device, training.augment, training.studies)
    try:
        trained = train_models(dataset, table, seed, network=options, other=other, stage=terminal_stage)
    except DatasetError as error:
        raise DatasetError(f"{directory}: {error}") from error
    with terminal_stage("saving the models", 1):
        notes = save_models(trained, table, dataset, out)
    metrics = {**training_metrics(trained), "seed": seed, "file_notes": notes}
    if training.studies:
        found = run_studies(dataset, feature_matrix(table), trained.split, seed, second, terminal_stage)
        metrics["studies"] = studies_metrics(found)
    (out / "metrics.json").write_text(json.dumps(metrics, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    for note in (*trained.notes, *notes):
        typer.echo(f"note: {note}", err=True)
    typer.echo(str(out))
