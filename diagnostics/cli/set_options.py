"""Options of commands on sets: training, indicators of the user, pages and how they are opened."""

from __future__ import annotations

import webbrowser
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from siggen.cli.echo import echo

Open = Annotated[bool, typer.Option("--open", help="Open the page in your browser.")]

Classes = Annotated[
    str,
    typer.Option(
        "--classes",
        metavar="state|fault",
        help="What a class is: the state of a record, or its primary fault. Healthy ones are one class.",
    ),
]
Seed = Annotated[int, typer.Option("--seed", min=0, help="Seed of the bootstrap, the permutations and the networks.")]
OwnIndicators = Annotated[
    list[str] | None,
    typer.Option(
        "--indicator",
        metavar="MODULE:FUNCTION",
        help="Your own indicator: function(signal, tacho, gears) -> float. May be given several times. "
        "The module is imported and its code runs with your rights: name only code that you trust.",
        show_default=False,
    ),
]


@dataclass(frozen=True)  # no slots: two of these have one heir
class AmountOptions:
    """How much of the records a page holds."""

    limit: Annotated[
        int, typer.Option(min=1, help="Most records whose signals the page holds, of whole gearboxes; all are listed.")
    ] = 100
    full: Annotated[
        bool,
        typer.Option("--full", help="Keep every sample, up to 30 MB of them."),
    ] = False
    workers: Annotated[int, typer.Option(min=1, help="Number of processes.")] = 1


@dataclass(frozen=True)
class RankingOptions:
    """How indicators of a set are ranked."""

    state: Annotated[
        list[str] | None,
        typer.Option(
            "--state",
            metavar="NAME",
            help="A damaged state to rank indicators by. May be given several times. Default: all. Sizes and trends "
            "are meaningful within one kind of damage only.",
            show_default=False,
        ),
    ] = None


@dataclass(frozen=True)
class ReportOptions(RankingOptions, AmountOptions):
    """How features are ranked, what the page holds, and how it is opened."""

    predictions: Annotated[
        Path | None,
        typer.Option(
            "--predictions",
            metavar="FILE",
            help="Your own predictions, as `score` takes them: their scores stand on the page beside the classifiers'.",
            show_default=False,
        ),
    ] = None
    show: Open = False


def opened(target: Path | str) -> None:
    """Open a file or an address; where there is no browser, say so and leave it at that."""
    address = target if isinstance(target, str) else target.resolve().as_uri()
    if not webbrowser.open(address):
        echo(f"note: no browser was found; open {target} yourself", err=True)


@dataclass(frozen=True, slots=True)
class TrainingOptions:
    """How classifiers are trained."""

    test: Annotated[
        Path | None,
        typer.Option(
            "--test",
            metavar="DIR3",
            help="Judge the classifiers on this set too. It needs the same channels (see --channel) and rate, and a "
            "damage in common; of its other states it is said whether they are found.",
            show_default=False,
        ),
    ] = None
    channel: Annotated[
        list[str] | None,
        typer.Option(
            "--channel", metavar="NAME", help="Use this channel only. May be given several times.", show_default=False
        ),
    ] = None
    cnn: Annotated[bool, typer.Option("--cnn/--no-cnn", help="Train the networks too.")] = True
    device: Annotated[str, typer.Option("--device", metavar="cpu|cuda", help="Where to train the networks.")] = "cpu"
    augment: Annotated[
        bool, typer.Option("--augment/--no-augment", help="Train the networks with random transfer paths and noise.")
    ] = True
    classes: Classes = "state"
