"""Options of commands that simulate: who runs the work, on which cluster, and how many records may be lost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from siggen.engines.protocol import Engine


@dataclass(frozen=True, slots=True)
class EngineOptions:
    """How the records are made."""

    workers: Annotated[
        int | None,
        typer.Option("--workers", min=0, help="Worker processes; by default one per core. 0: none, to debug."),
    ] = None
    engine: Annotated[
        str | None,
        typer.Option(
            "--engine", help="Who runs the work: serial, processes (the default), dask or ray.", metavar="NAME"
        ),
    ] = None
    address: Annotated[
        str | None,
        typer.Option(
            "--address", help="A cluster that is there, for dask or ray; by default one is made on this machine."
        ),
    ] = None
    allowed_loss: Annotated[
        float,
        typer.Option(
            "--allowed-loss",
            min=0.0,
            max=1.0,
            help="Stop when a state loses more than this share of its records; what was made stays. 1: never stop.",
            metavar="SHARE",
        ),
    ] = 0.1

    def runner(self) -> tuple[str | Engine | None, int | None]:
        """Return the engine, and the workers that it is to take; one on a cluster knows them already."""
        from siggen.engines.registry import engine_of

        if self.address is None:
            return self.engine, self.workers
        return engine_of(self.engine, self.workers, self.address), None
