"""A finished set made larger: new shards behind the last ones, everything that is there stays as it is."""

from __future__ import annotations

from pathlib import Path

from siggen.dataset.environment import version_text
from siggen.dataset.extensions import put_extensions, read_extensions
from siggen.dataset.manifest import CONFIG, read_manifest
from siggen.dataset.storage import Storage
from siggen.dataset.storage_at import storage_at
from siggen.engines.protocol import Engine
from siggen.engines.registry import engine_of
from siggen.errors import DatasetError, UsageError
from siggen.gearbox.design import stored_design
from siggen.sets.interruption import Interruption
from siggen.sets.loss_limit import ALLOWED_LOSS, LossLimit
from siggen.sets.run_journal import Events
from siggen.sets.set_run import Generation, Progress, SetRun, set_run


def extend(
    path: Path | str,
    specimens: int | str,
    workers: int | None = None,
    progress: Progress | None = None,
    *,
    engine: Engine | str | None = None,
    events: Events | None = None,
    allowed_loss: float = ALLOWED_LOSS,
) -> Generation:
    """Add specimens to a finished set, or continue an extension that was interrupted.

    Every record equals the one that a set generated at once would have. Shards that are there keep their bytes; tables,
    card, configuration and manifest are written again. Until the new manifest is there, the old set stays readable
    while new shards are made.

    Parameters
    ----------
    path : path
        A finished set.
    specimens : int or str
        How many it shall have in all, or '+N' for N more.
    workers, progress, engine, events
        As for `generate`.
    allowed_loss
        The same, of the records of the extended set.

    Raises
    ------
    UsageError
        If the number is none, or not above what the set has.
    DatasetError
        If there is no finished set, its shards are of another fingerprint, or one of them is damaged.
    InterruptionError
        After SIGINT or SIGTERM; the same call continues.
    LossError
        If a state lost more than `allowed_loss`; the same call with a larger share continues.
    """
    storage = storage_at(path)
    read_manifest(storage)  # a folder without a set must not be created by the lock
    with storage.writing():
        manifest = read_manifest(storage)
        there = manifest.specimens
        wanted = _wanted(specimens, there)
        _check_begun(storage, there, wanted)
        design = stored_design(storage.get(CONFIG), f"{storage.location}/{CONFIG}", {"specimens": wanted})
        if design.identity != manifest.identity:
            raise DatasetError(f"{storage.location}/{CONFIG} is not the configuration of this set; nothing was changed")
        storage.delete_leftovers()
        earlier = [*(count for count in read_extensions(storage) if count < there), there]
        with Interruption() as interruption:
            chosen, limit = engine_of(engine, workers), LossLimit(design, allowed_loss)
            run = set_run(design, storage, chosen, progress, interruption, earlier, events, limit)
            _check_shards(run, there)
            put_extensions(storage, [*earlier, wanted])
            return run.finish()


def _wanted(specimens: int | str, there: int) -> int:
    text = str(specimens).strip()
    if not text.removeprefix("+").isdecimal() or not text.isascii() or len(text) > 18:
        raise UsageError(f"--specimens: received {text[:40]!r}; allowed: +N for N more, or a number above {there}")
    wanted = there + int(text[1:]) if text.startswith("+") else int(text)
    if wanted <= there:
        raise UsageError(f"--specimens: received {text}; the set has {there} specimens: allowed are more, such as +100")
    return wanted


def _check_begun(storage: Storage, there: int, wanted: int) -> None:
    """Refuse to change the aim of an extension that was begun: its last shard may be a partial one."""
    begun = max(read_extensions(storage), default=0)
    if begun > there and begun != wanted:
        raise UsageError(
            f"{storage.location}: an extension to {begun} specimens was begun; complete it first: "
            f"siggen extend {storage.location} --specimens {begun}"
        )


def _check_shards(run: SetRun, there: int) -> None:
    """Find the shards of the set as it is, each of which has to be whole."""
    old = [shard for shard in run.planned if shard.specimens[-1] < there]
    run.take_over(old)
    if lost := [shard.key for shard in old if shard.key not in run.sidecars]:
        where = run.storage.location
        why = "; ".join(f"{key}: {reason}" for key, reason in run.notes[:3])
        raise DatasetError(
            f"{where}: {len(lost)} of its {len(old)} shards are missing, damaged or of another version of siggen "
            f"({', '.join(lost[:3])}{', ...' if len(lost) > 3 else ''}). {why or 'no file is there'}. This is "
            f"{version_text(run.environment)}: only whole sets of the same fingerprint are extended. `siggen verify "
            f"{where}` compares all files; extend with the version and the kind of processor that made the set, or "
            f"generate a new one: siggen generate {where}/{CONFIG} --set specimens={run.design.specimens} --out NEW"
        )
