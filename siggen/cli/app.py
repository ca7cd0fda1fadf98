"""The command `siggen`: one command per file, and what every error turns into."""

from __future__ import annotations

import os
import sys
from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.generate import generate
from siggen.cli.init import init
from siggen.cli.inspect import inspect
from siggen.cli.plan import plan
from siggen.cli.publish import publish
from siggen.cli.show import show
from siggen.cli.verify import verify
from siggen.errors import EXIT_INTERRUPTED, EXIT_UNEXPECTED, EXIT_USAGE, SiggenError, path_fault

TRACEBACK_VARIABLE = "SIGGEN_TRACEBACK"

# Command files import nothing slow at their top, so that all of them together start at once.
COMMANDS = (init, plan, generate, verify, show, inspect, publish)

app = typer.Typer(
    help="Labelled synthetic vibration records of spur gearboxes with tooth pitting and spalling.",
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Begin with: siggen plan quickstart",
)
for command in COMMANDS:
    app.command()(command)


def _print_version(wanted: bool) -> None:
    if wanted:
        from siggen.sources import installed_version

        echo(f"siggen {installed_version()}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Labelled synthetic vibration records of spur gearboxes with tooth pitting and spalling."""


def main() -> None:
    """Run the command line; known errors become a message and their exit code, never a traceback."""
    try:
        app()
    except SiggenError as error:
        echo(f"siggen: {error}", err=True)
        sys.exit(error.exit_code)
    except BrokenPipeError:  # the reader of a pipe, such as head, has seen enough
        sys.stdout = None
    except KeyboardInterrupt:
        echo("siggen: interrupted", err=True)
        sys.exit(EXIT_INTERRUPTED)
    except MemoryError:
        echo("siggen: not enough memory; finished shards stay, and the same command goes on from there", err=True)
        sys.exit(EXIT_UNEXPECTED)
    except Exception as error:
        if words := path_fault(error):
            echo(f"siggen: {words}", err=True)
            sys.exit(EXIT_USAGE)
        if os.environ.get(TRACEBACK_VARIABLE):
            raise
        kind = type(error).__name__
        echo(f"siggen: unexpected {kind}: {error}; run again with {TRACEBACK_VARIABLE}=1 for details", err=True)
        sys.exit(EXIT_UNEXPECTED)
