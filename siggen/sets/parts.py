"""A set made in parts by machines that know nothing of each other, and the parts put together.

Part i of N makes every N-th shard, from the i-th on, in a folder of its own. Which shards there are follows from the
configuration alone, so nothing has to be coordinated; a part that is lost is made again by the same command.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

from siggen.dataset.environment import fingerprint, version_text
from siggen.dataset.excerpt import excerpt_name
from siggen.dataset.folder import is_finished
from siggen.dataset.manifest import CONFIG
from siggen.dataset.sidecar import Sidecar, ranges
from siggen.dataset.storage import Storage, copy_object
from siggen.dataset.storage_at import storage_at
from siggen.engines.protocol import Engine
from siggen.engines.registry import engine_of
from siggen.engines.serial import SerialEngine
from siggen.errors import DatasetError, UsageError, counted
from siggen.gearbox.design import SetDesign, expect_design, stored_design
from siggen.gearbox.plan import ShardPlan
from siggen.sets.committed_shards import promised
from siggen.sets.interruption import Interruption
from siggen.sets.loss_limit import ALLOWED_LOSS, LossLimit
from siggen.sets.run_journal import Events
from siggen.sets.set_run import Generation, Progress, SetRun, set_run, unchanged

COPIES = 8
"""Shards that `merge` copies at once: hashing lets other threads work, and disks and stores take their time."""


class SetPart(NamedTuple):
    """Part `number`, from 1, of `of`."""

    number: int
    of: int


def part_of(text: str) -> SetPart:
    """Return the part that a text such as '3/16' names.

    Raises
    ------
    UsageError
        If it is of another form, or the number is not from 1 to the count.
    """
    form = re.fullmatch(r"(\d{1,9})/(\d{1,9})", text, re.ASCII)
    found = SetPart(int(form[1]), int(form[2])) if form else SetPart(0, 0)
    if not 1 <= found.number <= found.of:
        raise UsageError(f"--part: received {text[:40]!r}; allowed: i/N with i from 1 to N, such as 3/16")
    return found


def generate_part(
    design: SetDesign,
    out: Path | str,
    part: SetPart | tuple[int, int],
    workers: int | None = None,
    progress: Progress | None = None,
    *,
    engine: Engine | str | None = None,
    events: Events | None = None,
    allowed_loss: float = ALLOWED_LOSS,
) -> Generation:
    """Make the shards of one part of a set in a folder of its own; the same call continues an interrupted one.

    Parameters
    ----------
    part : (int, int)
        Number of the part, from 1, and count of all parts. A part may have no shard, where there are fewer than parts.
    design, out, workers, progress, engine, events
        As for `generate`.
    allowed_loss
        The same, of the records of this part.

    Raises
    ------
    DatasetError, UsageError, InterruptionError, LossError, EngineError
        As of `generate`.
    """
    expect_design(design)
    chosen, limit = SetPart(*part), LossLimit(design, allowed_loss)
    storage = storage_at(out)
    with storage.writing():
        if is_finished(storage, design):
            return unchanged(storage, events)
        storage.delete_leftovers()
        with Interruption() as interruption:
            run = set_run(
                design, storage, engine_of(engine, workers), progress, interruption, events=events, limit=limit
            )
            return run.finish_some(run.planned[chosen.number - 1 :: chosen.of])


def merge(parts: Sequence[Path | str], out: Path | str, progress: Progress | None = None) -> Generation:
    """Put the parts of a set together: every file as if it had been generated at once. The parts are only read.

    Parameters
    ----------
    parts : sequence of path
        Folders that `generate_part` wrote, all of one design, in any order.
    out : path
        A new or empty folder, or one that holds a part of this set, one of `parts` for example.
    progress : callable, optional
        Called with (records done, records of the set).

    Raises
    ------
    DatasetError
        If the folders are of different sets, or a shard is whole in none of them; names the shards.
    InterruptionError
        After SIGINT or SIGTERM; the same call continues.
    """
    sources = [storage_at(part) for part in parts]
    design = _common_design(sources)
    target = storage_at(out)
    with target.writing():
        if is_finished(target, design):
            return unchanged(target)
        target.delete_leftovers()
        with Interruption() as interruption:
            run = set_run(design, target, SerialEngine(), progress, interruption)
            target.put(CONFIG, design.text.encode())
            run.trusted = _one_version(run, [target, *sources])
            run.take_over(run.planned)
            _copy_missing(run, sources, target)
            _check_complete(run)
            return run.finish()


def _one_version(run: SetRun, storages: Sequence[Storage]) -> frozenset[str]:
    """Return the fingerprint of all shards.

    Raises
    ------
    DatasetError
        If there are several, or its sources are not those here; nothing has been copied then.
    """
    found: dict[str, Sidecar] = {}
    for shard, storage in ((shard, storage) for shard in run.planned for storage in storages):
        run.interruption.check()
        sidecar = _promised(run, storage, shard)
        if shard.key not in found and sidecar is not None:
            found[shard.key] = sidecar
    environments = {fingerprint(one.environment): one.environment for one in found.values()}
    sources = {made_in.get("sources") for made_in in environments.values()}
    if len(environments) > 1 or sources - {run.environment["sources"]}:
        raise DatasetError(
            f"{run.storage.location}: parts of other versions are not mixed; this is {version_text(run.environment)}, "
            f"the parts are by {', '.join(sorted(map(version_text, environments.values()))[:3])}. Make parts again "
            "with the version and the kind of processor that made the others, or merge with the version that made all"
        )
    return frozenset(environments)


def _common_design(sources: Sequence[Storage]) -> SetDesign:
    found: list[SetDesign] = []
    for source in sources:
        if not source.exists(CONFIG):
            raise DatasetError(f"{source.location}: is no part of a set (it has no {CONFIG})")
        found.append(stored_design(source.get(CONFIG), f"{source.location}/{CONFIG}"))
        if (found[-1].identity, found[-1].specimens) != (found[0].identity, found[0].specimens):
            raise DatasetError(f"{source.location} is a part of another set than {sources[0].location}")
    if not found:
        raise UsageError("received no parts; allowed: the folders that `siggen generate --part i/N` wrote")
    return found[0]


def _copy_missing(run: SetRun, sources: Sequence[Storage], target: Storage) -> None:
    """Copy the shards that the target has not, some at a time."""
    missing = [shard for shard in run.planned if shard.key not in run.sidecars]
    with ThreadPoolExecutor(COPIES) as copies:
        try:
            for sidecar in copies.map(partial(_copied, run, sources, target), missing):
                run.interruption.check()
                if sidecar is not None:
                    run.accept(sidecar)
        except BaseException:
            copies.shutdown(cancel_futures=True)
            raise


def _copied(run: SetRun, sources: Sequence[Storage], target: Storage, shard: ShardPlan) -> Sidecar | None:
    """Copy a shard, hashed on the way, the sidecar last; from the first part where it is whole, or from none."""
    for source in sources:
        sidecar = _promised(run, source, shard)
        if sidecar is not None and _is_copied(source, sidecar, target):
            _copy_excerpt(source, shard.key, target)
            return sidecar.without_bulk(*ranges(shard))
    return None


def _promised(run: SetRun, storage: Storage, shard: ShardPlan) -> Sidecar | None:
    found = promised(run.design.identity, run.design.state_names, storage, shard)
    return None if isinstance(found, str) else found


def _is_copied(source: Storage, sidecar: Sidecar, target: Storage) -> bool:
    """Copy a shard; tell whether it was whole."""
    content = source.get(sidecar.name)
    try:
        for file in sidecar.files:
            copy_object(source, file.name, target, file.sha256)
    except DatasetError:
        return False
    target.put(sidecar.name, content)
    return True


def _copy_excerpt(source: Storage, shard: str, target: Storage) -> None:
    """Copy what the tables take from a shard, if the part has it; whoever reads it checks whether it is of use."""
    name = excerpt_name(shard)
    if source.exists(name):
        target.put(name, source.get(name))


def _check_complete(run: SetRun) -> None:
    lost = [shard.key for shard in run.planned if shard.key not in run.sidecars]
    if lost:
        raise DatasetError(
            f"{run.storage.location}: {counted(len(lost), 'shard')} of {len(run.planned)} "
            f"{'is' if len(lost) == 1 else 'are'} missing or damaged in all parts ({', '.join(lost[:3])}"
            f"{', ...' if len(lost) > 3 else ''}); run those parts again with the same command, then merge again"
        )
