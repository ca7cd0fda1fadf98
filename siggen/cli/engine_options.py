"""Options of commands that simulate: which engine, and on which cluster."""

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
