"""`siggen-diagnostics report`: classifiers of a set, trained and judged on unseen gearboxes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.set_options import Open, OwnIndicators, Seed, opened
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import EXIT_MISMATCH, UsageError


@dataclass(frozen=True, slots=True)
class TrainingOptions:
    """How classifiers are trained and judged."""

    test: Annotated[
        Path | None,
        typer.Option(
            "--test",
            metavar="SET2",
            help="Judge the classifiers on this set too. It needs the same channels (see --channel) and rate, and a "
            "damage in common; of its other states it is said whether they are found.",
            show_default=False,
        ),
    ] = None
    channel: Annotated[
        list[str] | None,
        typer.Option(
            "--channel", metavar="NAME", help="Use this channel only. May be given several times.", show_default=False
        ),
    ] = None
    cnn: Annotated[bool, typer.Option("--cnn/--no-cnn", help="Train the networks too.")] = True
    device: Annotated[str, typer.Option("--device", metavar="cpu|cuda", help="Where to train the networks.")] = "cpu"
    classes: Annotated[
        str,
        typer.Option(
            "--classes",
            metavar="state|fault",
            help="What a class is: the state of a record, or its primary fault. Healthy ones are one class.",
        ),
    ] = "state"
    predictions: Annotated[
        Path | None,
        typer.Option(
            "--predictions",
            metavar="FILE",
            help="Your own predictions, as `score` takes them, for the page.",
            show_default=False,
        ),
    ] = None


@grouped
def report(
    directory: Annotated[
        Path, typer.Argument(metavar="SET", help="Folder or s3://... of a finished set.", show_default=False)
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Folder for the report, by default SET_report.", show_default=False
        ),
    ] = None,
    indicator: OwnIndicators = None,
    training: TrainingOptions,
    show: Open = False,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Write the page of a set: which damage is found, how surely, and all records; and train models.

    Classifiers are judged on gearboxes that they have not seen. The page opens from disk, without a network. Of
    gearboxes that run to failure it says how well baselines tell their remaining life. Beside it lie metrics.json,
    evaluation.csv with all indicators, figures and models.

    Exit codes: 0 done, 2 no finished set, 4 the page is written, but the set lacks records to judge by.

    Example: siggen-diagnostics report runs/quickstart --open

    Example: siggen-diagnostics report runs/quickstart --no-cnn --test runs/other_gears --out runs/both
    """
    from diagnostics.base.beside import beside
    from diagnostics.base.extras import missing_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.workers import fitting_workers
    from diagnostics.judging.of_split import NetworkOptions, check_device
    from diagnostics.judging.sets import open_sets
    from diagnostics.records.record_classes import check_kind
    from diagnostics.report.life_report import write_life_report
    from diagnostics.report.report import PageOptions, write_report
    from diagnostics.scoring.truth import is_lives

    if training.cnn and not missing_packages("torch"):
        check_device(training.device)
    own_indicators = load_indicators(indicator)
    classes = check_kind(training.classes, "--classes")
    dataset, second = open_sets(directory, training.test, training.channel or (), classes)
    folder = out or beside(dataset.path, "_report")
    if is_lives(dataset):
        _refuse({"--test": second, "--indicator": own_indicators, "--predictions": training.predictions})
        path = write_life_report(dataset, folder, seed, terminal_stage, network=training.cnn)
    else:
        network = NetworkOptions(training.cnn, training.device, classes=classes)
        records = dataset.labels(columns=["record_id"]).num_rows
        page = PageOptions(predictions=training.predictions, workers=fitting_workers(records))
        path = write_report(
            dataset, folder, seed, network=network, other=second, own=own_indicators, page=page, stage=terminal_stage
        )
    metrics = json.loads((path.parent / "metrics.json").read_text(encoding="utf-8"))
    if headline := metrics.get("headline"):
        echo(headline, err=True)
    if as_json:
        echo_json(metrics)
    else:
        echo(str(path))
    if show:
        opened(path)
    if metrics.get("detectors", {}).get("alone") == {}:
        raise typer.Exit(EXIT_MISMATCH)


def _refuse(given: Mapping[str, object]) -> None:
    if wrong := [name for name, said in given.items() if said]:
        raise UsageError(f"{', '.join(wrong)}: for sets of states; this one has lives; leave out one or the other")
