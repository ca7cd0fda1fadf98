"""The command `siggen-diagnostics`: its options, its commands, and what errors look like."""

from __future__ import annotations

from collections.abc import Callable

import typer

import siggen
from diagnostics.base.kept_memory import keep_memory
from diagnostics.cli.audit import audit
from diagnostics.cli.baseline import baseline
from diagnostics.cli.calibrate import calibrate
from diagnostics.cli.check import check
from diagnostics.cli.explore import explore
from diagnostics.cli.indicators import indicators
from diagnostics.cli.predict import predict
from diagnostics.cli.report import report
from diagnostics.cli.score import score
from siggen.cli.echo import echo
from siggen.cli.program import run_program
from siggen.errors import EXIT_OK

PROGRAM = "siggen-diagnostics"
TAKEN = "the set is unchanged; indicators once taken stay beside it, and the same command goes on with them"
STAYS = {
    "report": f"the page is not written; {TAKEN}",
    "audit": f"the page is not written; {TAKEN}",
    "indicators": TAKEN,
}
"""What stays on disk when a command ends early, and how to go on."""

app = typer.Typer(
    name=PROGRAM,
    help="Judge vibration sets that siggen wrote, classifiers of them, and recordings of a machine.",
    epilog="Begin with: siggen-diagnostics report runs/quickstart",
    context_settings={"help_option_names": ["-h", "--help"]},
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
COMMANDS: dict[str, tuple[Callable[..., None], ...]] = {
    "A set, in the order of work": (audit, indicators, report, score, predict),
    "A machine of your own, in the order of work": (baseline, check, calibrate),
    "Look at a set, or at recordings": (explore,),
}
for heading, commands in COMMANDS.items():
    for command in commands:
        app.command(rich_help_panel=heading)(command)


def _show_version(wanted: bool) -> None:
    if wanted:
        echo(f"{PROGRAM} {siggen.__version__}")
        raise typer.Exit(EXIT_OK)


@app.callback()
def _options(
    _version: bool = typer.Option(
        False, "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
    ),
) -> None:
    """Judge vibration sets that siggen wrote, classifiers of them, and recordings of a machine."""


def main() -> None:
    """Run the command line; known errors become a message and their exit code (0, 1, 2, 4 or 130), no traceback."""
    keep_memory()
    run_program(app, PROGRAM, STAYS)
