"""Options that several commands share."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

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


@dataclass(frozen=True, slots=True)
class TrainingOptions:
    """How classifiers are trained."""

    test: Annotated[
        Path | None,
        typer.Option(
            "--test",
            metavar="DIR3",
            help="Judge the classifiers on this set too. It needs the same channels, sampling rate and states.",
            show_default=False,
        ),
    ] = None
    channel: Annotated[
        list[str] | None,
        typer.Option(
            "--channel", metavar="NAME", help="Use this channel only. May be given several times.", show_default=False
        ),
    ] = None
    studies: Annotated[
        bool,
        typer.Option(
            "--studies",
            help="Also compare ways to split, draw a learning curve and run an ablation. This takes minutes.",
        ),
    ] = False
    cnn: Annotated[bool, typer.Option("--cnn/--no-cnn", help="Train the networks too.")] = True
    device: Annotated[str, typer.Option("--device", metavar="cpu|cuda", help="Where to train the networks.")] = "cpu"
    augment: Annotated[
        bool, typer.Option("--augment/--no-augment", help="Train the networks with random transfer paths and noise.")
    ] = True
