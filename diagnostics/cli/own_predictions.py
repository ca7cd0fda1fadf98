"""`siggen-diagnostics report SET --predictions FILE`: a classifier of your own, judged on the test records of a set."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.json_output import AsJson, echo_json


@dataclass(frozen=True, slots=True)
class PredictionOptions:
    """Predictions of your own classifier, judged alone."""

    predictions: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Predictions, .parquet or .csv: record_id, and damage (a number that rises with damage), "
            "p_CLASS of every class (probabilities), or class (its name). Nothing is trained; --out is a table.",
            show_default=False,
        ),
    ] = None
    baselines: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Folder that `report` wrote: its classifiers are judged on the same records."),
    ] = None
    split: Annotated[str, typer.Option(metavar="test|validation", help="Whose records are judged.")] = "test"
    as_json: AsJson = False


def judged(directory: Path, wanted: PredictionOptions, out: Path | None, seed: int, classes: str) -> None:
    """Print how well the predictions of `wanted.predictions` do, and write the rows to `out` if it is given.

    Missing, doubled and unknown records and values that cannot be are refused in one list.
    """
    from diagnostics.indicators.classifier_table import check_suffix, write_table
    from diagnostics.scoring.score import score
    from siggen.dataset.reading import open as open_set

    if out:
        check_suffix(out)
    assert wanted.predictions is not None
    dataset, split = open_set(directory), wanted.split
    found = score(dataset, wanted.predictions, baselines=wanted.baselines, split=split, seed=seed, classes=classes)
    if wanted.as_json:
        echo_json({"split": split, "classes": classes, "scores": found.to_table().to_pylist()})
    else:
        typer.echo(str(found))
    if out:
        write_table(found.to_table(), out)
        typer.echo(str(out), err=wanted.as_json)
