"""`siggen generate`: a data set from a configuration, or the rest of one that was interrupted."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from siggen.cli.engine_options import Address, EngineName

if TYPE_CHECKING:
    from siggen.sets.set_run import Generation

LISTED_FAILURES = 10


def generate(
    config: Annotated[
        Path, typer.Argument(help="YAML file of the set, or a preset such as quickstart.", metavar="CONFIG")
    ],
    out: Annotated[
        Path,
        typer.Option("--out", help="Folder or s3://... of the set: new, empty, or begun before."),
    ],
    workers: Annotated[
        int | None,
        typer.Option("--workers", min=0, help="Worker processes; by default one per core. 0: none, to debug."),
    ] = None,
    engine: EngineName = None,
    address: Address = None,
    part: Annotated[
        str | None,
        typer.Option("--part", help="Only part i of N, in a folder of its own, for job arrays.", metavar="i/N"),
    ] = None,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", help="Replace a value, such as gears.module_mm=3.5.", metavar="PATH=VALUE"),
    ] = None,
) -> None:
    """Generate a data set; the same command continues an interrupted one.

    With --part i/N every job makes its shards in a folder of its own, knowing nothing of the others; `siggen merge`
    puts the parts together.

    Exit codes: 0 done, 2 wrong configuration or folder, 3 done but some records failed, 130 interrupted.

    Example: siggen generate configs/quickstart.yaml --out sets/quickstart
    """
    from siggen.checks.loading import load_config
    from siggen.checks.plausibility import implausible
    from siggen.engines.processes import default_workers
    from siggen.engines.registry import engine_of
    from siggen.errors import EXIT_RECORDS_FAILED
    from siggen.sets.compilation import compilation_text
    from siggen.sets.generation import generate as generate_set
    from siggen.sets.parts import generate_part, part_of

    loaded = load_config(config, overrides or ())
    for sentence in implausible(loaded):
        typer.echo(f"implausible: {sentence}", err=True)
    if told := compilation_text(loaded, default_workers() if workers is None else workers):
        typer.echo(told, err=True)
    chosen = None if part is None else part_of(part)
    runner = engine if address is None else engine_of(engine, workers, address)
    count = workers if runner is engine else None
    with progress_shown() as show:
        if chosen is None:
            generation = generate_set(loaded, out, count, show, engine=runner)
        else:
            generation = generate_part(loaded, out, chosen, count, show, engine=runner)
    report(generation, "the set" if chosen is None else f"part {chosen.number} of {chosen.of}")
    typer.echo(str(generation.path))
    if generation.failures:
        raise typer.Exit(EXIT_RECORDS_FAILED)


@contextmanager
def progress_shown() -> Iterator[Callable[[int, int], None] | None]:
    """Show records, rate and time left on stderr; nothing where stderr is not a terminal."""
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield None
        return
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("records"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(compact=True),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task("records", total=None, rate="")

        def show(done: int, total: int) -> None:
            bar.update(task, completed=done, total=total)
            speed = bar.tasks[0].speed
            bar.update(task, rate=f"{speed:.3g}/s" if speed else "")

        yield show


def report(generation: Generation, what: str = "the set") -> None:
    """Say on stderr what was done and what failed."""
    from siggen.errors import counted

    if generation.was_finished:
        typer.echo(
            f"{generation.path} is finished already; nothing to do (`siggen verify` checks every byte)", err=True
        )
    else:
        rate = generation.records_made / max(generation.seconds, 1e-9)
        taken = generation.shards_taken_over
        taken_over = f", {counted(taken, 'shard was', 'shards were')} there" if taken else ""
        made = f"{counted(generation.records_made, 'record')} in {generation.seconds:.1f} s ({rate:.3g}/s){taken_over}"
        typer.echo(f"{counted(generation.rows, 'record')} in {what}; this run: {made}", err=True)
    for failure in generation.failures[:LISTED_FAILURES]:
        typer.echo(f"record {failure.record_id} failed: {failure.status} ({failure.reason})", err=True)
    if generation.failures:
        failed = counted(len(generation.failures), "record")
        verdict = "the set is usable" if generation.rows else "the set has no rows"
        typer.echo(f"{failed} could not be simulated; {verdict}, manifest.json names what failed", err=True)
