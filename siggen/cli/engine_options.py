"""Options of commands that simulate: which engine, on which cluster, and how many records may be lost."""

from __future__ import annotations

from typing import Annotated

import typer

EngineName = Annotated[
    str | None,
    typer.Option("--engine", help="Who runs the work: serial, processes (the default), dask or ray.", metavar="NAME"),
]
Address = Annotated[
    str | None,
    typer.Option("--address", help="A cluster that is there, for dask or ray; by default one is made on this machine."),
]
AllowedLoss = Annotated[
    float,
    typer.Option(
        "--allowed-loss",
        min=0.0,
        max=1.0,
        help="Stop when a state loses more than this share of its records; what was made stays. 1: never stop.",
        metavar="SHARE",
    ),
]
