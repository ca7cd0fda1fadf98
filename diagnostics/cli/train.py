"""`siggen-diagnostics train`: classifiers of a set, judged on specimens they have not seen."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer


def train(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a finished set.", show_default=False)],
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="DIR2", help="Folder for the models.", show_default=False)
    ],
    cnn: Annotated[bool, typer.Option("--cnn/--no-cnn", help="Train the network too.")] = True,
    seed: Annotated[int, typer.Option(min=0, help="Seed of bootstrap, permutations and network.")] = 0,
) -> None:
    """Train classifiers on the training specimens and judge them on the test specimens.

    Example: siggen-diagnostics train data/quickstart --out models --no-cnn
    """
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.extras import require_packages
    from diagnostics.feature_table import feature_table
    from siggen.dataset.reading import open as open_set

    require_packages("training", "sklearn", "skops", *(("torch", "safetensors") if cnn else ()))
    from diagnostics.training import save_models, train_models, training_metrics

    dataset = open_set(directory)
    with terminal_stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        table = feature_table(dataset, advance=advance)
    training = train_models(dataset, table, seed, cnn=cnn, stage=terminal_stage)
    notes = save_models(training, table, dataset, out)
    metrics = {**training_metrics(training), "seed": seed, "file_notes": notes}
    (out / "metrics.json").write_text(json.dumps(metrics, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    for note in (*training.notes, *notes):
        typer.echo(f"note: {note}", err=True)
    typer.echo(str(out))
