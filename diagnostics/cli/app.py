"""The command `siggen-diagnostics`: its options, its commands, and what errors look like."""

from __future__ import annotations

import sys
from importlib.metadata import version

import typer

from diagnostics.cli.audit import audit
from diagnostics.cli.features import features
from diagnostics.cli.indicators import indicators
from diagnostics.cli.predict import predict
from diagnostics.cli.report import report
from diagnostics.cli.train import train
from siggen.errors import EXIT_INTERRUPTED, EXIT_OK, EXIT_UNEXPECTED, SiggenError

app = typer.Typer(
    name="siggen-diagnostics",
    help="Take indicators, train classifiers and write reports for vibration sets that siggen wrote.",
    epilog="Example: siggen-diagnostics report data/quickstart",
    context_settings={"help_option_names": ["-h", "--help"]},
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
app.command()(features)
app.command()(indicators)
app.command()(train)
app.command()(report)
app.command()(audit)
app.command()(predict)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"siggen-diagnostics {version('siggen')}")
        raise typer.Exit(EXIT_OK)


@app.callback()
def _options(
    _version: bool = typer.Option(
        False, "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
    ),
) -> None:
    """Take indicators, train classifiers and write reports for vibration sets that siggen wrote."""


def main() -> None:
    """Run the command; errors meant for the user become one message and an exit code (0, 1, 2, 4 or 130)."""
    try:
        app()
    except SiggenError as error:
        sys.stderr.write(f"error: {error}\n")
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        sys.exit(EXIT_INTERRUPTED)
    except Exception as error:
        sys.stderr.write(f"unexpected error: {type(error).__name__}: {error}\n")
        sys.exit(EXIT_UNEXPECTED)
