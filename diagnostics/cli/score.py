"""`siggen-diagnostics score`: predictions of any classifier, judged on the test records of a set."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.set_options import Classes, Seed
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped


@dataclass(frozen=True, slots=True)
class JudgedOptions:
    """What predictions are judged by."""

    labels: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Sealed labels of a benchmark; those revealed, else SET_secret/sealed.json unless told.",
            show_default=False,
        ),
    ] = None
    split: Annotated[str, typer.Option(metavar="test|validation", help="Whose records are judged.")] = "test"
    classes: Classes = "state"


@grouped
def score(
    directory: Annotated[
        Path,
        typer.Argument(
            metavar="SET", help="Folder or s3://... of a finished set, or folder of a benchmark.", show_default=False
        ),
    ],
    predictions: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="Predictions, .parquet or .csv: record_id, and the columns of a task: damage (a number that rises "
            "with damage), p_CLASS of every class or class, gear and tooth, area_mm2, rul_h, confidence.",
            show_default=False,
        ),
    ],
    *,
    baselines: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Folder that `report` wrote: its classifiers are judged on the same records. SET_report or SET_models "
            "unless told.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="TABLE", help="Write the rows too, .parquet or .csv.")
    ] = None,
    judged: JudgedOptions,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Judge the predictions of your own classifier, with limits over gearboxes.

    Missing, doubled and unknown records and values that cannot be are refused in one list. Of a benchmark every test
    part is judged that the predictions have rows for.

    Example: siggen-diagnostics score runs/quickstart mine.parquet
    """
    from diagnostics.indicators.classifier_table import check_suffix, write_table
    from diagnostics.scoring.benchmark import is_benchmark, open_benchmark
    from diagnostics.scoring.benchmark_scores import BenchmarkScores, score_benchmark
    from diagnostics.scoring.score import Scores
    from diagnostics.scoring.score import score as scored
    from siggen.dataset.reading import open as open_set
    from siggen.errors import UsageError

    if out:
        check_suffix(out)
    found: Scores | BenchmarkScores
    sealed = is_benchmark(directory)
    if sealed and (judged.split, judged.classes) != ("test", "state"):
        raise UsageError("--split, --classes: of a benchmark the split test is judged by states; leave them out")
    if judged.labels and not sealed:
        raise UsageError(f"--labels: {directory} is no benchmark and has its own labels; leave --labels out")
    if sealed:
        found = score_benchmark(
            open_benchmark(directory), predictions, labels=judged.labels, baselines=baselines, seed=seed
        )
    else:
        own = {"split": judged.split, "classes": judged.classes}
        found = scored(open_set(directory), predictions, baselines=baselines, seed=seed, **own)
    if as_json:
        echo_json({"split": judged.split, "classes": judged.classes, "scores": found.numbers()})
    else:
        echo(str(found))
    if out:
        write_table(found.to_table(), out)
        echo(str(out), err=as_json)
