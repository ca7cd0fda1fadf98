"""`siggen-diagnostics indicators`: all indicators of a set, ranked by how well they show the damage."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.training_options import OwnIndicators


def indicators(
    directory: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a finished set.", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="FOLDER", help="Folder for the report. Default: DIR_indicators.", show_default=False
        ),
    ] = None,
    indicator: OwnIndicators = None,
    workers: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
    false_alarms: Annotated[
        float,
        typer.Option(min=0.001, max=0.5, help="Rate of false alarms: share of healthy records above the threshold."),
    ] = 0.05,
    speed_range: Annotated[
        tuple[float, float] | None,
        typer.Option(
            metavar="LOW HIGH",
            help="Take shaft angles from the mesh lines, not the tacho; search this range of pinion speed [Hz].",
            show_default=False,
        ),
    ] = None,
    state: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="A damaged state to judge. May be given several times. Default: all. Sizes and trends are meaningful "
            "within one kind of damage only.",
            show_default=False,
        ),
    ] = None,
    leave_out: Annotated[
        bool, typer.Option("--leave-out", help="Leave out records and channels that cannot be used.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the bootstrap.")] = 0,
) -> None:
    """Compute all indicators, rank them by how well they separate damage, and write indicators.html and tables.

    Example: siggen-diagnostics indicators data/quickstart --workers 4
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.cli.progress import terminal_stage
    from diagnostics.indicators.own_indicator import load_indicators
    from diagnostics.indicators.ranking_table import ranking_table
    from diagnostics.indicators.settings import IndicatorSettings
    from diagnostics.indicators.table import record_table
    from diagnostics.records.chosen_states import chosen_states
    from diagnostics.records.usable_records import check_states
    from diagnostics.report.indicator_report import write_indicator_report
    from diagnostics.signal.tacholess_angle import check_speed_range
    from diagnostics.statistics.assessment import AssessmentSettings
    from siggen.dataset.reading import open as open_set

    require_packages("the report of indicators", "matplotlib")
    if speed_range is not None:
        check_speed_range(speed_range)
    own = load_indicators(indicator)
    dataset = open_set(directory)
    check_states(dataset)
    chosen_states(dataset, state or ())
    settings = IndicatorSettings(speed_range_hz=speed_range)
    with terminal_stage("indicators", dataset.labels(columns=["record_id"]).num_rows) as advance:
        everything = record_table(dataset, settings, own, workers=workers, advance=advance)
    table = ranking_table(everything, dataset, states=state or (), leave_out=leave_out)
    folder = out or directory.resolve().with_name(f"{directory.resolve().name}_indicators")
    judged = AssessmentSettings(seed=seed, false_alarms=false_alarms)
    typer.echo(str(write_indicator_report(dataset, table, folder, judged, terminal_stage)))
