"""Shards that earlier runs committed: taken over where the digest of what can change a bit is the same."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence

from siggen.dataset.environment import fingerprint, version_text
from siggen.dataset.sidecar import Sidecar, committed, promised_shard, ranges
from siggen.dataset.storage import Storage
from siggen.gearbox.plan import ShardPlan


def usable_shards(
    identity: str,
    states: Collection[str],
    storage: Storage,
    wanted: Sequence[ShardPlan],
    trusted: Collection[str],
    notes: list[tuple[str, str]],
    check: Callable[[], None],
) -> Iterator[Sidecar]:
    """Yield the sidecars of whole shards of `trusted` fingerprints; `notes` says of the others why they are not taken.

    `check` may stop it.
    """
    for shard in wanted:
        check()
        specimens, records = ranges(shard)
        found = committed(storage, shard.key, identity, specimens)
        found = found if isinstance(found, str) else _fitting(states, shard, found)
        if not isinstance(found, str) and fingerprint(found.environment) not in trusted:
            found = f"made by {version_text(found.environment)}"
        if not isinstance(found, str):
            yield found.without_bulk(specimens, records)
        elif found:
            notes.append((shard.key, found))


def promised(identity: str, states: Collection[str], storage: Storage, shard: ShardPlan) -> Sidecar | str:
    """Return the sidecar of a planned shard, or why it cannot be used; its files are not read."""
    found = promised_shard(storage, shard.key, identity, ranges(shard)[0])
    return found if isinstance(found, str) else _fitting(states, shard, found)


def _fitting(states: Collection[str], shard: ShardPlan, sidecar: Sidecar) -> Sidecar | str:
    """Return a sidecar whose counts can be those of the shard, or why they cannot."""
    rows = sum(sidecar.rows_per_state.values())
    counts = (rows, rows + len(sidecar.failures), set(sidecar.rows_per_state), sidecar.records)
    if counts != (sidecar.data.rows, shard.record_count, set(states), tuple(ranges(shard)[1])):
        return f"{sidecar.name} counts other records than the shard has"
    return sidecar
