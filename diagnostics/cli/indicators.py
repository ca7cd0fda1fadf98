"""`siggen-diagnostics indicators`: all indicators of a set, ranked by how well they show damage; or of recordings."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.recording_options import GearOptions, RecordingOptions, is_recording, recordings_of
from diagnostics.cli.set_options import OwnIndicators
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import UsageError

TABLES = (".parquet", ".csv")


@grouped
def indicators(
    targets: Annotated[
        list[str],
        typer.Argument(
            metavar="DIR | RECORDING...",
            help="Folder of a finished set, or recordings: .csv, .txt, .lvm, .mat, .wav, .npz, .tdms, .uff, .h5, "
            ".mf4, .parquet (FILE:ROW,ROW) and others.",
            show_default=False,
        ),
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FOLDER | FILE",
            help="Folder, by default DIR_indicators; a .parquet or .csv file takes the values of a set alone.",
            show_default=False,
        ),
    ] = None,
    indicator: OwnIndicators = None,
    as_json: AsJson = False,
    gears: GearOptions,
    recording: RecordingOptions,
) -> None:
    """Compute all indicators: of a set, ranked by how well they separate damage; or of recordings.

    Of a set it writes the values and the ranking as tables; `report` shows both. Of recordings also indicators.html.

    Example: siggen-diagnostics indicators runs/quickstart

    Example: siggen-diagnostics indicators runs/quickstart --out features.parquet

    Example: siggen-diagnostics indicators run.csv --fs 25600 --teeth 25,56 --speed 14,26
    """
    of_files = bool(gears.teeth) or is_recording(targets[0])
    tables = () if of_files else TABLES
    if out is not None and out.suffix[1:].isalpha() and out.suffix not in tables and not out.is_dir():
        table = "" if of_files else f", or a table, {' or '.join(TABLES)}"
        raise UsageError(f"--out {out}: received a name that ends in {out.suffix}; allowed: a folder{table}")
    if of_files:
        if indicator:
            raise UsageError("--indicator: for sets only; leave it out for recordings")
        _of_recordings(targets, gears, recording, out, as_json)
        return
    if as_json:
        raise UsageError("--json: for recordings only; --out table.parquet or .csv has the indicators of a set")
    if len(targets) > 1:
        raise UsageError(f"{targets[1]}: a second argument after the folder {targets[0]}; allowed: one set at a time")
    if out is not None and out.suffix in TABLES:
        _table_alone(Path(targets[0]), out, indicator)
    else:
        span = recording.read((Path(targets[0]), None)).speed_range_hz()
        _ranked_tables(Path(targets[0]), out, span, indicator)


def _ranked_tables(
    directory: Path, out: Path | None, span: tuple[float, float] | None, indicator: OwnIndicators
) -> None:
    """Write values and ranking of a set's indicators, and say which are best and what was left out."""
    from diagnostics.base.beside import beside
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.ranking_table import ranking_table
    from diagnostics.indicators.settings import IndicatorSettings
    from diagnostics.indicators.table import record_table
    from diagnostics.indicators.workers import fitting_workers
    from diagnostics.records.record_classes import refuse_lives
    from diagnostics.records.usable_records import check_states, problem_lines
    from diagnostics.report.indicators import evaluated, findings, write_evaluation
    from diagnostics.statistics.indicator_statistics import AssessmentSettings
    from siggen.dataset.reading import open as open_set

    own_indicators, dataset = load_indicators(indicator), open_set(directory)
    refuse_lives(dataset)
    check_states(dataset)
    records = dataset.labels(columns=["record_id"]).num_rows
    with terminal_stage("indicators", records) as advance:
        settings = IndicatorSettings(speed_range_hz=span)
        everything = record_table(dataset, settings, own_indicators, workers=fitting_workers(records), advance=advance)
    table = ranking_table(everything, dataset, leave_out=True)
    ranking = evaluated(table, AssessmentSettings(), terminal_stage)
    path = write_evaluation(dataset, ranking, out or beside(dataset.path, "_indicators"), values=True)
    for problem in problem_lines(table.problems):
        echo(f"left out: {problem}", err=True)
    for sentence in findings(dataset, ranking)[1:]:
        echo(sentence)
    echo(str(path))


def _table_alone(directory: Path, out: Path, indicator: OwnIndicators) -> None:
    """Write the indicators of every record and channel, as classifiers take them, without judging any."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.classifier_table import check_table, classifier_table, write_table
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.table import record_table
    from diagnostics.indicators.workers import fitting_workers
    from siggen.dataset.reading import open as open_set

    own_indicators = load_indicators(indicator)
    dataset = open_set(directory)
    records = dataset.labels(columns=["record_id"]).num_rows
    with terminal_stage("indicators", records) as advance:
        table = record_table(dataset, own=own_indicators, workers=fitting_workers(records), advance=advance)
    notes = check_table(table, dataset)
    write_table(classifier_table(table, notes), out)
    for note in notes:
        echo(f"note: {note}", err=True)
    echo(str(out))


def _of_recordings(
    targets: list[str],
    gears: GearOptions,
    recording: RecordingOptions,
    out: Path | None,
    as_json: bool,
) -> None:
    """Write and print the indicators of recordings."""
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.machine.recording_indicators import recording_indicators, recording_rows, write_recordings
    from diagnostics.records.gear_train import gear_names

    require_packages("the page of indicators", "matplotlib")
    sources = recordings_of(targets)
    read = recording.read(sources[0], gears.teeth)
    train = gears.train(read, f"{targets[0]}: teeth unknown")
    facts, speed_range_hz = read.facts(), read.speed_range_hz()
    results = []
    with terminal_stage("recordings", len(sources)) as advance:
        for path, row in sources:
            said = replace(facts, row=row)
            results.append(recording_indicators(path, train, said, speed_range_hz))
            advance()
    if as_json:
        echo_json({"recordings": recording_rows(results)})
    for result in results:
        levels = ", ".join(f"{name} {result.values[f'rms__{name}']:.3g} m/s2" for name in result.recording.channels)
        shaft = gear_names(result.train)[0].gears[0]
        speed = f"{shaft} {result.pulses.speed_hz:.4f} Hz, mesh {result.mesh_hz:.2f} Hz"
        if not as_json:
            echo(f"{result.name}: {speed} ({result.pulses.origin}); rms {levels}")
        for doubt in result.doubts:
            echo(f"doubtful: {doubt}", err=True)
    folder = out or sources[0][0].resolve().with_name(f"{sources[0][0].stem}_indicators")
    echo(str(write_recordings(results, folder)), err=as_json)
