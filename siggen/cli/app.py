"""The command `siggen`: one command per file, and what every error turns into."""

from __future__ import annotations

from typing import Annotated

import typer

from siggen.cli.echo import echo
from siggen.cli.generate import generate
from siggen.cli.init import init
from siggen.cli.inspect import inspect
from siggen.cli.plan import plan
from siggen.cli.program import run_program
from siggen.cli.publish import publish
from siggen.cli.show import show
from siggen.cli.verify import verify

# Command files import nothing slow at their top, so that all of them together start at once.
COMMANDS = (init, plan, generate, verify, show, inspect, publish)
STAYS = {
    "generate": "finished shards stay, and the same command goes on from there",
    "verify": "the set is unchanged; the same command checks it from the beginning",
    "publish": "the set is unchanged; the same command makes the folder anew",
}
"""What stays on disk when a command ends early, and how to go on."""

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
    run_program(app, "siggen", STAYS)
