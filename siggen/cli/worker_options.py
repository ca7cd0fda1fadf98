"""Options of a command that simulates: who runs the work, and how many records may be lost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import typer


@dataclass(frozen=True, slots=True)
class WorkerOptions:
    """How the records are made."""

    workers: Annotated[
        int | None,
        typer.Option("--workers", min=0, help="Worker processes; by default one per core. 0: none, to debug."),
    ] = None
    executor: Annotated[
        str | None,
        typer.Option(
            "--executor", help="Who runs the work: serial, processes (the default), dask or ray.", metavar="NAME"
        ),
    ] = None
    allowed_loss: Annotated[
        float,
        typer.Option(
            "--allowed-loss",
            min=0.0,
            max=1.0,
            help="Stop when a state has lost more than this share of its records; 1: never.",
            metavar="SHARE",
        ),
    ] = 0.1
