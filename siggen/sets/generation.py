"""From a design to a finished set: what a folder holds already, then a run that makes the rest."""

from __future__ import annotations

import re
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path, PurePath

from siggen.dataset.folder import content_of
from siggen.dataset.storage_at import storage_at
from siggen.errors import UsageError
from siggen.gearbox.design import SetDesign, expect_design
from siggen.sets.interruption import Interruption
from siggen.sets.loss_limit import ALLOWED_LOSS, LossLimit
from siggen.sets.run_journal import Events
from siggen.sets.set_run import Generation, Part, Progress, SetRun, _silent, unchanged
from siggen.workers.choice import workers_of


def generate(
    design: SetDesign,
    out: Path | str,
    workers: int | None = None,
    progress: Progress | None = None,
    *,
    part: Part | None = None,
    executor: Executor | str | None = None,
    address: str | None = None,
    events: Events | None = None,
    allowed_loss: float = ALLOWED_LOSS,
) -> Generation:
    """Generate a data set, go on with one, or add gearboxes to it.

    The files do not depend on `workers`, `executor`, parts or stops. More gearboxes leave the shards that are there as
    they are; every record is the one that a set generated at once would have.

    Parameters
    ----------
    design : SetDesign
        What `load_config` returns.
    out : path
        A new or empty folder, one that holds a part of this very set, or this set with fewer gearboxes.
    workers : int, optional
        Worker processes, by default one per core. 0 runs everything in this process (for debuggers).
    progress : callable, optional
        Called with (records done, records of the set).
    part : (int, int), optional
        Make every N-th shard from the i-th on, given as (i, N), and nothing else: for jobs that know nothing of each
        other and write into one folder. A call without it makes what is missing, and ends the set.
    executor : Executor or str, optional
        'serial', 'processes' (the default), 'dask', 'ray', or any executor of `concurrent.futures`, which you end.
    address : str, optional
        Of a cluster of Dask or Ray that is there already.
    events : callable, optional
        Called with every event of the run as a mapping: `siggen.sets.run_journal.EVENTS` has their fields.
    allowed_loss : float
        Share of a state's records that may fail, from 0 to 1; the run stops at the end of the shard by which one has
        lost more.

    Raises
    ------
    DatasetError
        If the folder holds something else, or is being written by another process.
    UsageError
        If an argument cannot be: names it, what came and what is allowed.
    InterruptionError
        After SIGINT or SIGTERM.
    LossError
        If a state lost more than `allowed_loss`. Finished shards stay; the same call with a larger share continues.
    EngineError
        If a simulation raised, or workers kept dying. Finished shards stay.
    """
    expect_design(design)
    _refuse_arguments(out, part)
    limit = LossLimit(design, allowed_loss)
    storage, chosen = storage_at(out), workers_of(executor, workers, address)
    with storage.writing(beside_others=part is not None):
        content = content_of(storage, design)
        if content.finished is not None:
            return unchanged(storage, content.finished, events)
        storage.delete_leftovers(of_dead=part is not None)
        with Interruption() as interruption:
            told = {"progress": progress or _silent, "events": events, "limit": limit}
            made = SetRun(design, storage, chosen, interruption, content.earlier, part, **told).run()  # type: ignore[arg-type]
    if not content.published:
        return made
    note = (
        f"{', '.join(content.published)} and the card of `siggen publish` are no part of the set now: remove what is "
        "left of them, and publish it anew"
    )
    return replace(made, notes=(*made.notes, note))


def _refuse_arguments(out: object, part: object) -> None:
    if not isinstance(out, str | PurePath):
        raise UsageError(f"out: received {out!r}; allowed: the path of a folder, or s3://bucket/set")
    if part is None:
        return
    if not (isinstance(part, tuple | list) and len(part) == 2 and all(type(one) is int for one in part)):
        raise UsageError(f"part: received {part!r}; allowed: two integers, i of N with i from 1 to N, such as (3, 16)")


def part_of(text: str) -> Part:
    """Return the part that a text such as '3/16' names.

    Raises
    ------
    UsageError
        If it is of another form, or the number is not from 1 to the count.
    """
    form = re.fullmatch(r"(\d{1,9})/(\d{1,9})", text, re.ASCII)
    found = (int(form[1]), int(form[2])) if form else (0, 0)
    if not 1 <= found[0] <= found[1]:
        raise UsageError(f"--part: received {text[:40]!r}; allowed: i/N with i from 1 to N, such as 3/16")
    return found
