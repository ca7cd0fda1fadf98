"""`siggen-diagnostics indicators`: all indicators of a set, ranked by how well they show damage; or of recordings."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from diagnostics.cli.recording_options import GearOptions, RecordingOptions, file_rows
from diagnostics.cli.set_options import OwnIndicators, RankingOptions
from siggen.cli.echo import echo
from siggen.cli.json_output import AsJson, echo_json
from siggen.cli.option_groups import grouped
from siggen.errors import UsageError

if TYPE_CHECKING:
    from diagnostics.recordings.taken import RecordingFacts


@dataclass(frozen=True, slots=True)
class ComputingOptions:
    """What is computed, and where it is told."""

    indicator: OwnIndicators = None
    workers: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1
    as_json: AsJson = False


@dataclass(frozen=True, slots=True)
class IndicatorTableOptions(RankingOptions):
    """How indicators of a set are ranked, and of which records."""

    leave_out: Annotated[
        bool, typer.Option("--leave-out", help="Leave out records and channels that cannot be used.")
    ] = False


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
            help="Folder, DIR_indicators unless told; a .parquet or .csv file takes the values of a set alone.",
            show_default=False,
        ),
    ] = None,
    computing: ComputingOptions,
    ranking: IndicatorTableOptions,
    gears: GearOptions,
    recording: RecordingOptions,
) -> None:
    """Compute all indicators: of a set, ranked by how well they separate damage; or of measured recordings.

    Of a set it writes the values and the ranking as tables; `report` shows both. Of recordings also indicators.html.

    Example: siggen-diagnostics indicators runs/quickstart --workers 4

    Example: siggen-diagnostics indicators runs/quickstart --out features.parquet

    Example: siggen-diagnostics indicators run.csv --fs 25600 --teeth 25,56 --speed-range 14,26
    """
    span = recording.speed_range_hz()
    if gears.given or file_rows(targets[0])[0][0].is_file():
        _refuse_options_of_sets(computing, ranking)
        _of_recordings(targets, gears, recording.facts(), span, out, computing.as_json)
        return
    directory = _one_set(targets, computing)
    if out is not None and out.suffix in (".parquet", ".csv"):
        _table_alone(directory, out, computing.indicator, computing.workers)
        return
    _ranked_tables(directory, out, span, computing, ranking)


def _refuse_options_of_sets(computing: ComputingOptions, ranking: IndicatorTableOptions) -> None:
    of_sets = {"--indicator": computing.indicator, "--state": ranking.state, "--leave-out": ranking.leave_out}
    if ignored := [option for option, given in of_sets.items() if given]:
        raise UsageError(f"{', '.join(ignored)}: for sets only; leave them out for recordings")


def _one_set(targets: list[str], computing: ComputingOptions) -> Path:
    """Return the folder of the only set asked for."""
    if computing.as_json:
        raise UsageError("--json: for recordings only; --out table.parquet or .csv has the indicators of a set")
    if len(targets) > 1:
        raise UsageError(f"{targets[1]}: a second argument after the folder {targets[0]}; allowed: one set at a time")
    return Path(targets[0])


def _ranked_tables(
    directory: Path,
    out: Path | None,
    span: tuple[float, float] | None,
    computing: ComputingOptions,
    ranking: IndicatorTableOptions,
) -> None:
    """Write values and ranking of a set's indicators, and say which are best."""
    from diagnostics.base.beside import beside
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.ranking_table import ranking_table
    from diagnostics.indicators.settings import IndicatorSettings
    from diagnostics.indicators.table import record_table
    from diagnostics.records.record_classes import refuse_lives
    from diagnostics.records.state_classes import chosen_states
    from diagnostics.records.usable_records import check_states
    from diagnostics.report.indicators import evaluated, findings, write_evaluation
    from diagnostics.statistics.indicator_statistics import AssessmentSettings
    from siggen.dataset.reading import open as open_set

    own, states = load_indicators(computing.indicator), ranking.state or ()
    dataset = open_set(directory)
    refuse_lives(dataset)
    check_states(dataset)
    chosen_states(dataset, states)
    with terminal_stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        settings = IndicatorSettings(speed_range_hz=span)
        everything = record_table(dataset, settings, own, workers=computing.workers, advance=advance)
    table = ranking_table(everything, dataset, states=states, leave_out=ranking.leave_out)
    found = evaluated(table, AssessmentSettings(), terminal_stage)
    path = write_evaluation(dataset, found, out or beside(dataset.path, "_indicators"), values=True)
    for sentence in findings(dataset, found)[1:]:
        echo(sentence)
    echo(str(path))


def _table_alone(directory: Path, out: Path, indicator: OwnIndicators, workers: int) -> None:
    """Write the indicators of every record and channel, as classifiers take them, without judging any."""
    from diagnostics.base.progress import terminal_stage
    from diagnostics.indicators.classifier_table import check_table, classifier_table, write_table
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.table import record_table
    from siggen.dataset.reading import open as open_set

    own = load_indicators(indicator)
    dataset = open_set(directory)
    with terminal_stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        table = record_table(dataset, own=own, workers=workers, advance=advance)
    notes = check_table(table, dataset)
    write_table(classifier_table(table, notes), out)
    for note in notes:
        echo(f"note: {note}", err=True)
    echo(str(out))


def _of_recordings(
    targets: list[str],
    gears: GearOptions,
    facts: RecordingFacts,
    speed_range_hz: tuple[float, float] | None,
    out: Path | None,
    as_json: bool,
) -> None:
    """Write and print the indicators of recordings."""
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.machine.recording_indicators import recording_indicators, recording_rows, write_recordings
    from diagnostics.records.gear_train import gear_names

    require_packages("the page of indicators", "matplotlib")
    train = gears.train(f"{targets[0]}: teeth unknown")
    sources = [source for said in targets for source in file_rows(said)]
    found = []
    with terminal_stage("recordings", len(sources)) as advance:
        for path, row in sources:
            said = replace(facts, row=row)
            found.append(recording_indicators(path, train, said, speed_range_hz))
            advance()
    if as_json:
        echo_json({"recordings": recording_rows(found)})
    for one in found:
        levels = ", ".join(f"{name} {one.values[f'rms__{name}']:.3g} m/s2" for name in one.recording.channels)
        shaft = gear_names(one.train)[0].gears[0]
        speed = f"{shaft} {one.pulses.speed_hz:.4f} Hz, mesh {one.mesh_hz:.2f} Hz"
        if not as_json:
            echo(f"{one.name}: {speed} ({one.pulses.origin}); rms {levels}")
        for doubt in one.doubts:
            echo(f"doubtful: {doubt}", err=True)
    folder = out or sources[0][0].resolve().with_name(f"{sources[0][0].stem}_indicators")
    echo(str(write_recordings(found, folder)), err=as_json)
