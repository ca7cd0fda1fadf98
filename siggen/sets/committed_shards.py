"""Shards that earlier runs committed: taken over where the digest of what can change a bit is the same."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from siggen.dataset.environment import fingerprint, version_text
from siggen.dataset.sidecar import Sidecar, committed, promised_shard, ranges
from siggen.dataset.storage import Storage
from siggen.planning.plan import ShardPlan

if TYPE_CHECKING:
    from siggen.config import Config


def usable_shards(
    config: Config,
    storage: Storage,
    wanted: Sequence[ShardPlan],
    trusted: Collection[str],
    notes: list[str],
    check: Callable[[], None],
) -> Iterator[Sidecar]:
    """Yield the sidecars of whole shards of `trusted` fingerprints; `notes` says of the others why they are not taken.

    `check` may stop it.
    """
    for shard in wanted:
        check()
        specimens, records = ranges(shard)
        found = committed(storage, shard.key, config.identity, specimens)
        found = found if isinstance(found, str) else _fitting(config, shard, found)
        if not isinstance(found, str) and fingerprint(found.environment) not in trusted:
            found = f"made by {version_text(found.environment)}"
        if not isinstance(found, str):
            yield found.without_bulk(specimens, records)
        elif found:
            notes.append(f"{shard.key} is made again: {found}")


def promised(config: Config, storage: Storage, shard: ShardPlan) -> Sidecar | str:
    """Return the sidecar of a planned shard, or why it cannot be used; its files are not read."""
    found = promised_shard(storage, shard.key, config.identity, ranges(shard)[0])
    return found if isinstance(found, str) else _fitting(config, shard, found)


def _fitting(config: Config, shard: ShardPlan, sidecar: Sidecar) -> Sidecar | str:
    """Return a sidecar whose counts can be those of the shard, or why they cannot."""
    states = set(config.state_names)
    rows = sum(sidecar.rows_per_state.values())
    counts = (rows, rows + len(sidecar.failures), set(sidecar.rows_per_state), sidecar.records)
    if counts != (sidecar.data.rows, shard.record_count, states, tuple(ranges(shard)[1])):
        return f"{sidecar.name} counts other records than the shard has"
    return sidecar
