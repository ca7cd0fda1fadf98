"""`siggen-diagnostics bench`: make a benchmark, commit to its labels, reveal them, and show who stands where."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from diagnostics.cli.set_options import Open, Seed, opened
from siggen.cli.echo import echo
from siggen.cli.option_groups import grouped

Bench = Annotated[Path, typer.Argument(metavar="BENCH", help="Folder of a benchmark.", show_default=False)]
Sealed = Annotated[
    Path | None,
    typer.Option(
        "--labels",
        metavar="FILE",
        help="Sealed labels; those revealed, else BENCH_secret/sealed.json unless told.",
        show_default=False,
    ),
]

bench = typer.Typer(
    help="A benchmark whose test labels are sealed: make it, commit to the labels, reveal them, show a leaderboard.",
    no_args_is_help=True,
    epilog="Begin with: siggen-diagnostics bench make runs/bench_tiny --tier tiny",
)


@dataclass(frozen=True, slots=True)
class SizeOptions:
    """How many gearboxes."""

    tier: Annotated[str, typer.Option(metavar="tiny|small|full", help="How many gearboxes it has.")] = "tiny"
    learn: Annotated[
        int | None, typer.Option(min=1, help="Gearboxes to learn from, instead of the tier's.", show_default=False)
    ] = None
    test: Annotated[
        int | None, typer.Option(min=2, help="Gearboxes of each test part, instead of the tier's.", show_default=False)
    ] = None


@bench.command()
@grouped
def make(
    out: Annotated[Path, typer.Argument(metavar="BENCH", help="Folder to publish, new.", show_default=False)],
    *,
    size: SizeOptions,
    hidden: Annotated[
        Path | None,
        typer.Option(
            "--secret",
            metavar="DIR",
            help="Folder for the secret, the simulated test sets and sealed.json; BENCH_secret unless told. Never "
            "publish it. A file `secret` in it is taken; else one is drawn.",
            show_default=False,
        ),
    ] = None,
    config: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Configuration to learn from, that of siggen-bench unless told; one of lives asks how long they last.",
            show_default=False,
        ),
    ] = None,
    overrides: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE", help="Replace a value in all parts.", show_default=False),
    ] = None,
    facts: Annotated[
        Path | None,
        typer.Option("--facts", help="Licence, authors, citation, as `siggen publish` takes them.", show_default=False),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=0, help="Worker processes, default one per core.", show_default=False)
    ] = None,
) -> None:
    """Make a part to learn from, and test parts without labels whose seeds nobody knows.

    The same call goes on where it was stopped.

    Example: siggen-diagnostics bench make runs/bench_tiny --tier tiny
    """
    from diagnostics.base.beside import beside
    from diagnostics.base.progress import terminal_stage
    from diagnostics.bench.conditions import TIERS, Tier
    from diagnostics.bench.derived_secret import read_secret
    from diagnostics.bench.making import LEARNT, SECRET_FILE, WantedBench, make_benchmark
    from diagnostics.scoring.benchmark import SECRET
    from siggen.errors import UsageError

    if size.tier not in TIERS:
        raise UsageError(f"--tier: received {size.tier!r}; allowed are {', '.join(TIERS)}")
    usual, folder = TIERS[size.tier], hidden or beside(out, SECRET)
    chosen = Tier(size.learn or usual.learn, size.test or usual.test)
    numbers = f" ({chosen.learn} gearboxes to learn from, {chosen.test} in a test part)" if chosen != usual else ""
    named = f"{size.tier}{numbers}"
    wanted = WantedBench(named, chosen, config or LEARNT, tuple(overrides or ()), facts=facts)
    found = make_benchmark(out, folder, read_secret(folder / SECRET_FILE), wanted, workers, terminal_stage)
    echo(str(found))
    echo(f"publish {out}; never {folder}", err=True)


@bench.command()
def commit(folder: Bench, labels: Sealed = None) -> None:
    """Print the SHA-256 of labels, salt, seeds and configurations, and write it into the benchmark: publish it first.

    Example: siggen-diagnostics bench commit runs/bench_tiny
    """
    from diagnostics.bench.making import commit as committed
    from diagnostics.scoring.benchmark import open_benchmark

    echo(committed(open_benchmark(folder), labels))


@bench.command()
def reveal(folder: Bench, labels: Sealed = None) -> None:
    """Write labels, salt, seeds and configurations of the test parts into the benchmark; anybody can check their hash.

    Example: siggen-diagnostics bench reveal runs/bench_tiny
    """
    from diagnostics.bench.making import reveal as revealed
    from diagnostics.scoring.benchmark import open_benchmark

    echo(str(revealed(open_benchmark(folder), labels)))


@bench.command()
def baselines(
    folder: Bench,
    seed: Seed = 0,
    workers: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1,
) -> None:
    """Learn the baselines on the part to learn from, and write what they say of all test parts.

    `score` and `board` then show them too.

    Example: siggen-diagnostics bench baselines runs/bench_tiny
    """
    from diagnostics.base.extras import require_packages
    from diagnostics.base.progress import terminal_stage
    from diagnostics.bench.questions import write_baselines
    from diagnostics.scoring.benchmark import open_benchmark

    require_packages("baselines", "sklearn")
    echo(str(write_baselines(open_benchmark(folder), seed, workers, terminal_stage)))


@bench.command()
def board(
    folder: Bench,
    entries: Annotated[
        Path | None,
        typer.Argument(metavar="FOLDER", help="Files of predictions, one or more entries each.", show_default=False),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="DIR", help="BENCH_board unless told.", show_default=False)
    ] = None,
    labels: Sealed = None,
    seed: Seed = 0,
    show: Open = False,
) -> None:
    """Write leaderboard.html: all entries and baselines, with limits over gearboxes and paired differences.

    An entry that used the healthy references says so in a column `reference`, true in its rows.

    Example: siggen-diagnostics bench board runs/bench_tiny entries
    """
    from diagnostics.base.beside import beside
    from diagnostics.bench.leaderboard import board_entries, write_board
    from diagnostics.scoring.benchmark import labels_of, open_benchmark

    found = open_benchmark(folder)
    judged = board_entries(found, labels_of(found, labels), entries, seed)
    path = write_board(found, judged, out or beside(folder, "_board"))
    echo(str(path))
    if show:
        opened(path)
