"""The command `siggen-diagnostics`: its options, its commands, and what errors look like."""

from __future__ import annotations

import os
import sys
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
from siggen.errors import EXIT_INTERRUPTED, EXIT_OK, EXIT_UNEXPECTED, EXIT_USAGE, SiggenError, path_fault

PROGRAM = "siggen-diagnostics"
TRACEBACK_VARIABLE = "SIGGEN_TRACEBACK"

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
    try:
        app()
    except SiggenError as error:
        echo(f"{PROGRAM}: {error}", err=True)
        sys.exit(error.exit_code)
    except BrokenPipeError:  # the reader of a pipe, such as head, has seen enough
        sys.stdout = None
    except KeyboardInterrupt:
        echo(f"{PROGRAM}: interrupted", err=True)
        sys.exit(EXIT_INTERRUPTED)
    except Exception as error:
        if words := path_fault(error):
            echo(f"{PROGRAM}: {words}", err=True)
            sys.exit(EXIT_USAGE)
        if os.environ.get(TRACEBACK_VARIABLE):
            raise
        kind = type(error).__name__
        again = f"run again with {TRACEBACK_VARIABLE}=1 for details"
        echo(f"{PROGRAM}: unexpected {kind}: {error}; {again}", err=True)
        sys.exit(EXIT_UNEXPECTED)
