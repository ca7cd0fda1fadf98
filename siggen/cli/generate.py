"""`siggen generate`: a data set from a configuration, or the rest of one that was interrupted."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped
from siggen.cli.run_display import LogJson, run_shown
from siggen.cli.worker_options import WorkerOptions
from siggen.errors import counted

if TYPE_CHECKING:
    from siggen.sets.set_run import Generation

LISTED_FAILURES = 10


@grouped
def generate(
    config: Annotated[
        Path, typer.Argument(help="YAML file of the set, or a preset such as quickstart.", metavar="CONFIG")
    ],
    out: Annotated[
        Path,
        typer.Option("--out", help="Folder or s3://... of the set: new, empty, begun, or with fewer gearboxes."),
    ],
    *,
    who: WorkerOptions,
    part: Annotated[
        str | None,
        typer.Option("--part", help="Only every N-th shard from the i-th on, for job arrays.", metavar="i/N"),
    ] = None,
    log_json: LogJson = None,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.", metavar="PATH=VALUE"),
    ] = None,
) -> None:
    """Generate a data set; the same command continues an interrupted one, and adds gearboxes to a finished one.

    With --part i/N every job makes its shards, knowing nothing of the others, all in one folder. The same command
    without --part makes what is missing and ends the set.

    More gearboxes (--set specimens=...) leave finished shards as they are: every record is the one that a set generated
    at once would have.

    Exit codes: 0 done, 2 wrong configuration or folder, 3 records failed (done without them, or stopped by
    --allowed-loss), 130 interrupted.

    Example: siggen generate configs/quickstart.yaml --out runs/quickstart
    """
    from siggen.checks.loading import load_config
    from siggen.checks.plausibility import implausible
    from siggen.errors import EXIT_RECORDS_FAILED
    from siggen.sets.compilation import compilation_text
    from siggen.sets.generation import generate as generate_set
    from siggen.sets.generation import part_of
    from siggen.workers.choice import workers_of

    loaded = load_config(config, overrides or ())
    chosen = None if part is None else part_of(part)
    workers = workers_of(who.executor, who.workers).count
    with run_shown(log_json, out) as shown:
        for sentence in implausible(loaded.possible):
            shown.say(f"implausible: {sentence}")
        if text := compilation_text(loaded.method, workers):
            shown.say(text)
        told: dict[str, Any] = {"events": shown.events, "allowed_loss": who.allowed_loss}
        on: dict[str, Any] = {"part": chosen, "executor": who.executor}
        generation = generate_set(loaded, out, who.workers, shown.progress, **on, **told)
    report(generation, "the set" if chosen is None else "part {} of {}".format(*chosen), shown.say)
    echo(str(generation.path))
    if generation.failures:
        raise typer.Exit(EXIT_RECORDS_FAILED)


def report(generation: Generation, what: str = "the set", say: Callable[[str], None] | None = None) -> None:
    """Say, on stderr unless told otherwise, what was done and what failed."""
    say = say or partial(echo, err=True)
    if generation.was_finished:
        say(f"{generation.path} is finished already; nothing to do (`siggen verify` checks every byte)")
    else:
        say(_made(generation, what))
        for note in generation.notes[:LISTED_FAILURES]:
            say(note)
    for failure in generation.failures[:LISTED_FAILURES]:
        say(f"record {failure.record_id} failed: {failure.status} ({failure.reason})")
    if generation.failures:
        failed = counted(len(generation.failures), "record")
        verdict = "the set is usable" if generation.rows else "the set has no rows"
        say(f"{failed} could not be simulated; {verdict}, manifest.json names what failed")


def _made(generation: Generation, what: str) -> str:
    rate = generation.records_made / max(generation.seconds, 1e-9)
    taken = generation.shards_taken_over
    taken_over = f", {counted(taken, 'shard was', 'shards were')} there" if taken else ""
    made = f"{counted(generation.records_made, 'record')} in {generation.seconds:.1f} s ({rate:.3g}/s){taken_over}"
    return f"{counted(generation.rows, 'record')} in {what}; this run: {made}"
