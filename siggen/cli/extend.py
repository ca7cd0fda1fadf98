"""`siggen extend`: more specimens for a finished set."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from siggen.cli.echo import echo
from siggen.cli.engine_options import EngineOptions
from siggen.cli.option_groups import grouped
from siggen.cli.run_display import LogJson, run_shown


@grouped
def extend(
    folder: Annotated[Path, typer.Argument(help="Folder or s3://... of a finished set.", metavar="DIR")],
    specimens: Annotated[
        str, typer.Option("--specimens", help="+N for N more gearboxes, or how many in all.", metavar="+N")
    ],
    *,
    engine: EngineOptions,
    log_json: LogJson = None,
) -> None:
    """Add gearboxes to a finished set; the same command continues an interrupted extension.

    Shards that are there keep their bytes, new ones come behind them. Tables, card and manifest are written again.
    Every record is the one that a set generated at once would have.

    Exit codes: 0 done, 2 no finished set or a wrong number, 3 records failed (done without them, or stopped by
    --allowed-loss), 130 interrupted.

    Example: siggen extend runs/quickstart --specimens +100
    """
    from siggen.cli.generate import report
    from siggen.errors import EXIT_RECORDS_FAILED
    from siggen.sets.extension import extend as extend_set

    runner, count = engine.runner()
    with run_shown(log_json, folder) as shown:
        told: dict[str, Any] = {"events": shown.events, "allowed_loss": engine.allowed_loss}
        generation = extend_set(folder, specimens, count, shown.progress, engine=runner, **told)
    report(generation, say=shown.say)
    echo(str(generation.path))
    if generation.failures:
        raise typer.Exit(EXIT_RECORDS_FAILED)
