"""`siggen-diagnostics score`: predictions of any classifier, judged on the test records of a set."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.set_options import Seed
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json

if TYPE_CHECKING:
    from diagnostics.scoring.benchmark_scores import BenchmarkScores
    from diagnostics.scoring.score import Scores


def score(
    directory: Annotated[
        Path,
        typer.Argument(
            metavar="SET", help="Folder or s3://... of a finished set, or folder of a benchmark.", show_default=False
        ),
    ],
    predictions: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="Predictions, .parquet or .csv: record_id, and the columns of a task: damage (a number that rises "
            "with damage), p_CLASS of every class or class, gear and tooth, area_mm2, rul_h, confidence.",
            show_default=False,
        ),
    ],
    *,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="TABLE", help="Write the rows too, .parquet or .csv.")
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Sealed labels of a benchmark; by default those revealed, else SET_secret/sealed.json.",
            show_default=False,
        ),
    ] = None,
    split: Annotated[str, typer.Option(metavar="test|validation", help="Whose records are judged.")] = "test",
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Judge predictions of your own classifiers, with limits over gearboxes, and say what they mean.

    What `report` wrote beside the set (SET_report) is judged on the same records. Missing, doubled and unknown records
    and values that cannot be are refused in one list. Of a benchmark every test part is judged that the predictions
    have rows for.

    Example: siggen-diagnostics score runs/quickstart mine.parquet

    Example: siggen-diagnostics score runs/bench_tiny mine.parquet theirs.csv --out scores.csv
    """
    import pyarrow as pa

    from diagnostics.indicators.classifier_table import check_suffix, write_table
    from diagnostics.scoring.benchmark import is_benchmark, open_benchmark
    from diagnostics.scoring.benchmark_scores import score_benchmark
    from diagnostics.scoring.score import score as scored
    from siggen.dataset.reading import open as open_set
    from siggen.errors import UsageError

    if out:
        check_suffix(out)
    sealed = is_benchmark(directory)
    if sealed and split != "test":
        raise UsageError(f"--split {split}: of a benchmark the split test is judged; leave it out")
    if labels and not sealed:
        raise UsageError(f"--labels: {directory} is no benchmark and has its own labels; leave --labels out")
    if sealed:
        benchmark = open_benchmark(directory)
        results: dict[Path, BenchmarkScores | Scores] = {
            file: score_benchmark(benchmark, file, labels=labels, seed=seed) for file in predictions
        }
    else:
        dataset = open_set(directory)
        results = {file: scored(dataset, file, split=split, seed=seed) for file in predictions}
    if as_json:
        echo_json({"split": split, "scores": [row for result in results.values() for row in result.numbers()]})
    else:
        for file, result in results.items():
            echo(f"{file}\n{result}" if len(results) > 1 else str(result))
    if out:
        tables = {str(file): result.to_table() for file, result in results.items()}
        if len(tables) > 1:
            tables = {file: one.append_column("file", pa.array([file] * one.num_rows)) for file, one in tables.items()}
        write_table(pa.concat_tables(tables.values()), out)
        echo(str(out), err=as_json)
