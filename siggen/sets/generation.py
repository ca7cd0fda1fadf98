"""From a design to a finished set: what a folder holds already, then a run that makes the rest."""

from __future__ import annotations

from pathlib import Path

from siggen.dataset.extensions import earlier_specimens
from siggen.dataset.folder import is_finished
from siggen.dataset.storage_at import storage_at
from siggen.engines.protocol import Engine
from siggen.engines.registry import engine_of
from siggen.gearbox.design import SetDesign, expect_design
from siggen.sets.interruption import Interruption
from siggen.sets.loss_limit import ALLOWED_LOSS, LossLimit
from siggen.sets.run_journal import Events
from siggen.sets.set_run import Generation, Progress, set_run, unchanged


def generate(
    design: SetDesign,
    out: Path | str,
    workers: int | None = None,
    progress: Progress | None = None,
    *,
    engine: Engine | str | None = None,
    events: Events | None = None,
    allowed_loss: float = ALLOWED_LOSS,
) -> Generation:
    """Generate a data set, or continue one that was interrupted; the files do not depend on `workers` nor on stops.

    Parameters
    ----------
    design : SetDesign
        What `load_config` returns.
    out : path
        A new or empty folder, or one that holds a part of this very set.
    workers : int, optional
        Worker processes, by default one per core. 0 runs everything in this process (for debuggers).
    progress : callable, optional
        Called with (records done, records of the set).
    engine : Engine or str, optional
        'serial', 'processes' (the default), 'dask', 'ray', or an object with `map` and `workers` as
        `siggen.engines.protocol` has it.
    events : callable, optional
        Called with every event of the run as a mapping: `siggen.sets.run_journal.EVENTS` has their fields.
    allowed_loss : float
        Share of a state's records that may fail, from 0 to 1; the run stops as soon as one has lost more.

    Raises
    ------
    DatasetError
        If the folder holds something else, or is being written by another process.
    UsageError
        If there is no such engine, or it cannot have so many workers.
    InterruptionError
        After SIGINT or SIGTERM.
    LossError
        If a state lost more than `allowed_loss`. Committed shards stay; the same call with a larger share continues.
    EngineError
        If a simulation raised, or workers kept dying. Committed shards stay.
    """
    expect_design(design)
    limit = LossLimit(design, allowed_loss)
    storage = storage_at(out)
    with storage.writing():
        if is_finished(storage, design):
            return unchanged(storage, events)
        storage.delete_leftovers()
        chosen = engine_of(engine, workers)
        with Interruption() as interruption:
            earlier = earlier_specimens(storage, design.specimens)
            return set_run(design, storage, chosen, progress, interruption, earlier, events, limit).finish()
